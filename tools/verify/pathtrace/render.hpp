// Unidirectional path tracing. Every vertex of a path samples the environment and the model's lights;
// multiple importance sampling weighs environment samples against BSDF samples.
//   E. Veach, Robust Monte Carlo Methods for Light Transport Simulation, 1997, chapter 9 (power heuristic).
// Limits: back faces are shaded as front faces; occlusion textures are ignored because light is traced;
// textures have no mip levels because each pixel has many samples; transparent surfaces are thin, and
// KHR_materials_transmission is not supported. The image does not depend on the number of threads.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "tools/verify/pathtrace/camera.hpp"
#include "tools/verify/pathtrace/environment.hpp"
#include "tools/verify/pathtrace/scene.hpp"

namespace bolt::pathtrace {

struct PathTraceSettings {
    int samples = 32;
    int bounces = 8;
    std::uint32_t seed = 0;
    std::size_t threads = 0;  // 0: one per processor
    float clamp = 0.0F;  // maximum radiance of a contribution after the first bounce; 0: unlimited (unbiased)
    std::optional<glm::vec3> background = {};  // radiance behind the model; none: the environment
};

// Returns the radiance of every pixel, rows from the top.
std::vector<glm::vec3> render(const TracedScene& scene, const Environment& environment,
                              const PinholeCamera& camera, const PathTraceSettings& settings);

// Returns the depth along the view direction (m) at the middle of every pixel; 0 where there is no surface.
std::vector<float> depth(const TracedScene& scene, const PinholeCamera& camera);

}  // namespace bolt::pathtrace
