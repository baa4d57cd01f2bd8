// The haptic metrics of a session as a part of its section: evenness of the force, bumps, times to reach the
// nuts, and timing of the servo.
#pragma once

#include <string>

#include "game/analysis/session_data.hpp"

namespace bolt::report {

// HTML; empty if the session has neither forces nor arrivals.
std::string haptics_section(const analysis::SessionData& session);

}  // namespace bolt::report
