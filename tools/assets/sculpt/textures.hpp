// Value noise that repeats: what textures and worn edges are made of. The same on every machine.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <string>

#include "engine/assets/model.hpp"
#include "engine/base/math.hpp"
#include "engine/base/result.hpp"

namespace bolt::sculpt {

// [0, 1), a hash of the integers.
double hash01(int x, int y, int z, std::uint32_t seed);

// Smooth in [0, 1); repeats every `period` units in both directions (0: never).
double noise2(double x, double y, int period, std::uint32_t seed);
double noise3(const Vec3& p, std::uint32_t seed);

// Octaves of noise2, each twice as fine and half as strong; [0, 1).
double fractal2(double x, double y, int period, int octaves, std::uint32_t seed);

// Pictures made point by point: functions of (u, v) in [0, 1) become pixels, textures and PNG files.

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
