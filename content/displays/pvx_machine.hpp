// The element Machine of ParaView's .pvx files: one window of a cave.
#pragma once

#include <pugixml.hpp>
#include <string>

#include "content/displays/display_file.hpp"
#include "content/displays/pvx_messages.hpp"

namespace bolt::content {

struct PvxMachine {
    Wall wall;           // without a name; mono
    std::string host;    // its attribute Name
    std::string stereo;  // its attribute StereoType
    pugi::xml_node node;
};

// Reports mistakes, and attributes that a display file does not have. `scale`: metres per unit of the file.
PvxMachine read_pvx_machine(pugi::xml_node node, double scale, PvxMessages& messages);

}  // namespace bolt::content
