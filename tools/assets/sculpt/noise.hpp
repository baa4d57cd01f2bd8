// Value noise that repeats: what textures and worn edges are made of. The same on every machine.
#pragma once

#include <cstdint>

#include "engine/base/math.hpp"

namespace bolt::sculpt {

// [0, 1), a hash of the integers.
double hash01(int x, int y, int z, std::uint32_t seed);

// Smooth in [0, 1); repeats every `period` units in both directions (0: never).
double noise2(double x, double y, int period, std::uint32_t seed);
double noise3(const Vec3& p, std::uint32_t seed);

// Octaves of noise2, each twice as fine and half as strong; [0, 1).
double fractal2(double x, double y, int period, int octaves, std::uint32_t seed);

}  // namespace bolt::sculpt
