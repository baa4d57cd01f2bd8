// hidapi keeps one error text for all of a program, and frees it in every call that is about no open device:
// whoever makes such a call holds this. Two threads that looked for devices at once have crashed.
#pragma once

#include <mutex>

namespace bolt::device {

std::mutex& hidapi_lock();

}  // namespace bolt::device
