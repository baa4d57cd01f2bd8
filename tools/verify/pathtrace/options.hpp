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

struct PathTraceOptions {
    std::string file, png, write_env;
    std::string light = "studio";          // studio, none or an .hdr file
    std::vector<std::string> nodes, hide;  // patterns of node names to show and to hide (NodeFilter)
    bool floor = false;
    bool no_lights = false;
    float exposure = 0.0F;                            // stops
    std::string size, eye, target, from, background;  // unparsed
    float fov_deg = 35.0F;

    // Computed by resolve().
    PinholeCamera camera;
    bool has_eye = false, has_target = false;
    glm::vec3 view{0.55F, 0.5F, 1.0F};  // direction to the viewer if there is no eye
    PathTraceSettings settings{.clamp = 20.0F};
};

// Declares the options; parsing fills the first group of members.
void declare(CLI::App& app, PathTraceOptions& options);

// Parses the unparsed values and checks all of them. Fails with ErrorCode::usage.
Status resolve(PathTraceOptions& options);

}  // namespace bolt::pathtrace
