// What a haptic device takes, as a line of text in a session's header: it decides what was felt, and a replay
// needs it to the last bit.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "haptics/force/output_limits.hpp"

namespace bolt::record {

// "force_N=20 torque_Nm=2 …": every limit by name, as the shortest number that reads back the same.
std::string text_of(const force::OutputLimits& limits);

// None: a name or a number that is not there, not known, or no number.
std::optional<force::OutputLimits> limits_of(std::string_view text);

}  // namespace bolt::record
