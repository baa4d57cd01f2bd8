// One session as a section of the page.
#pragma once

#include <string>

#include "game/report/session_data.hpp"

namespace bolt::report {

// English if there is any, else the first language, else the folder's name.
std::string title_of(const content::Assembly& assembly);

// `number` counts from 1 and is the anchor's name; 0: the only session.
std::string session_section(const SessionData& session, std::size_t number);

}  // namespace bolt::report
