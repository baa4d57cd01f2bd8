// One session as a section of the page.
#pragma once

#include <string>

#include "game/analysis/session_data.hpp"

namespace bolt::report {

// "M16×180 · 8.8"; with the pitch, "M12×1.25×70 · 8.8", where it is not the size's coarse one.
std::string bolt_text(const content::AssemblyJoint& joint);

// HTML: "✓ OK", "▲ HIGH torque", "▼ LOW": shape, word and colour. Names torque and angle if both were judged;
// a joint that is not sound shows its condition instead.
std::string verdict_mark(const lesson::JointResult& result);

// `number` counts from 1 and is the anchor's name; 0: the only session.
std::string session_section(const analysis::SessionData& session, std::size_t number);

}  // namespace bolt::report
