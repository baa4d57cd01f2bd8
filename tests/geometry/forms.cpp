// The checks of a model whose joint is turned at its head, or is a stud in a tapped hole.
#include <doctest/doctest.h>

#include "support.hpp"

using namespace bolt;
using namespace geometry_test;

namespace {

PrismMesh prism(const std::vector<glm::dvec2>& outline, double low, double high) {
    PrismMesh shape;
    shape.between(std::vector<glm::dvec2>(outline.size(), glm::dvec2(0.0)), outline, low, high);
    return shape;
}

// Replaces the mesh of a node; millimetres in the joint's frame.
void reshape(Machine& machine, const std::string& name, const std::vector<PrismMesh>& shapes) {
    PrismMesh all_shapes;
    for (const PrismMesh& shape : shapes) {
        const auto base = static_cast<std::uint32_t>(all_shapes.points.size());
        all_shapes.points.insert(all_shapes.points.end(), shape.points.begin(), shape.points.end());
        for (const std::uint32_t i : shape.indices) all_shapes.indices.push_back(base + i);
    }
    assets::Node& node = machine.model.nodes[static_cast<std::size_t>(machine.node(name))];
    node.mesh = static_cast<int>(machine.model.meshes.size());
    node.translation = glm::vec3(0.0F);
    machine.model.meshes.push_back(mesh_of(all_shapes));
}

// The nut under the cover, mm: how far it is too low or beside the axis, and its width.
struct HeldNut {
    double low = 0.0, beside = 0.0, across_flats = 13.0;
};

// An M8x30 with its head and a washer on the base, `sunk` mm too deep, and its nut under the cover.
Machine turned_at_head(double sunk = 0.0, const HeldNut& held = {}) {
    Machine machine;
    reshape(
        machine, "B1_bolt",
        {prism(circle(4.0), 1.6 - sunk - 30.0, 1.6 - sunk), prism(hexagon(13.0), 1.6 - sunk, 6.9 - sunk)});
    PrismMesh washer, nut;
    washer.between(circle(4.2), circle(8.0), 0.0, 1.6);
    nut.between(circle(3.4), hexagon(held.across_flats), -17.6 - 6.8, -17.6);
    for (Vec3& p : nut.points) p += Vec3{held.beside, -held.low, 0.0};
    reshape(machine, "B1_washer_head", {washer});
    PrismMesh below;
    below.between(circle(4.2), circle(8.0), -17.6, -16.0);
    reshape(machine, "B1_washer_nut", {below});
    reshape(machine, "B1_nut", {nut});
    return machine;
}

void with_key(std::string& text) {
    replace(text, R"("size": "M8",)", R"("size": "M8", "turned": "head", "head": "socket",)");
    replace(text, R"("kind": "open_end_wrench", "jaw_mm": 13.2)", R"("kind": "hex_key", "size_mm": 6)");
}

// A socket head, mm: the socket's width (0: none), depth and distance from the axis, and the head's height.
struct SocketSizes {
    double across_flats = 6.0, depth = 4.0, height = 8.0, beside = 0.0;
};

// The same joint with a cap screw.
Machine socket_head(const SocketSizes& sizes) {
    Machine machine = turned_at_head();
    const double face = 1.6, top = face + sizes.height, bottom = top - sizes.depth;
    std::vector<PrismMesh> shapes = {prism(circle(4.0), face - 30.0, face)};
    if (sizes.across_flats > 0.0) {
        std::vector<glm::dvec2> hole = hexagon(sizes.across_flats);
        PrismMesh rim;
        std::vector<glm::dvec2> outside;
        for (glm::dvec2& corner : hole) {
            outside.push_back(corner * (6.5 / glm::length(corner)));
            corner.x += sizes.beside;
        }
        rim.between(hole, outside, bottom, top);
        shapes.push_back(rim);
        shapes.push_back(prism(circle(6.5), face, bottom));
    } else {
        shapes.push_back(prism(circle(6.5), face, top));
    }
    reshape(machine, "B1_bolt", shapes);
    return machine;
}

void at_head(std::string& text) { replace(text, R"("size": "M8",)", R"("size": "M8", "turned": "head",)"); }

// A stud and the housing that it is screwed into, mm: the diameter of the hole, the depth of its bottom
// behind the cover (0: it goes through), its distance from the axis, the thickness of the housing, and the
// two ends of the stud.
struct Stud {
    double hole = 6.647, bottom = 0.0, beside = 0.0, housing = 24.0, low = -28.0, high = 12.0;
};

// A stud that stands out of the housing under the cover by 28 mm and is screwed into it by 12 mm.
Machine stud(const Stud& sizes = {}) {
    Machine machine;
    reshape(machine, "B1_bolt", {prism(circle(4.0), sizes.low, sizes.high)});
    machine.model.nodes[static_cast<std::size_t>(machine.node("B1_washer_head"))].name = "spare";
    machine.model.nodes[static_cast<std::size_t>(machine.node("spare"))].mesh = -1;
    PrismMesh housing;
    housing.between(circle(0.5 * sizes.hole, 48, Vec3{sizes.beside, 0.0, 0.0}), square(40.0, 48),
                    -16.0 - sizes.housing, -16.0);
    machine.add("housing", housing);
    if (sizes.bottom > 0.0)
        machine.add("plug", prism(circle(0.5 * sizes.hole), -16.0 - sizes.housing, -16.0 - sizes.bottom));
    return machine;
}

void as_stud(std::string& text) {
    replace(
        text, R"("bolt_length_mm": 30,)",
        R"("bolt_length_mm": 28, "form": "stud", "tapped_hole": { "material": "C45", "engagement_mm": 12 },)");
    replace(text, R"("washer_under_head": true)", R"("washer_under_head": false)");
}

}  // namespace

TEST_CASE("Forms: a correct bolt that is turned at its head has no findings") {
    const CheckOutput output = check(turned_at_head(), at_head);
    CHECK(all(output.errors) == "");
}

TEST_CASE("Forms: a head that is too deep, too high or no hexagon is an error") {
    CHECK(all(check(turned_at_head(0.5), at_head).errors)
              .find(R"("B1_bolt" is 0.50 mm deep in "B1_washer_head"; expected the two faces in contact)") !=
          std::string::npos);
    CHECK(
        all(check(turned_at_head(-0.3), at_head).errors)
            .find(R"("B1_bolt" is 0.30 mm away from "B1_washer_head"; expected the two faces in contact)") !=
        std::string::npos);
    Machine round = turned_at_head();
    reshape(round, "B1_bolt", {prism(circle(4.0), -28.4, 1.6), prism(circle(7.5), 1.6, 6.9)});
    CHECK(all(check(round, at_head).errors)
              .find(R"("B1_bolt" is not a hexagon about the joint's axis; expected a hexagon head, 13 mm)") !=
          std::string::npos);
}

TEST_CASE("Forms: a socket head is turned with a key or a bit of its size") {
    const auto errors_with = [](const char* tool) {
        return all(check(socket_head({}), [&](std::string& text) {
                       replace(text, R"("size": "M8",)",
                               R"("size": "M8", "turned": "head", "head": "socket",)");
                       replace(text, R"("kind": "open_end_wrench", "jaw_mm": 13.2)", tool);
                   }).errors);
    };
    CHECK(errors_with(R"("kind": "hex_key", "size_mm": 6)") == "");
    CHECK(errors_with(R"("kind": "ratchet", "head": "hex_bit", "size_mm": 6)") == "");
    CHECK(
        errors_with(R"("kind": "open_end_wrench", "jaw_mm": 13.2)") ==
        R"(16:5: /joints/0: the wrench is an open end of 13 mm and does not fit the head of "B1", a hexagonal socket of 6 mm; expected a hexagon key of 6 mm, or a hexagon bit of 6 mm)");
}

TEST_CASE(
    "Forms: a correct socket head has no findings, and one that a key of its size does not fit is an error") {
    const auto errors_with = [](const SocketSizes& sizes) {
        return all(check_generated(socket_head(sizes), with_key).errors);
    };
    CHECK(errors_with({}) == "");
    CHECK(errors_with({.across_flats = 6.1}) == "");
    CHECK(errors_with({.across_flats = 5.0}) ==
          R"(16:5: /joints/0: the socket of "B1_bolt" measures 5.00 mm across flats; expected 6 mm for M8)");
    CHECK(
        errors_with({.beside = 0.05}) ==
        R"(16:5: /joints/0: the socket of "B1_bolt" is 0.05 mm beside the joint's axis; expected at most 0.01 mm)");
    CHECK(errors_with({.depth = 3.0}) ==
          R"(16:5: /joints/0: the socket of "B1_bolt" is 3.00 mm deep; expected at least 4 mm for M8)");
    CHECK(errors_with({.height = 5.0}) ==
          R"(16:5: /joints/0: the head of "B1_bolt" is 5.00 mm high; expected 8 mm for M8 (ISO 4762))");
    CHECK(
        errors_with({.across_flats = 0.0}) ==
        R"(16:5: /joints/0: "B1_bolt" has no hexagonal socket about the joint's axis; expected a socket of 6 mm)");
}

TEST_CASE(
    "Forms: the nut of a bolt that is turned at its head touches its washer, on the axis, in its size") {
    const auto errors_with = [](const HeldNut& held) {
        return all(check(turned_at_head(0.0, held), at_head).errors);
    };
    CHECK(errors_with({.low = 0.04}) == "");
    CHECK(
        errors_with({.low = 0.3}) ==
        R"(16:5: /joints/0: "B1_nut" is 0.30 mm away from "B1_washer_nut"; expected the two faces in contact)");
    CHECK(
        errors_with({.low = -0.2}) ==
        R"(16:5: /joints/0: "B1_nut" is 0.20 mm deep in "B1_washer_nut"; expected the two faces in contact)");
    CHECK(errors_with({.beside = 0.02}) ==
          R"(16:5: /joints/0: "B1_nut" is 0.02 mm beside the joint's axis; expected at most 0.01 mm)");
    CHECK(errors_with({.across_flats = 14.0}) ==
          R"(16:5: /joints/0: "B1_nut" measures 14.00 mm across flats; expected 13 mm for M8)");
    Machine low_washer = turned_at_head();
    low_washer.model.nodes[static_cast<std::size_t>(low_washer.node("B1_washer_nut"))].translation.y =
        -0.0002F;
    CHECK(all(check(low_washer, at_head).errors)
              .find(R"("B1_washer_nut" is 0.20 mm away from the member under the nut)") != std::string::npos);
    Machine round = turned_at_head();
    reshape(round, "B1_nut", {prism(circle(6.5), -24.4, -17.6)});
    CHECK(all(check(round, at_head).errors)
              .find(R"("B1_nut" is not a hexagon about the joint's axis; expected a hexagon nut, 13 mm)") !=
          std::string::npos);
    Machine without = turned_at_head();
    without.model.nodes[static_cast<std::size_t>(without.node("B1_nut"))].name = "fastener";
    CHECK(all(check(without, at_head).errors).find(R"(there is no node "B1_nut" with a mesh)") !=
          std::string::npos);
}

TEST_CASE("Forms: a bolt that is turned at its head has the length and the diameter of its type") {
    Machine machine = turned_at_head();
    reshape(machine, "B1_bolt", {prism(circle(4.0), -27.4, 1.6), prism(hexagon(13.0), 1.6, 6.9)});
    CHECK(all(check(machine, at_head).errors)
              .find(R"("B1_bolt" measures 29.00 mm under its head; expected 30 mm (bolt_length_mm))") !=
          std::string::npos);
    reshape(machine, "B1_bolt", {prism(circle(3.5), -28.4, 1.6), prism(hexagon(13.0), 1.6, 6.9)});
    CHECK(all(check(machine, at_head).errors)
              .find(R"("B1_bolt" measures 7.00 mm across its thread; expected 8 mm for M8)") !=
          std::string::npos);
}

TEST_CASE("Forms: a correct stud has no findings, and one beside a clearance hole is an error") {
    CHECK(all(check(stud(), as_stud).errors) == "");
    CHECK(all(check(stud({.bottom = 14.0}), as_stud).errors) == "");
    CHECK(
        all(check(stud({.hole = 9.0}), as_stud).errors)
            .find(
                R"(no hole is around the end of "B1_bolt"; expected the tapped hole, at most 8.16 mm wide)") !=
        std::string::npos);
}

TEST_CASE("Forms: both ends of a stud are checked") {
    const auto errors_with = [](const Stud& sizes) { return all(check(stud(sizes), as_stud).errors); };
    CHECK(
        errors_with({.low = -27.0}) ==
        R"(16:5: /joints/0: "B1_bolt" reaches 11.00 mm into the tapped part; expected at least 12 mm (engagement_mm))");
    CHECK(errors_with({.low = -12.0})
              .find(R"("B1_bolt" reaches 0.00 mm into the tapped part; expected at least 12 mm)") !=
          std::string::npos);
    CHECK(errors_with({.low = -29.0}) == "");
    CHECK(
        errors_with({.high = 11.0}) ==
        R"(16:5: /joints/0: "B1_bolt" measures 27.00 mm from the tapped part to its end at the nut; expected 28 mm (bolt_length_mm))");
    Machine thin = stud();
    reshape(thin, "B1_bolt", {prism(circle(3.5), -28.0, 12.0)});
    CHECK(all(check(thin, as_stud).errors) ==
          R"(16:5: /joints/0: "B1_bolt" measures 7.00 mm across its thread; expected 8 mm for M8)");
}

TEST_CASE("Forms: the hole of a stud is deep and wide enough, and on the axis") {
    const auto errors_with = [](const Stud& sizes) { return all(check(stud(sizes), as_stud).errors); };
    CHECK(
        errors_with({.bottom = 9.0}) ==
        R"(16:5: /joints/0: "B1_bolt" reaches 12.00 mm behind the members, and the tapped hole in "plug" is 9.00 mm deep; expected a deeper hole, or a shorter thread)");
    const std::string thin = errors_with({.housing = 7.0});
    CHECK(thin.starts_with(R"(16:5: /joints/0: the tapped hole around "B1_bolt" ends 7.0)"));
    CHECK(thin.ends_with("expected at least 12 mm, the engagement"));
    CHECK(errors_with({.housing = 11.5}) == "");  // within the chamfer of one pitch
    CHECK(
        errors_with({.beside = 0.1}) ==
        R"(16:5: /joints/0: the tapped hole in "housing" is 0.1 mm beside the joint's axis; expected at most 0.01 mm)");
    CHECK(
        errors_with({.hole = 5.0}) ==
        R"(16:5: /joints/0: the tapped hole in "housing" measures 5.00 mm; expected 6.47 to 8.16 mm for M8)");
}
