#include <algorithm>

#include "tools/assets/sculpt/glove.hpp"
#include "tools/assets/sculpt/noise.hpp"

namespace bolt::sculpt {
namespace {

// Thirteen-gauge jersey: eleven wales and fifteen courses in a tile of 18 mm, every stitch a V of two legs.
constexpr double wales = 11;
constexpr double courses = 15;

double fraction(double x) { return x - std::floor(x); }

double stitch(double u, double v) {
    const double across = fraction(u * wales);
    const double off = std::abs(across - 0.5) * 2.0;  // 0 in the middle of the V, 1 at its ends
    const double course = fraction(v * courses + 0.62 * off);
    const double strand = 1.0 - square(2.0 * course - 1.0);
    const double leg = 1.0 - square(square(2.0 * off - 1.0));
    return std::sqrt(std::max(0.0, strand)) * (0.25 + 0.75 * leg);
}

double fibres(double u, double v) { return fractal2(u * 64, v * 64, 64, 2, 31); }

double knit_height(double u, double v) { return 0.34 * mm * stitch(u, v) + 0.05 * mm * fibres(u, v); }

// Foamed nitrile: fine pebbles, and shallow puckers where it shrank on the liner.
double coat_height(double u, double v) {
    const double pebble = fractal2(u * 40, v * 40, 40, 2, 41);
    const double pucker = fractal2(u * 7, v * 7, 7, 3, 42);
    return 0.11 * mm * pebble + 0.30 * mm * std::abs(pucker - 0.5) * 2.0;
}

// Two-by-two rib: ridges along the arm.
double rib_height(double u, double v) {
    const double ridge = 0.5 + 0.5 * std::cos(2 * pi * 6.0 * u);
    return 0.75 * mm * std::sqrt(ridge) + 0.16 * mm * stitch(u * 2.0, v * 1.2) + 0.05 * mm * fibres(u, v);
}

Status textured(assets::Model& model, const std::string& name, const Vec3& colour, double roughness,
                const Height& height, const Paint& paint, int size) {
    assets::Material material;
    material.name = "glove_" + name;
    material.base_color = glm::vec4(glm::vec3(colour), 1.0F);
    material.metallic = 0.0F;
    material.roughness = static_cast<float>(roughness);
    const Result<assets::TextureRef> painted = add_colour(model, "glove_" + name + "_colour", size, paint);
    if (!painted) return tl::unexpected(painted.error());
    material.base_color_texture = *painted;
    const Result<assets::TextureRef> bumps =
        add_normals(model, "glove_" + name + "_normal", size, tile_length, height);
    if (!bumps) return tl::unexpected(bumps.error());
    material.normal_texture = *bumps;
    model.materials.push_back(std::move(material));
    return {};
}

}  // namespace

Status add_glove_materials(assets::Model& model) {
    const auto melange = [](double u, double v) {
        const double yarn = 0.62 + 0.38 * stitch(u, v);
        return Vec3(yarn * (0.80 + 0.25 * fibres(u, v)));
    };
    const auto rib_paint = [](double u, double v) {
        const double ridge = 0.55 + 0.45 * (0.5 + 0.5 * std::cos(2 * pi * 6.0 * u));
        return Vec3(ridge * (0.72 + 0.2 * stitch(u * 2.0, v * 1.2) + 0.15 * fibres(u, v)));
    };
    const auto coat_paint = [](double u, double v) {
        const double worn = fractal2(u * 12, v * 12, 12, 3, 43);
        return Vec3(0.80 + 0.28 * worn);
    };
    BOLT_TRY(textured(model, "knit", from_srgb(0xB4B8BA), 0.96, knit_height, melange, 256));
    BOLT_TRY(textured(model, "coat", from_srgb(0x565C63), 0.58, coat_height, coat_paint, 256));
    BOLT_TRY(textured(model, "cuff", from_srgb(0xB4B8BA), 0.97, rib_height, rib_paint, 256));
    // The hem in the colour of the size, of the same knit as the cuff.
    assets::Material edge = model.materials.back();
    edge.name = "glove_hem";
    edge.base_color = glm::vec4(glm::vec3(from_srgb(0xD9601F)), 1.0F);
    model.materials.push_back(edge);
    return {};
}

}  // namespace bolt::sculpt
