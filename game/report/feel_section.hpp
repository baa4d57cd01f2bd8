// What a hand felt, as a part of a session's section: evenness of the force, bumps, time to get onto the
// nuts, and how the servo kept its time.
#pragma once

#include <string>

#include "game/analysis/session_data.hpp"

namespace bolt::report {

// HTML; nothing for a session without ticks.
std::string feel_section(const analysis::SessionData& session);

}  // namespace bolt::report
