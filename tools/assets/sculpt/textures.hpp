// Procedural textures: periodic value noise that is the same on every machine, and its conversion to glTF
// textures.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <string>

#include "engine/assets/model.hpp"
#include "engine/base/math.hpp"
#include "engine/base/result.hpp"

namespace bolt::sculpt {

// Returns a hash of the integers in [0, 1).
double hash01(int x, int y, int z, std::uint32_t seed);

// Smooth noise in [0, 1). noise2 has the period `period` in both directions (0: not periodic).
double noise2(double x, double y, int period, std::uint32_t seed);
double noise3(const Vec3& p, std::uint32_t seed);

// Sums octaves of noise2, each with twice the frequency and half the amplitude; in [0, 1).
double fractal2(double x, double y, int period, int octaves, std::uint32_t seed);

// Functions of (u, v) in [0, 1) from which textures are sampled.
using HeightFunction = std::function<double(double u, double v)>;  // m; repeats with period one
using PaintFunction = std::function<Vec3(double u, double v)>;     // linear values in [0, 1]

// Each function appends a square PNG image of `size` pixels and its texture to the model, and returns the
// reference to the texture. add_colour encodes as sRGB.
Result<assets::TextureRef> add_colour(assets::Model& model, const std::string& name, int size,
                                      const PaintFunction& paint);
// Stores linear data, such as occlusion, roughness and metalness in red, green and blue.
Result<assets::TextureRef> add_data(assets::Model& model, const std::string& name, int size,
                                    const PaintFunction& paint);
// Stores a height field over a tile of `length` metres as a normal map of glTF: red along +u, green along −v.
Result<assets::TextureRef> add_normals(assets::Model& model, const std::string& name, int size, double length,
                                       const HeightFunction& height);

// Converts sRGB 0xRRGGBB to linear values.
Vec3 from_srgb(std::uint32_t hex);

}  // namespace bolt::sculpt
