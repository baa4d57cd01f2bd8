// Small machines made of prisms, with a matching assembly file. They are correct; each test introduces one
// mistake.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "content/format/assembly.hpp"
#include "engine/assets/model.hpp"
#include "engine/base/math.hpp"
#include "tools/author/geometry/bvh.hpp"
#include "tools/author/geometry/check.hpp"
#include "tools/author/geometry/tool_geometry.hpp"

namespace geometry_test {

using bolt::Vec3;

// Builds a triangle mesh from prisms; millimetres.
struct PrismMesh {
    std::vector<Vec3> points;
    std::vector<std::uint32_t> indices;

    void quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
    // Adds the prism between two outlines (x, z) with equal point counts, counterclockwise seen from above.
    // `closed`: the outlines are closed loops.
    void between(const std::vector<glm::dvec2>& inner, const std::vector<glm::dvec2>& outer, double low,
                 double high, bool closed = true);
    void box(const Vec3& low, const Vec3& high);
};

std::vector<glm::dvec2> circle(double radius, int points = 48, Vec3 middle = Vec3{0.0});
std::vector<glm::dvec2> hexagon(double across_flats, int points = 48);
std::vector<glm::dvec2> square(double side, int points = 48, Vec3 middle = Vec3{0.0});

// The sector of a ring between two angles (degrees, as handle angles of a wrench).
PrismMesh sector(double inner, double outer, double from_deg, double to_deg, double low, double high);

// Dimensions of an M8 joint, mm; tests change them.
struct NutAndBolt {
    double nut_flats = 13.0, nut_low = 1.6, washer_low = 0.0, hole = 9.0, bolt_diameter = 8.0,
           bolt_length = 30.0;
    double hole_shift = 0.0 /* along X and Z */, nut_shift = 0.0, plate_low = 0.0, grip = 16.0, side = 40.0;
};

// A machine of plates and M8 bolts on them.
struct Machine {
    explicit Machine(std::vector<Vec3> positions_mm = {Vec3{0.0}}, const NutAndBolt& sizes = {});

    bolt::assets::Model model;

    int node(const std::string& name);  // returns its index; fails the test if there is none
    void add(const std::string& name, const PrismMesh& shape);
};

// Dimensions of a plain wrench relative to the jaw opening, close to forged double-ended wrenches (DIN 3110:
// a 24 mm wrench has a head of 50 to 52 mm, 10 to 11 mm thick). The handle has the thickness of the head,
// which is conservative.
inline constexpr double head_width_ratio = 2.1;
inline constexpr double thickness_ratio = 0.45;
inline constexpr double handle_width_ratio = 0.85;
inline constexpr double jaw_depth_ratio = 0.6;  // middle of the jaw to its throat; a hexagon needs 0.577
// Length of the wrench from the middle of the jaw / distance from there to the middle of the grip.
inline constexpr double handle_beyond_grip = 1.12;

// A wrench whose swing between walls has a closed form: a disc with a slot, and a straight handle.
bolt::geometry::ToolGeometry plain_wrench(const bolt::content::WrenchDesign& design);

// The wrench's triangles as a model; millimetres are multiplied by `scale`.
bolt::assets::Model model_of(const bolt::geometry::ToolGeometry& wrench, double shift_mm = 0.0,
                             double scale = 1.0, bool lies = false);

// Output of bolt-author validate.
struct CheckOutput {
    std::vector<std::string> errors, notes;  // "line:column: pointer: what; expected"
    std::optional<bolt::geometry::DrawnToolRooms> rooms;
};
std::string all(const std::vector<std::string>& messages);  // one line each
using Edit = std::function<void(std::string&)>;
// Writes the machine and its file into a temporary folder, loads and checks them. `edit` changes the text of
// assembly.json before it is written. Open ends without a model get that of plain_wrench(); other tools
// are generated.
CheckOutput check(const Machine& machine, const Edit& edit = {}, const Machine* far = nullptr,
                  const bolt::assets::Model* contact = nullptr, const bolt::assets::Model* tool = nullptr);
// The same with generated tools.
CheckOutput check_generated(const Machine& machine, const Edit& edit = {});

void replace(std::string& text, std::string_view from, std::string_view to);

std::vector<bolt::geometry::Triangle> triangles_of(const PrismMesh& shape);  // metres
bolt::assets::Mesh mesh_of(const PrismMesh& shape);                          // metres

}  // namespace geometry_test
