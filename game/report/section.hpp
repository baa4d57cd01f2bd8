// One session as a section of the page.
#pragma once

#include <string>

#include "game/report/session_data.hpp"

namespace bolt::report {

// English if there is any, else the first language, else the folder's name.
std::string title_of(const content::Assembly& assembly);

// "M16×180 · 8.8"; with the pitch, "M12×1.25×70 · 8.8", where it is not the size's coarse one.
std::string bolt_text(const content::AssemblyJoint& joint);

// `number` counts from 1 and is the anchor's name; 0: the only session.
std::string session_section(const SessionData& session, std::size_t number);

}  // namespace bolt::report
