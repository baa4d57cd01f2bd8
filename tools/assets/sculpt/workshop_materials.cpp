#include "tools/assets/sculpt/workshop_materials.hpp"

#include <algorithm>

#include "tools/assets/sculpt/environment.hpp"
#include "tools/assets/sculpt/field.hpp"
#include "tools/assets/sculpt/textures.hpp"

namespace bolt::sculpt {

const std::array<double, workshop_materials> workshop_repeats{1 / 2.4,  // concrete
                                                              1 / 0.6,  1 / 1.2, 1 / 1.2,
                                                              1 / 0.8,  // beech
                                                              1 / 0.3,  1 / 0.3,
                                                              1 / 0.25,  // ground steel
                                                              1 / 0.3,
                                                              1 / 0.16,  // board: four holes a tile
                                                              1 / 0.1,  1 / 0.1, 1 / 0.1, 1 / 0.3, 1 / 0.3};

namespace {

// Power-floated concrete: large-scale clouds, visible aggregate and a few pores.
double pores(double u, double v) {
    const double x = u * 48;
    const double y = v * 48;
    const int cx = static_cast<int>(std::floor(x)) % 48;
    const int cy = static_cast<int>(std::floor(y)) % 48;
    const double px = hash01(cx, cy, 1, 61);
    const double py = hash01(cx, cy, 2, 61);
    const double size = 0.14 * hash01(cx, cy, 3, 61) - 0.06;
    if (size <= 0.0) return 0.0;
    const double r = std::hypot(x - std::floor(x) - 0.2 - 0.6 * px, y - std::floor(y) - 0.2 - 0.6 * py);
    return smooth_step(size, 0.5 * size, r);
}

Vec3 concrete_paint(double u, double v) {
    const double cloud = fractal2(u * 5, v * 5, 5, 4, 51);
    const double grain = fractal2(u * 90, v * 90, 90, 2, 52);
    const double stain = smooth_step(0.60, 0.78, fractal2(u * 3, v * 3, 3, 5, 53));
    const double value =
        0.22 + 0.16 * (cloud - 0.5) + 0.05 * (grain - 0.5) - 0.05 * stain - 0.08 * pores(u, v);
    return {value, 0.985 * value, 0.955 * value};
}

double concrete_height(double u, double v) {
    return 0.5 * mm * fractal2(u * 24, v * 24, 24, 3, 52) - 1.5 * mm * pores(u, v);
}

Vec3 concrete_gloss(double u, double v) {
    const double cloud = fractal2(u * 6, v * 6, 6, 3, 54);
    return {1.0, std::clamp(0.50 + 0.35 * (cloud - 0.5) + 0.3 * pores(u, v), 0.3, 1.0), 0.0};
}

// Edge-glued staves along u, 50 mm wide, each with its own tone, length and growth rings.
struct Stave {
    double row, tone, seam, shift;
};
constexpr double staves = 16;

Stave stave(double u, double v) {
    const double row = std::floor(v * staves);
    const int i = static_cast<int>(row);
    const double across = v * staves - row;
    const double joint = hash01(i, 7, 0, 71);
    const double along = u + joint;
    const int piece = static_cast<int>(std::floor(along * 2.0)) % 2;
    const double end = std::abs(along * 2.0 - std::round(along * 2.0)) / 2.0;
    const double seam =
        std::max(smooth_step(0.03, 0.0, std::min(across, 1.0 - across)), smooth_step(0.0016, 0.0, end));
    return {row, hash01(i, piece, 1, 72), seam, hash01(i, piece, 2, 73)};
}

double grain(double u, double v, const Stave& s) {
    const double wander = fractal2(u * 3, v * 16, 0, 2, 74 + static_cast<std::uint32_t>(s.shift * 64.0));
    return 0.5 + 0.5 * std::sin(2 * pi * (v * staves * 2.6 + 3.2 * wander + 7.0 * s.shift));
}

// Blends the grain across the seam of the tile in u, because the noise of a stave is not periodic.
double seamless_grain(double u, double v, const Stave& s) {
    const double blend = smooth_step(0.85, 1.0, u);
    return (1.0 - blend) * grain(u, v, s) + blend * grain(u - 1.0, v, s);
}

Vec3 beech_paint(double u, double v) {
    const Stave s = stave(u, v);
    const double rings = seamless_grain(u, v, s);
    const double flecks = fractal2(u * 24, v * 256, 0, 2, 75);
    const double wear = fractal2(u * 4, v * 4, 4, 4, 76);
    const Vec3 light = from_srgb(0xB9946B);
    const Vec3 dark = from_srgb(0x7A5736);
    Vec3 c = light + (dark - light) * (0.18 * rings + 0.55 * s.tone + 0.22 * flecks - 0.05);
    c *= (0.80 + 0.3 * wear) * (1.0 - 0.55 * s.seam);
    // Oil stains darken the wood in places.
    const double oil = smooth_step(0.56, 0.74, fractal2(u * 3, v * 3, 3, 5, 78));
    c *= Vec3(1.0 - 0.38 * oil, 1.0 - 0.42 * oil, 1.0 - 0.44 * oil);
    return c;
}

Vec3 beech_gloss(double u, double v) {
    const double oil = smooth_step(0.56, 0.74, fractal2(u * 3, v * 3, 3, 5, 78));
    return {1.0, 0.66 - 0.2 * oil + 0.15 * (fractal2(u * 20, v * 20, 20, 2, 79) - 0.5), 0.0};
}

double beech_height(double u, double v) {
    const Stave s = stave(u, v);
    return 0.10 * mm * seamless_grain(u, v, s) + 0.06 * mm * fractal2(u * 16, v * 128, 0, 2, 77) -
           0.35 * mm * s.seam;
}

// Surface-ground steel: fine lines along u, a few scratches, and a film of oil that smooths them.
double lines(double u, double v) {
    return 0.6 * noise2(u * 4, v * 256, 256, 81) + 0.4 * noise2(u * 8, v * 512, 512, 82);
}
double periodic_lines(double u, double v) {
    const double blend = smooth_step(0.8, 1.0, u);
    return (1.0 - blend) * lines(u, v) + blend * lines(u - 1.0, v);
}
Vec3 ground_gloss(double u, double v) {
    const double cloud = fractal2(u * 3, v * 3, 3, 4, 83);
    return {1.0, std::clamp(0.24 + 0.16 * (periodic_lines(u, v) - 0.5) + 0.26 * (cloud - 0.4), 0.12, 0.8),
            1.0};
}
double ground_height(double u, double v) { return 0.010 * mm * periodic_lines(u, v); }

double orange_peel(double u, double v) { return 0.045 * mm * fractal2(u * 60, v * 60, 60, 2, 91); }
double rolled_wall(double u, double v) { return 0.35 * mm * fractal2(u * 90, v * 90, 90, 2, 92); }

// Square holes of 10 mm every 40 mm.
double hole(double u, double v) {
    const auto off = [](double x) { return std::abs(x * 4.0 - std::floor(x * 4.0) - 0.5) * 40.0; };  // mm
    const Vec3 q(std::max(off(u) - 4.0, 0.0), std::max(off(v) - 4.0, 0.0), 0.0);
    return smooth_step(1.35, 0.85, glm::length(q));
}
Vec3 board_paint(double u, double v) { return Vec3(1.0 - 0.96 * hole(u, v)); }
double board_height(double u, double v) {
    return -1.2 * mm * hole(u, v) + 0.03 * mm * fractal2(u * 40, v * 40, 40, 2, 93);
}

assets::Material untextured(const std::string& name, const Vec3& colour, double metallic, double roughness) {
    assets::Material m;
    m.name = name;
    m.base_color = glm::vec4(glm::vec3(colour), 1.0F);
    m.metallic = static_cast<float>(metallic);
    m.roughness = static_cast<float>(roughness);
    return m;
}

// Adds textures to materials and keeps the first error.
struct TextureAdder {
    assets::Model& model;
    Status status;

    void store(const Result<assets::TextureRef>& ref, assets::TextureRef& out) {
        if (ref) out = *ref;
        if (!ref && status) status = tl::unexpected(ref.error());
    }
    void colour(assets::Material& m, int size, const PaintFunction& paint) {
        store(add_colour(model, m.name + "_colour", size, paint), m.base_color_texture);
    }
    void gloss(assets::Material& m, int size, const PaintFunction& paint) {
        store(add_data(model, m.name + "_gloss", size, paint), m.metallic_roughness_texture);
    }
    void normals(assets::Material& m, int size, int index, const HeightFunction& height) {
        const double length = 1.0 / workshop_repeats[static_cast<std::size_t>(index)];
        store(add_normals(model, m.name + "_normal", size, length, height), m.normal_texture);
    }
};

}  // namespace

Status add_workshop_materials(assets::Model& model) {
    std::vector<assets::Material> all(workshop_materials);
    TextureAdder textures{model, {}};

    assets::Material& floor = all[concrete] = untextured("concrete", Vec3(1.0), 0.0, 1.0);
    textures.colour(floor, 512, concrete_paint);
    textures.gloss(floor, 256, concrete_gloss);
    textures.normals(floor, 512, concrete, concrete_height);
    all[line_paint] = untextured("line_paint", from_srgb(0xD8A71C), 0.0, 0.55);

    all[wall_upper] = untextured("wall_upper", from_srgb(0xC9CBC6), 0.0, 0.85);
    textures.normals(all[wall_upper], 256, wall_upper, rolled_wall);
    all[wall_lower] = untextured("wall_lower", from_srgb(0x55666B), 0.0, 0.6);
    all[wall_lower].normal_texture = all[wall_upper].normal_texture;

    all[beech] = untextured("beech", Vec3(1.0), 0.0, 1.0);
    textures.gloss(all[beech], 256, beech_gloss);
    textures.colour(all[beech], 512, beech_paint);
    textures.normals(all[beech], 512, beech, beech_height);

    all[frame_paint] = untextured("frame_paint", from_srgb(0x3A4046), 0.0, 0.42);
    textures.normals(all[frame_paint], 256, frame_paint, orange_peel);
    all[drawer_paint] = untextured("drawer_paint", from_srgb(0x2F5F8A), 0.0, 0.38);
    all[drawer_paint].normal_texture = all[frame_paint].normal_texture;

    all[ground_steel] = untextured("ground_steel", from_srgb(0xB6B7B5), 1.0, 1.0);
    textures.gloss(all[ground_steel], 256, ground_gloss);
    textures.normals(all[ground_steel], 256, ground_steel, ground_height);
    all[zinc] = untextured("zinc", from_srgb(0xC9CED2), 1.0, 0.34);

    all[board_steel] = untextured("board_steel", from_srgb(0x9BA3A8), 0.0, 0.45);
    textures.colour(all[board_steel], 256, board_paint);
    textures.normals(all[board_steel], 256, board_steel, board_height);

    all[tool_chrome] = untextured("tool_chrome", from_srgb(0xC6C8CB), 1.0, 0.22);
    all[tool_black] = untextured("tool_black", from_srgb(0x2B2B2D), 0.9, 0.42);
    all[tool_grip] = untextured("tool_grip", from_srgb(0xB01E28), 0.0, 0.45);
    all[lamp_housing] = untextured("lamp_housing", from_srgb(0xE4E5E3), 0.0, 0.5);
    all[lamp_glow] = untextured("lamp_glow", Vec3(0.9), 0.0, 0.6);
    all[lamp_glow].emissive = glm::vec3(room::strip_lights[0].colour);
    // Bright enough to look like a lamp. The illumination comes from the light nodes and the environment map.
    all[lamp_glow].emissive_strength = 8.0F;
    model.materials = std::move(all);
    return textures.status;
}

}  // namespace bolt::sculpt
