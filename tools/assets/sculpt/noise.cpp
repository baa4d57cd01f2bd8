#include "tools/assets/sculpt/noise.hpp"

#include <array>

namespace bolt::sculpt {
namespace {

double fade(double t) { return t * t * t * (t * (6.0 * t - 15.0) + 10.0); }
double mix(double a, double b, double t) { return a + t * (b - a); }
int repeat(int x, int period) { return period == 0 ? x : ((x % period) + period) % period; }

}  // namespace

double hash01(int x, int y, int z, std::uint32_t seed) {
    std::uint32_t h = seed * 0x9E3779B9U + 0x7F4A7C15U;
    for (const int value : std::array{x, y, z}) {
        h ^= static_cast<std::uint32_t>(value) * 0x85EBCA6BU;
        h = (h ^ (h >> 15U)) * 0xC2B2AE35U;
        h ^= h >> 13U;
    }
    return static_cast<double>(h) / 4294967296.0;
}

double noise2(double x, double y, int period, std::uint32_t seed) {
    const double fx = std::floor(x);
    const double fy = std::floor(y);
    const int x0 = repeat(static_cast<int>(fx), period);
    const int y0 = repeat(static_cast<int>(fy), period);
    const int x1 = repeat(static_cast<int>(fx) + 1, period);
    const int y1 = repeat(static_cast<int>(fy) + 1, period);
    const double tx = fade(x - fx);
    const double ty = fade(y - fy);
    return mix(mix(hash01(x0, y0, 0, seed), hash01(x1, y0, 0, seed), tx),
               mix(hash01(x0, y1, 0, seed), hash01(x1, y1, 0, seed), tx), ty);
}

double noise3(const Vec3& p, std::uint32_t seed) {
    const Vec3 base = glm::floor(p);
    const Vec3 t(fade(p.x - base.x), fade(p.y - base.y), fade(p.z - base.z));
    const int x = static_cast<int>(base.x);
    const int y = static_cast<int>(base.y);
    const int z = static_cast<int>(base.z);
    const auto row = [&](int dy, int dz) {
        return mix(hash01(x, y + dy, z + dz, seed), hash01(x + 1, y + dy, z + dz, seed), t.x);
    };
    return mix(mix(row(0, 0), row(1, 0), t.y), mix(row(0, 1), row(1, 1), t.y), t.z);
}

double fractal2(double x, double y, int period, int octaves, std::uint32_t seed) {
    double sum = 0.0;
    double weight = 0.5;
    double norm = 0.0;
    for (int i = 0; i < octaves; ++i) {
        sum += weight * noise2(x, y, period, seed + static_cast<std::uint32_t>(i));
        norm += weight;
        weight *= 0.5;
        x *= 2.0;
        y *= 2.0;
        period *= 2;
    }
    return sum / norm;
}

}  // namespace bolt::sculpt
