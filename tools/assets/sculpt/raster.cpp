#include "tools/assets/sculpt/raster.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "engine/assets/image.hpp"

namespace bolt::sculpt {
namespace {

std::uint8_t byte(double x) {
    return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(x, 0.0, 1.0)));
}

double to_srgb(double x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055; }

Result<assets::TextureRef> add(assets::Model& model, const std::string& name, int size, const Paint& paint) {
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
    assets::Image image;
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
                                      const Paint& paint) {
    return add(model, name, size, [&](double u, double v) {
        const Vec3 c = glm::clamp(paint(u, v), Vec3(0.0), Vec3(1.0));
        return Vec3(to_srgb(c.x), to_srgb(c.y), to_srgb(c.z));
    });
}

Result<assets::TextureRef> add_data(assets::Model& model, const std::string& name, int size,
                                    const Paint& paint) {
    return add(model, name, size, paint);
}

Result<assets::TextureRef> add_normals(assets::Model& model, const std::string& name, int size, double length,
                                       const Height& height) {
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
