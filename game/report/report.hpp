// report.html: what was done in one session, or how several attempts compare. One file that needs nothing
// else.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "engine/base/result.hpp"
#include "game/analysis/session_data.hpp"
#include "game/session/session_file.hpp"

namespace bolt::report {

// `overview`: of several sessions only how they compare.
enum class Extent : std::uint8_t { everything, overview };

// Sessions in the order given; at least one. Holds one session's curves at a time.
Result<std::string> make_report(std::span<const session::Reader* const> sessions,
                                Extent extent = Extent::everything);

// The same from data that was read already.
std::string make_report(std::span<const analysis::SessionData> sessions);

}  // namespace bolt::report
