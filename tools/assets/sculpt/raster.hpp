// Pictures made point by point: functions of (u, v) in [0, 1) become pixels, textures and PNG files.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <string>

#include "engine/assets/model.hpp"
#include "engine/base/math.hpp"
#include "engine/base/result.hpp"

namespace bolt::sculpt {

using Height = std::function<double(double u, double v)>;  // m; repeats with period one
using Paint = std::function<Vec3(double u, double v)>;     // linear values in [0, 1]

// Both append image and texture to the model and say where they are.
Result<assets::TextureRef> add_colour(assets::Model& model, const std::string& name, int size,
                                      const Paint& paint);
// Linear data, such as occlusion, roughness and metalness in red, green and blue.
Result<assets::TextureRef> add_data(assets::Model& model, const std::string& name, int size,
                                    const Paint& paint);
// A tile of `length` metres as a normal map: red along u, green against v, as glTF wants it.
Result<assets::TextureRef> add_normals(assets::Model& model, const std::string& name, int size, double length,
                                       const Height& height);

// sRGB hex, "#RRGGBB", as linear values.
Vec3 from_srgb(std::uint32_t hex);

}  // namespace bolt::sculpt
