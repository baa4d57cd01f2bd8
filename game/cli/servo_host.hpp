// How this machine keeps the servo's time: the tick of a lesson on its thread, for a while.
#pragma once

#include <string>

#include "engine/base/result.hpp"

namespace bolt::cli {

// Text for a terminal: what the thread was given, histograms at 1 kHz and 4 kHz, and whether that is good
// enough.
Result<std::string> examine_servo(double seconds, const std::string& assembly);

}  // namespace bolt::cli
