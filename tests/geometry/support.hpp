// Small machines made of prisms, with a file that describes them: right in every number, to be spoiled by a
// test.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "content/format/assembly.hpp"
#include "engine/assets/model.hpp"
#include "engine/base/math.hpp"
#include "tools/author/geometry/bvh.hpp"
#include "tools/author/geometry/check.hpp"

namespace geometry_test {

using bolt::Vec3;

inline constexpr double mm = 1e-3;

// A surface that grows by prisms; millimetres.
struct Shape {
    std::vector<Vec3> points;
    std::vector<std::uint32_t> indices;

    void quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
    // Between two outlines (x, z) of as many points, counterclockwise seen from above; closed: they go all
    // round.
    void between(const std::vector<glm::dvec2>& inner, const std::vector<glm::dvec2>& outer, double low,
                 double high, bool closed = true);
    void box(const Vec3& low, const Vec3& high);
};

std::vector<glm::dvec2> circle(double radius, int points = 48, Vec3 middle = Vec3{0.0});
std::vector<glm::dvec2> hexagon(double across_flats, int points = 48);
std::vector<glm::dvec2> square(double side, int points = 48, Vec3 middle = Vec3{0.0});

// The sector of a ring from one angle to another, degrees, counted as the handle of a wrench counts them.
Shape sector(double inner, double outer, double from_deg, double to_deg, double low, double high);

struct NutAndBolt {  // of M8; what a test spoils
    double nut_flats = 13.0, nut_low = 1.6, washer_low = 0.0, hole = 9.0, bolt_diameter = 8.0,
           bolt_length = 30.0;
    double hole_shift = 0.0 /* along X and Z */, nut_shift = 0.0, plate_low = 0.0, grip = 16.0, side = 40.0;
};

// A machine of plates and M8 bolts on them.
struct Machine {
    explicit Machine(std::vector<Vec3> positions_mm = {Vec3{0.0}}, const NutAndBolt& sizes = {});

    bolt::assets::Model model;

    int node(const std::string& name);  // its index; fails the test if there is none
    void add(const std::string& name, const Shape& shape);
};

// What bolt-author would say: writes machine and file into a folder of their own, loads and checks them.
// `edit` changes the text of assembly.json before it is written.
struct Said {
    std::vector<std::string> errors, notes;  // "line:column: pointer: what; expected"
};
std::string all(const std::vector<std::string>& messages);  // a line each
using Edit = std::function<void(std::string&)>;
Said check(const Machine& machine, const Edit& edit = {}, const Machine* far = nullptr,
           const bolt::assets::Model* contact = nullptr, const bolt::assets::Model* tool = nullptr);

void replace(std::string& text, std::string_view from, std::string_view to);

std::vector<bolt::geometry::Triangle> triangles_of(const Shape& shape);  // metres
bolt::assets::Mesh mesh_of(const Shape& shape);                          // metres

}  // namespace geometry_test
