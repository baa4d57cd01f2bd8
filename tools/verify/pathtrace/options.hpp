// The command line of bolt-pathtrace.
#pragma once

#include <string>
#include <vector>

#include "engine/base/result.hpp"
#include "tools/verify/pathtrace/render.hpp"

namespace CLI {
class App;
}

namespace bolt::pathtrace {

struct Options {
    std::string file, png, write_env;
    std::string light = "studio";  // studio, none or an .hdr file
    std::vector<std::string> nodes, hide;
    bool floor = false;
    bool no_lights = false;
    float exposure = 0.0F;                            // stops
    std::string size, eye, target, from, background;  // as typed
    float fov_deg = 35.0F;

    // What resolve() makes of them.
    Camera camera;
    bool has_eye = false, has_target = false;
    glm::vec3 view{0.55F, 0.5F, 1.0F};  // from which side, without an eye
    Settings settings{.clamp = 20.0F};
};

void declare(CLI::App& app, Options& options);

// Turns what was typed into numbers.
Status resolve(Options& options);

}  // namespace bolt::pathtrace
