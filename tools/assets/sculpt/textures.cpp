#include "tools/assets/sculpt/textures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "engine/assets/image.hpp"

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

namespace {

std::uint8_t byte(double x) {
    return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(x, 0.0, 1.0)));
}

double to_srgb(double x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055; }

Result<assets::TextureRef> add(assets::Model& model, const std::string& name, int size,
                               const PaintFunction& paint) {
    std::vector<std::uint8_t> pixels;
    pixels.reserve(static_cast<std::size_t>(size) * static_cast<std::size_t>(size) * 3);
    for (int row = 0; row < size; ++row) {
        for (int column = 0; column < size; ++column) {
            const Vec3 value = paint((column + 0.5) / size, (row + 0.5) / size);
            for (int i = 0; i < 3; ++i) pixels.push_back(byte(value[i]));
        }
    }
    const Result<std::string> png = assets::encode_png(size, size, 3, pixels);
    if (!png) return tl::unexpected(png.error());
    assets::Bitmap image;
    image.name = name;
    image.mime_type = "image/png";
    image.encoded.assign(png->begin(), png->end());
    model.images.push_back(std::move(image));
    assets::Texture texture;
    texture.image = static_cast<int>(model.images.size()) - 1;
    model.textures.push_back(texture);
    assets::TextureRef ref;
    ref.texture = static_cast<int>(model.textures.size()) - 1;
    return ref;
}

}  // namespace

Result<assets::TextureRef> add_colour(assets::Model& model, const std::string& name, int size,
                                      const PaintFunction& paint) {
    return add(model, name, size, [&](double u, double v) {
        const Vec3 c = glm::clamp(paint(u, v), Vec3(0.0), Vec3(1.0));
        return Vec3(to_srgb(c.x), to_srgb(c.y), to_srgb(c.z));
    });
}

Result<assets::TextureRef> add_data(assets::Model& model, const std::string& name, int size,
                                    const PaintFunction& paint) {
    return add(model, name, size, paint);
}

Result<assets::TextureRef> add_normals(assets::Model& model, const std::string& name, int size, double length,
                                       const HeightFunction& height) {
    const double step = 1.0 / size;
    return add(model, name, size, [&](double u, double v) {
        const double along_u = (height(u + step, v) - height(u - step, v)) / (2.0 * step * length);
        const double along_v = (height(u, v + step) - height(u, v - step)) / (2.0 * step * length);
        return 0.5 + 0.5 * glm::normalize(Vec3(-along_u, along_v, 1.0));
    });
}

Vec3 from_srgb(std::uint32_t hex) {
    const auto channel = [hex](unsigned shift) {
        const double x = static_cast<double>((hex >> shift) & 0xFFU) / 255.0;
        return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
    };
    return {channel(16), channel(8), channel(0)};
}

}  // namespace bolt::sculpt
