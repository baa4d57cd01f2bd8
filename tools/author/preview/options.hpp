// What bolt-author preview is asked for.
#pragma once

#include <string>

#include "engine/gpu/vk.hpp"

namespace bolt::author {

struct PreviewOptions {
    std::string what;              // assembly or model
    std::string view;              // its first view; empty: all of it
    std::string light = "studio";  // or a Radiance file
    std::string shaders;           // a folder to take them from; empty: those built in
    std::string gpu;               // part of a name
    std::string png;               // no window: one picture
    VkExtent2D size{1280, 720};
    bool validate = false;
};

}  // namespace bolt::author
