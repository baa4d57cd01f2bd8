// The limits of a haptic device as one line of text in the session header. A replay needs them to the last
// bit.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "haptics/force/output_limits.hpp"

namespace bolt::session {

// "force_N=20 torque_Nm=2 …": each limit by name, as the shortest number that reads back the same.
std::string text_of(const force::OutputLimits& limits);

// None if a name is missing or unknown, or a value is not a number.
std::optional<force::OutputLimits> limits_of(std::string_view text);

}  // namespace bolt::session
