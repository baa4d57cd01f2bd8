#include "tools/assets/sculpt/glove.hpp"

#include <algorithm>

#include "tools/assets/sculpt/textures.hpp"

namespace bolt::sculpt {
namespace {

constexpr int palm_digit = 5;
constexpr int cuff_digit = 6;

// Returns the digit of a point beyond the web; palm_digit for the palm.
int digit_at(const HandShape& shape, const Vec3& p) {
    int best = palm_digit;
    double depth = 1.0;
    for (std::size_t d = 0; d < 5; ++d) {
        const DigitPosition at = shape.locate(d, p);
        if (at.depth >= depth) continue;
        depth = at.depth;
        const double root = shape.travel(d, 1) + (d == 0 ? 2 * mm : 14 * mm);
        best = at.travel > root ? static_cast<int>(d) : palm_digit;
    }
    return best;
}

glm::dmat3 axes_of(const HandShape& shape, int digit) {
    if (digit == palm_digit) return glm::dmat3(1.0);
    const Digit& d = digits[static_cast<std::size_t>(digit)];
    return glm::mat3_cast(shape.skeleton().rotation[d.first + d.count - 3]);
}

}  // namespace

double coating(const HandShape& shape, const Vec3& p) {
    std::array<DigitPosition, 5> at{};
    double nearest = 1.0;
    for (std::size_t d = 0; d < 5; ++d) {
        at[d] = shape.locate(d, p);
        nearest = std::min(nearest, at[d].depth);
    }
    // Blend over the digits so that the edge of the coating is continuous.
    double sum = 0.0;
    double height = 0.0;
    double tip = 0.0;
    for (std::size_t d = 0; d < 5; ++d) {
        const double weight = std::exp(-(at[d].depth - nearest) / (2.5 * mm));
        const double nail = shape.travel(d, digits[d].count - 2) + (d == 0 ? 9 * mm : 5.5 * mm);
        height += weight * at[d].height;
        tip += weight * std::clamp((at[d].travel - nail) / (7 * mm), -3.0, 3.0);
        sum += weight;
    }
    const double ragged = 0.34 * (noise3(p / (9 * mm), 11) - 0.5) + 0.14 * (noise3(p / (3.5 * mm), 12) - 0.5);
    const double side = -0.02 - height / sum + ragged;
    const double dip = -smooth_union(-side, -(tip / sum + 2.0 * ragged), 0.5);
    const double heel = (-14 * mm - p.z) / (9 * mm) + 2.0 * ragged;
    return std::min(dip, heel);
}

GlovePart glove_part(const HandShape& shape, const Vec3& p) {
    if (p.z > HandShape::cuff_end - HandShape::hem) return hem;
    if (p.z > cuff_begin) return cuff;
    return coating(shape, p) > 0.0 ? coat : knit;
}

TexturePatch patch_of(const HandShape& shape, const Vec3& p, const Vec3& normal, GlovePart part) {
    if (part == cuff || part == hem) return {cuff_digit, 0};
    const int digit = digit_at(shape, p);
    const Vec3 local = glm::transpose(axes_of(shape, digit)) * normal;
    int axis = 0;
    if (std::abs(local.y) * 1.15 > std::abs(local[axis])) axis = 1;
    if (std::abs(local.z) * 0.8 > std::abs(local[axis])) axis = 2;
    return {digit, 2 * axis + (local[axis] < 0.0 ? 1 : 0)};
}

PatchPoint map_to_patch(const HandShape& shape, const TexturePatch& patch, const Vec3& p) {
    if (patch.digit == cuff_digit) {
        const double angle = std::atan2(p.y, p.x);
        return {{angle / (2 * pi) * cuff_round, p.z},
                Vec3(-std::sin(angle), std::cos(angle), 0.0),
                Vec3(0, 0, -1)};
    }
    const glm::dmat3 axes = axes_of(shape, patch.digit);
    const Vec3 local = glm::transpose(axes) * p;
    // The wales of the knit run along the finger: v runs along −Z where that is possible.
    switch (patch.face / 2) {
        case 0:
            return {{local.y, local.z}, axes[1], -axes[2]};
        case 1:
            return {{local.x, local.z}, axes[0], -axes[2]};
        default:
            return {{local.x, -local.y}, axes[0], axes[1]};
    }
}

double ambient_shade(const HandShape& shape, const Vec3& p, const Vec3& normal) {
    double hidden = 0.0;
    double weight = 1.0;
    for (const double reach : {2.0, 4.0, 8.0, 14.0, 22.0}) {
        const double open = shape(p + normal * (reach * mm)) / (reach * mm);
        hidden += weight * std::clamp(1.0 - open, 0.0, 1.0);
        weight *= 0.75;
    }
    const double wear = 0.9 + 0.2 * noise3(p / (14 * mm), 21);
    return std::clamp((1.0 - 0.22 * hidden) * wear, 0.3, 1.0);
}

namespace {

// Thirteen-gauge jersey: eleven wales and fifteen courses in a tile of 18 mm; each stitch is a V of two legs.
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

// Foamed nitrile: fine pebbles and shallow puckers.
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
                const HeightFunction& height, const PaintFunction& paint, int size) {
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
    // The hem has the colour code of the glove size and the same knit as the cuff.
    assets::Material edge = model.materials.back();
    edge.name = "glove_hem";
    edge.base_color = glm::vec4(glm::vec3(from_srgb(0xD9601F)), 1.0F);
    model.materials.push_back(edge);
    return {};
}

}  // namespace bolt::sculpt
