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

// An M8x30 with its head and a washer on the base, `sunk` mm too deep, and its nut under the cover.
Machine turned_at_head(double sunk = 0.0) {
    Machine machine;
    reshape(
        machine, "B1_bolt",
        {prism(circle(4.0), 1.6 - sunk - 30.0, 1.6 - sunk), prism(hexagon(13.0), 1.6 - sunk, 6.9 - sunk)});
    PrismMesh washer, nut;
    washer.between(circle(4.2), circle(8.0), 0.0, 1.6);
    nut.between(circle(3.4), hexagon(13.0), -17.6 - 6.8, -17.6);
    reshape(machine, "B1_washer_head", {washer});
    PrismMesh below;
    below.between(circle(4.2), circle(8.0), -17.6, -16.0);
    reshape(machine, "B1_washer_nut", {below});
    reshape(machine, "B1_nut", {nut});
    return machine;
}

void at_head(std::string& text) { replace(text, R"("size": "M8",)", R"("size": "M8", "turned": "head",)"); }

// A stud that stands out of a housing under the cover by 28 mm and is screwed into it by 12 mm.
Machine stud(double hole = 6.647) {
    Machine machine;
    reshape(machine, "B1_bolt", {prism(circle(4.0), -28.0, 12.0)});
    machine.model.nodes[static_cast<std::size_t>(machine.node("B1_washer_head"))].name = "spare";
    machine.model.nodes[static_cast<std::size_t>(machine.node("spare"))].mesh = -1;
    PrismMesh housing;
    housing.between(circle(0.5 * hole), square(40.0, 48), -40.0, -16.0);
    machine.add("housing", housing);
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

TEST_CASE("Forms: a socket head gives a note, because lessons have no hexagon key yet") {
    const CheckOutput output = check(turned_at_head(), [](std::string& text) {
        replace(text, R"("size": "M8",)", R"("size": "M8", "turned": "head", "head": "socket",)");
    });
    CHECK(all(output.errors) == "");
    CHECK(all(output.notes).find(R"("B1_bolt" has a socket head, and a lesson has no hexagon key yet)") !=
          std::string::npos);
}

TEST_CASE("Forms: a correct stud has no findings, and one beside a clearance hole is an error") {
    CHECK(all(check(stud(), as_stud).errors) == "");
    CHECK(
        all(check(stud(9.0), as_stud).errors)
            .find(
                R"(no hole is around the end of "B1_bolt"; expected the tapped hole, at most 8.16 mm wide)") !=
        std::string::npos);
}
