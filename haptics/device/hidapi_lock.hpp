// hidapi has one global error string and frees it in every call without an open device. Hold this lock during
// such calls; two threads that enumerate at once crash without it.
#pragma once

#include <mutex>

namespace bolt::device {

std::mutex& hidapi_lock();

}  // namespace bolt::device
