#include "tools/assets/sculpt/generated_content.hpp"

#include <algorithm>
#include <array>

#include "tools/assets/sculpt/environment.hpp"
#include "tools/assets/sculpt/quantise.hpp"
#include "tools/assets/sculpt/solid.hpp"
#include "tools/assets/sculpt/workshop_materials.hpp"

namespace bolt::sculpt {

namespace {

// The distance field of a plate with half thickness `half` and rounded edges, from the distance `flat` in its
// plane.
double plate(double flat, double z, double half, double round) {
    return smooth_intersection(flat, std::abs(z) - half, round);
}

double hexagon(double x, double y, double half_width) {
    const double ax = std::abs(x);
    const double ay = std::abs(y);
    return std::max(ax, 0.5 * ax + 0.8660254037844386 * ay) - half_width;
}

// The tools on the board are detailed enough to be recognised at three metres. Each hangs down from `peg`,
// flat against the plane z = peg.z.

// A combination spanner with the proportions of ISO 7738, ring up, jaw down.
void hang_spanner(SolidBuilder& out, const Vec3& peg, double across_flats_mm) {
    const double s = across_flats_mm * mm;
    const double length = 7.2 * s + 55 * mm;  // from ring to jaw
    const double ring_half = 0.34 * s;
    const auto field = [=](const Vec3& p) {
        const double ring = plate(std::hypot(p.x, p.y) - 0.76 * s, p.z, ring_half, 1.5 * mm);
        const Vec3 jaw_at(p.x, p.y + length, p.z);
        const double c = std::cos(to_radians(15.0));
        const double sn = std::sin(to_radians(15.0));
        const double jx = c * jaw_at.x - sn * jaw_at.y;
        const double jy = sn * jaw_at.x + c * jaw_at.y;
        const double jaw = plate(std::hypot(jx, jy - 0.08 * s) - 1.06 * s, p.z, 0.26 * s, 1.5 * mm);
        const double t = std::clamp(-p.y / length, 0.0, 1.0);
        const double beam = plate(std::abs(p.x) - (0.36 - 0.04 * t) * s, p.z, 0.16 * s, 0.12 * s);
        const double shaft = std::max(beam, std::max(p.y, -p.y - length));
        double d = smooth_union(smooth_union(ring, shaft, 0.35 * s), jaw, 0.35 * s);
        d = smooth_difference(d, hexagon(p.x, p.y, 0.5 * s), 0.8 * mm);
        const double mouth = std::max(std::abs(jx) - 0.5 * s, jy - 0.45 * s);
        return smooth_difference(d, mouth, 0.8 * mm);
    };
    const FieldBounds box{{-1.2 * s, -length - 1.3 * s, -0.5 * s}, {1.2 * s, 0.95 * s, 0.5 * s}};
    out.add_field(tool_chrome, field, box, std::max(0.9 * mm, 0.045 * s), 1700,
                  peg + Vec3(0.0, -0.42 * s, ring_half + 1 * mm));
}

// An engineer's hammer, head up.
void hang_hammer(SolidBuilder& out, const Vec3& peg) {
    const Vec3 at = peg + Vec3(0.0, -24 * mm, 20 * mm);
    const auto head = [](const Vec3& p) {
        const double taper = 15 * mm - 0.09 * std::max(p.x, 0.0);
        const double block = rounded_box(p, Vec3(34 * mm, taper, 14.5 * mm), 4 * mm);
        const double peen =
            rounded_box(p - Vec3(48, 0, 0) * mm,
                        Vec3(16 * mm, 14 * mm - 0.62 * std::max(p.x - 32 * mm, 0.0), 13 * mm), 3 * mm);
        const double face = rounded_box(p - Vec3(-41, 0, 0) * mm, Vec3(12, 15, 15) * mm, 5 * mm);
        return smooth_union(smooth_union(block, peen, 3 * mm), face, 4 * mm);
    };
    out.add_field(tool_black, head, {Vec3(-60, -24, -22) * mm, Vec3(70, 24, 22) * mm}, 1.3 * mm, 900, at);
    const auto handle = [](const Vec3& p) {
        const double t = std::clamp(-p.y / (300 * mm), 0.0, 1.0);
        const double swell = 1.0 + 0.22 * std::sin(pi * (t * 1.35 - 0.25));
        const double round =
            (std::hypot(p.x / (13 * mm * swell), p.z / (9.5 * mm * swell)) - 1.0) * 9.5 * mm * swell;
        return smooth_intersection(round, std::abs(p.y + 142 * mm) - 158 * mm, 5 * mm);
    };
    out.add_field(beech, handle, {Vec3(-24, -310, -18) * mm, Vec3(24, 26, 18) * mm}, 1.6 * mm, 900, at);
}

// A screwdriver, handle up. `length` is that of the blade (m).
void hang_screwdriver(SolidBuilder& out, const Vec3& peg, double length) {
    const Vec3 at = peg + Vec3(0.0, -60 * mm, 17 * mm);
    const auto handle = [](const Vec3& p) {
        const double turn = std::atan2(p.z, p.x);
        const double flute = 0.9 * mm * std::cos(6.0 * turn);
        const double y = p.y / mm;
        const double radius = 14.5 * mm - 2.5 * mm * std::exp(-square((y + 42) / 9.0)) -
                              flute * smooth_step(58, 40, y) * smooth_step(-34, -20, y);
        return smooth_intersection(std::hypot(p.x, p.z) - radius, std::abs(p.y) - 57 * mm, 10 * mm);
    };
    out.add_field(tool_grip, handle, {Vec3(-20, -62, -20) * mm, Vec3(20, 62, 20) * mm}, 1.2 * mm, 1100, at);
    const std::array<glm::dvec2, 6> blade{{{0.0, 0.0},
                                           {2.2 * mm, 0.0},
                                           {4.6 * mm, 14 * mm},
                                           {3.2 * mm, 22 * mm},
                                           {3.2 * mm, length},
                                           {0.0, length}}};
    out.add_turned(tool_chrome, at - Vec3(0.0, 55 * mm + length, 0.0), blade, 16);
}

constexpr double plate_thickness = 32 * mm;
constexpr double plate_length = 1.00;
constexpr double plate_depth = 0.62;
constexpr double top_thickness = 45 * mm;
constexpr double top_length = 1.9;
constexpr double top_depth = 0.82;
constexpr double top_z = 0.02;  // middle of the bench
constexpr double under_top = -plate_thickness - top_thickness;
constexpr SolidBuilder::Rounding crisp{0.8 * mm, 1};
constexpr SolidBuilder::Rounding soft{3 * mm, 2};

void add_room(assets::Model& model, SolidBuilder& solid) {
    solid.add_box(concrete, {0.0, room::floor - 0.05, 1.6}, {6.4, 0.1, 4.6}, {1 * mm, 1});
    solid.add_to(model, "floor");
    for (const double x : {-1.45, 1.45}) {
        solid.add_box(line_paint, {x, room::floor, 1.9}, {0.075, 0.8 * mm, 3.6}, {0.3 * mm, 1});
    }
    solid.add_box(line_paint, {0.0, room::floor, 1.35}, {2.825, 0.8 * mm, 0.075}, {0.3 * mm, 1});
    solid.add_to(model, "floor_lines");
    const double wall = room::back_wall - 0.05;
    const double lower = room::dado - room::floor;
    const double upper = 2.3 - room::dado;
    solid.add_box(wall_lower, {0.0, room::floor + 0.5 * lower, wall}, {6.4, lower, 0.1}, crisp);
    solid.add_box(wall_upper, {0.0, room::dado + 0.5 * upper, wall}, {6.4, upper, 0.1}, crisp);
    // The skirting board.
    solid.add_box(frame_paint, {0.0, room::floor + 0.05, room::back_wall + 0.006}, {6.4, 0.1, 0.012}, soft);
    solid.add_to(model, "back_wall");
}

void add_plate(assets::Model& model, SolidBuilder& solid) {
    // Five bars on a base form four T-slots, of which only the mouths are visible.
    constexpr int bars = 5;
    constexpr double slot = 16 * mm;
    constexpr double bar = (plate_depth - (bars - 1) * slot) / bars;
    solid.add_box(ground_steel, {0.0, -plate_thickness + 6 * mm, 0.0},
                  {plate_length - 2 * mm, 12 * mm, plate_depth - 2 * mm}, crisp);
    for (int i = 0; i < bars; ++i) {
        const double z = -0.5 * plate_depth + 0.5 * bar + i * (bar + slot);
        const double height = plate_thickness - 8 * mm;
        solid.add_box(ground_steel, {0.0, -0.5 * height, z}, {plate_length, height, bar}, {1.2 * mm, 2});
    }
    solid.add_to(model, "clamping_plate");
}

void add_drawers(SolidBuilder& solid, double x, double low, double high) {
    constexpr double width = 0.46;
    constexpr double depth = 0.62;
    const double middle = 0.5 * (low + high);
    solid.add_box(frame_paint, {x, middle, top_z}, {width, high - low, depth}, soft);
    const double front = top_z + 0.5 * depth + 9 * mm;
    const std::array<double, 3> heights{0.26, 0.32, 0.42};
    double y = high - 12 * mm;
    for (const double part : heights) {
        const double height = part * (high - low - 24 * mm);
        solid.add_box(drawer_paint, {x, y - 0.5 * height, front}, {width - 24 * mm, height - 7 * mm, 18 * mm},
                      soft);
        // A bent-sheet handle over the upper edge.
        solid.add_box(zinc, {x, y - 26 * mm, front + 19 * mm}, {width - 150 * mm, 14 * mm, 5 * mm},
                      {2.4 * mm, 2});
        for (const double side : {-1.0, 1.0}) {
            solid.add_box(zinc, {x + side * (0.5 * width - 84 * mm), y - 26 * mm, front + 13 * mm},
                          {9 * mm, 14 * mm, 14 * mm}, {2 * mm, 2});
        }
        y -= height;
    }
}

void add_bench(assets::Model& model, SolidBuilder& solid) {
    solid.add_box(beech, {0.0, -plate_thickness - 0.5 * top_thickness, top_z},
                  {top_length, top_thickness, top_depth}, {4 * mm, 2});
    solid.add_to(model, "bench_top");

    constexpr double tube = 60 * mm;
    const double leg_x = 0.5 * top_length - 0.09;
    const double leg_z = 0.5 * top_depth - 0.07;
    const double foot = room::floor + 45 * mm;
    for (const double x : {-leg_x, leg_x}) {
        for (const double z : {top_z - leg_z, top_z + leg_z}) {
            solid.add_box(frame_paint, {x, 0.5 * (under_top + foot), z}, {tube, under_top - foot, tube},
                          {6 * mm, 2});
            const std::array<glm::dvec2, 6> leveller{{{0.0, 0.0},
                                                      {34 * mm, 0.0},
                                                      {34 * mm, 7 * mm},
                                                      {13 * mm, 15 * mm},
                                                      {9 * mm, 15 * mm},
                                                      {9 * mm, 46 * mm}}};
            solid.add_turned(zinc, {x, room::floor, z}, leveller, 24);
        }
        solid.add_box(frame_paint, {x, under_top - 0.5 * tube, top_z}, {tube, tube, 2 * leg_z - tube},
                      {6 * mm, 2});
        solid.add_box(frame_paint, {x, room::floor + 0.16, top_z}, {0.04, 0.04, 2 * leg_z - tube},
                      {4 * mm, 2});
    }
    for (const double z : {top_z - leg_z, top_z + leg_z}) {
        solid.add_box(frame_paint, {0.0, under_top - 0.5 * tube, z}, {2 * leg_x - tube, tube, tube},
                      {6 * mm, 2});
    }
    solid.add_box(frame_paint, {0.0, room::floor + 0.16, top_z - leg_z}, {2 * leg_x - tube, 0.04, 0.04},
                  {4 * mm, 2});
    // The shelf, a folded sheet.
    solid.add_box(frame_paint, {-0.24, room::floor + 0.188, top_z},
                  {2 * leg_x - tube - 0.5, 16 * mm, 2 * leg_z - 0.06}, {3 * mm, 2});
    solid.add_to(model, "bench_frame");
    add_drawers(solid, leg_x - 0.5 * tube - 0.24, room::floor + 0.20, under_top - tube - 4 * mm);
    solid.add_to(model, "bench_drawers");
}

void add_board(assets::Model& model, SolidBuilder& solid) {
    const double z = room::back_wall + 30 * mm;
    solid.add_box(board_steel, {0.0, 0.68, z}, {1.36, 0.48, 18 * mm}, soft);
    for (const double x : {-0.6, 0.6}) {
        solid.add_box(frame_paint, {x, 0.68, room::back_wall + 10 * mm}, {0.05, 0.4, 22 * mm}, crisp);
    }
    solid.add_to(model, "tool_board");

    const double face = z + 9 * mm;
    const std::array<double, 5> sizes{30, 24, 19, 17, 13};
    double x = -0.60;
    for (const double size : sizes) {
        const Vec3 peg(x, 0.86, face);
        hang_spanner(solid, peg, size);
        x += 0.105 - 0.0012 * (30 - size);
    }
    const Vec3 hammer(0.11, 0.86, face);
    hang_hammer(solid, hammer);
    hang_screwdriver(solid, {0.34, 0.86, face}, 0.20);
    hang_screwdriver(solid, {0.42, 0.86, face}, 0.15);
    hang_screwdriver(solid, {0.50, 0.86, face}, 0.10);
    solid.add_to(model, "tools");
    // Pegs and clips.
    const Quat forward = glm::angleAxis(0.5 * pi, Vec3(1, 0, 0));
    const std::array<glm::dvec2, 4> pin{
        {{3 * mm, 0.0}, {3 * mm, 30 * mm}, {2 * mm, 31 * mm}, {0.0, 31 * mm}}};
    x = -0.60;
    for (const double size : sizes) {
        solid.add_turned(zinc, {x, 0.86 - 2 * mm, face}, pin, 12, forward);
        x += 0.105 - 0.0012 * (30 - size);
    }
    for (const double side : {-20.0, 20.0})
        solid.add_turned(zinc, hammer + Vec3(side * mm, -44 * mm, 0.0), pin, 12, forward);
    for (const double holder : {0.34, 0.42, 0.50}) {
        solid.add_box(zinc, {holder, 0.86 - 113 * mm, face + 14 * mm}, {0.05, 4 * mm, 28 * mm},
                      {1.5 * mm, 1});
    }
    solid.add_to(model, "tool_pegs");
}

void add_light(assets::Model& model, const std::string& name, const assets::Light& light,
               const Vec3& position, const Vec3& direction) {
    assets::Node node;
    node.name = name;
    node.translation = glm::vec3(rounded(position, micron));
    const Vec3 z = -glm::normalize(direction);
    const Vec3 across = std::abs(z.x) > 0.9 ? Vec3(0, 1, 0) : Vec3(1, 0, 0);
    const Vec3 y = glm::normalize(glm::cross(z, across));
    const Quat turn = glm::normalize(glm::quat_cast(glm::dmat3(glm::cross(y, z), y, z)));
    node.rotation = glm::quat(
        Quat(rounded(turn.w, 1e-7), rounded(turn.x, 1e-7), rounded(turn.y, 1e-7), rounded(turn.z, 1e-7)));
    node.light = static_cast<int>(model.lights.size());
    model.lights.push_back(light);
    model.lights.back().name = name;
    model.roots.push_back(static_cast<int>(model.nodes.size()));
    model.nodes.push_back(std::move(node));
}

// Adds the strip lights and the window light. The intensity of a strip straight down is its radiance times
// its area; two spot lights share it.
void add_lights(assets::Model& model, SolidBuilder& solid) {
    for (const room::StripLight& s : room::strip_lights) {
        solid.add_box(lamp_housing, s.centre + Vec3(0, 0.045, 0), {s.length + 0.06, 0.07, s.width + 0.05},
                      {6 * mm, 2});
        solid.add_box(lamp_glow, s.centre + Vec3(0, 0.006, 0), {s.length, 0.014, s.width}, {3 * mm, 1});
        for (const double side : {-0.4, 0.4}) {
            const std::array<glm::dvec2, 2> cord{
                {{2 * mm, 0.0}, {2 * mm, room::ceiling - s.centre.y - 0.08}}};
            solid.add_turned(lamp_housing, s.centre + Vec3(side * s.length, 0.08, 0), cord, 8);
        }
    }
    solid.add_to(model, "strip_lights");
    for (std::size_t i = 0; i < room::strip_lights.size(); ++i) {
        const room::StripLight& s = room::strip_lights[i];
        assets::Light light;
        light.type = assets::LightType::spot;
        light.color = glm::vec3(s.colour);
        light.intensity = static_cast<float>(0.5 * s.radiance * s.length * s.width);
        light.inner_cone = 0.6F;
        light.outer_cone = 1.4F;
        for (const double side : {-0.25, 0.25}) {
            const std::string name =
                "light_strip_" + std::to_string(i + 1) + (side < 0.0 ? "_left" : "_right");
            add_light(model, name, light, s.centre + Vec3(side * s.length, -0.02, 0.0), {0.0, -1.0, 0.0});
        }
    }
    assets::Light window;
    window.type = assets::LightType::directional;
    window.color = {0.72F, 0.86F, 1.0F};
    window.intensity = 0.8F;
    add_light(model, "light_window", window, {-3.0, 1.6, 1.6}, {0.86, -0.42, -0.30});
}

}  // namespace

Result<assets::Model> make_workshop() {
    assets::Model model;
    model.generator = "bolt-sculpt";
    if (Status s = add_workshop_materials(model); !s) return tl::unexpected(s.error());
    SolidBuilder solid(workshop_repeats);
    assets::Node mount;
    mount.name = "machine_mount";
    model.nodes.push_back(mount);
    model.roots.push_back(0);
    add_room(model, solid);
    add_plate(model, solid);
    add_bench(model, solid);
    add_board(model, solid);
    add_lights(model, solid);
    return model;
}

}  // namespace bolt::sculpt
