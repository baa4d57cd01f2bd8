// Unidirectional path tracing: at every vertex of a path light is sampled from the environment and from the
// model's lights, and the environment is weighed between both ways of finding it.
//   E. Veach, Robust Monte Carlo Methods for Light Transport Simulation, 1997, chapter 9 (power heuristic).
// Back faces are drawn as front faces, occlusion textures are left out (light is traced), textures have no
// mip levels (pixels are sampled many times), and what is transparent is thin: KHR_materials_transmission is
// not there. The picture depends on scene, camera and settings alone, not on the number of threads.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "tools/verify/pathtrace/camera.hpp"
#include "tools/verify/pathtrace/environment.hpp"
#include "tools/verify/pathtrace/scene.hpp"

namespace bolt::pathtrace {

struct Settings {
    int samples = 32;
    int bounces = 8;
    std::uint32_t seed = 0;
    int threads = 0;     // 0: as many as the machine has
    float clamp = 0.0F;  // what one path may bring after its first bounce; 0: anything (unbiased)
    std::optional<glm::vec3> background = {};  // what the camera sees behind the model; none: the environment
};

// Radiance, rows from the top.
std::vector<glm::vec3> render(const Scene& scene, const Environment& environment, const Camera& camera,
                              const Settings& settings);

// Distance along the view direction through the middle of every pixel, in metres; 0: nothing there.
std::vector<float> depth(const Scene& scene, const Camera& camera);

}  // namespace bolt::pathtrace
