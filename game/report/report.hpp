// One session as a section of the page.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "engine/base/result.hpp"
#include "game/analysis/session_data.hpp"
#include "game/session/session_file.hpp"

namespace bolt::report {

// "M16×180 · 8.8"; with the pitch, "M12×1.25×70 · 8.8", where it is not the size's coarse one.
std::string bolt_text(const content::AssemblyJoint& joint);

// HTML: "✓ OK", "▲ HIGH torque", "▼ LOW": shape, word and colour. Names torque and angle if both were judged;
// a joint that is not sound shows its condition instead.
std::string verdict_mark(const lesson::JointResult& result);

// `number` counts from 1 and is the anchor's name; 0: the only session.
std::string session_section(const analysis::SessionData& session, std::size_t number);

// report.html: what was done in one session, or how several attempts compare. One file that needs nothing
// else.

// `overview`: of several sessions only how they compare.
enum class Extent : std::uint8_t { everything, overview };

// Sessions in the order given; at least one. Holds one session's curves at a time.
Result<std::string> make_report(std::span<const session::Reader* const> sessions,
                                Extent extent = Extent::everything);

// The same from data that was read already.
std::string make_report(std::span<const analysis::SessionData> sessions);

}  // namespace bolt::report
