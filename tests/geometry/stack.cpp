// Checks of bolt, washers, nut and members: each mistake gives its own error, and deviations within tolerance
// give none.
#include <doctest/doctest.h>

#include "support.hpp"
#include "tools/author/geometry/scene.hpp"

using namespace bolt;
using namespace geometry_test;

namespace {

std::string errors_of(const NutAndBolt& sizes) { return all(check(Machine({Vec3{0.0}}, sizes)).errors); }

NutAndBolt with(double NutAndBolt::*member, double value) {
    NutAndBolt sizes;
    sizes.*member = value;
    return sizes;
}

std::string at_joint(const std::string& text) { return "16:5: /joints/0: " + text; }

}  // namespace

TEST_CASE("Geometry: a nut more than 0.05 mm inside or above its washer is an error") {
    CHECK(errors_of(with(&NutAndBolt::nut_low, 1.56)) == "");
    CHECK(errors_of(with(&NutAndBolt::nut_low, 1.64)) == "");
    CHECK(errors_of(with(&NutAndBolt::nut_low, 1.54)) ==
          at_joint(R"("B1_nut" is 0.06 mm deep in "B1_washer_nut"; expected the two faces in contact)"));
    CHECK(errors_of(with(&NutAndBolt::nut_low, 1.9)) ==
          at_joint(R"("B1_nut" is 0.30 mm away from "B1_washer_nut"; expected the two faces in contact)"));
}

TEST_CASE("Geometry: a washer inside the member and a face away from position_mm are errors") {
    const std::string deep = errors_of(with(&NutAndBolt::washer_low, -0.1));
    CHECK(deep.starts_with(at_joint(
        R"("B1_washer_nut" is 0.10 mm deep in the member under the nut; expected the two faces in contact)")));
    CHECK(deep.find(R"("B1_washer_nut" overlaps "base"; expected parts that do not overlap)") !=
          std::string::npos);
    CHECK(errors_of(with(&NutAndBolt::plate_low, 0.04)) == "");
    CHECK(
        errors_of(with(&NutAndBolt::plate_low, -0.2))
            .starts_with(at_joint(
                R"(the face of "base" under the nut is 0.20 mm below position_mm; expected position_mm on the face)")));
    CHECK(
        errors_of(with(&NutAndBolt::plate_low, 0.2))
            .starts_with(at_joint(
                R"(the face of "base" under the nut is 0.20 mm beyond position_mm; expected position_mm on the face)")));
}

TEST_CASE("Geometry: members thicker than in the joint type are an error") {
    CHECK(errors_of(with(&NutAndBolt::grip, 16.08)).find("members measure") == std::string::npos);
    CHECK(errors_of(with(&NutAndBolt::grip, 17.0))
              .find("the members measure 17.00 mm in the model, and 16 mm in the joint type; expected both "
                    "within 0.1 mm") != std::string::npos);
}

TEST_CASE("Geometry: a hole smaller than its bolt or off its axis is an error") {
    CHECK(errors_of(with(&NutAndBolt::hole, 8.2)) == "");
    CHECK(errors_of(with(&NutAndBolt::hole, 7.9)) ==
          at_joint(
              R"(the hole in "base" measures 7.90 mm, and the bolt 8 mm; expected 9 mm (ISO 273 medium))"));
    CHECK(errors_of(with(&NutAndBolt::hole_shift, 0.005)) == "");
    CHECK(errors_of(with(&NutAndBolt::hole_shift, 0.02)) ==
          at_joint(R"(the hole in "base" is 0.0283 mm beside the joint's axis; expected at most 0.01 mm)"));
}

TEST_CASE("Geometry: a member without a hole and a missing member are errors") {
    Machine solid;
    PrismMesh plug;
    plug.box({-20, -9, -20}, {20, -8, 20});
    solid.add("plug", plug);
    CHECK(all(check(solid).errors) ==
          at_joint(R"("B1_bolt" overlaps "plug"; expected parts that do not overlap)"));
    Machine empty;
    for (const char* name : {"cover", "base"})
        empty.model.nodes[static_cast<std::size_t>(empty.node(name))].mesh = -1;
    CHECK(all(check(empty).errors).find("no member is under the nut at position_mm") != std::string::npos);
}

TEST_CASE("Geometry: a bolt of another length or diameter is an error") {
    CHECK(errors_of(with(&NutAndBolt::bolt_length, 29.0 + 0.95)) == "");
    CHECK(errors_of(with(&NutAndBolt::bolt_length, 28.0)) ==
          at_joint(R"("B1_bolt" measures 28.00 mm under its head; expected 30 mm (bolt_length_mm))"));
    CHECK(errors_of(with(&NutAndBolt::bolt_diameter, 7.0)) ==
          at_joint(R"("B1_bolt" measures 7.00 mm across its thread; expected 8 mm for M8)"));
}

TEST_CASE("Geometry: the width of a nut is compared with its size and with the jaw") {
    CHECK(errors_of(with(&NutAndBolt::nut_flats, 12.7)) == "");
    CHECK(
        errors_of(with(&NutAndBolt::nut_flats, 12.4)) ==
        at_joint(R"("B1_nut" measures 12.40 mm across flats; expected 13 mm for M8)") + "\n" +
            at_joint(
                R"(a jaw of 13.2 mm is too wide for "B1_nut", 12.40 mm across flats; expected jaw_mm from 12.40 to 13.00)"));
    CHECK(
        errors_of(with(&NutAndBolt::nut_flats, 13.3)) ==
        at_joint(R"("B1_nut" measures 13.30 mm across flats; expected 13 mm for M8)") + "\n" +
            at_joint(
                R"(a jaw of 13.2 mm is too small for "B1_nut", 13.30 mm across flats; expected jaw_mm from 13.30 to 13.90)"));
    const auto spare = [](const char* jaw) {
        return [jaw](std::string& text) {
            replace(text, "\"tool\"",
                    std::string(R"("more_tools": { "bar": { "kind": "open_end_wrench", "jaw_mm": )") + jaw +
                        R"(, "handle_length_mm": 140 } }, "tool")");
        };
    };
    const Machine narrow({Vec3{0.0}}, with(&NutAndBolt::nut_flats, 12.7));
    CHECK(all(check(narrow, spare("13.3")).errors) == "");
    CHECK(
        all(check(narrow, spare("13.5")).errors) ==
        at_joint(
            R"(a jaw of 13.5 mm (the tool "bar") is too wide for "B1_nut", 12.70 mm across flats; expected jaw_mm from 12.70 to 13.30)"));
    CHECK(errors_of(with(&NutAndBolt::nut_shift, 0.02)) ==
          at_joint(R"("B1_nut" is 0.02 mm beside the joint's axis; expected at most 0.01 mm)"));
    CHECK(errors_of(with(&NutAndBolt::nut_shift, 0.005)) == "");
}

TEST_CASE("Geometry: missing, misspelt and superfluous fasteners are errors") {
    Machine machine;
    machine.model.nodes[static_cast<std::size_t>(machine.node("B1_nut"))].name = "B1_nutt";
    CHECK(all(check(machine).errors)
              .starts_with(at_joint(
                  R"(there is no node "B1_nut" with a mesh under "joint_B1"; did you mean "B1_nutt"?)")));
    const auto bare = [](std::string& text) {
        replace(text, "\"washer_under_nut\": true", "\"washer_under_nut\": false");
    };
    CHECK(all(check(Machine(), bare).errors)
              .find(R"(the model has "B1_washer_nut", but the joint type has no such washer)") !=
          std::string::npos);
    machine = Machine();
    machine.model.nodes[static_cast<std::size_t>(machine.node("B1_nut"))].name = "fastener";
    CHECK(
        all(check(machine).errors)
            .starts_with(at_joint(
                R"(there is no node "B1_nut" with a mesh under "joint_B1"; expected a node with this name)")));
    Machine round;
    PrismMesh ring;
    ring.between(circle(4.0), circle(7.0), 0.0, 6.8);
    round.model.meshes[static_cast<std::size_t>(
        round.model.nodes[static_cast<std::size_t>(round.node("B1_nut"))].mesh)] = mesh_of(ring);
    CHECK(
        all(check(round).errors) ==
        at_joint(
            R"("B1_nut" is not a hexagon about the joint's axis; expected a hexagon nut, 13 mm across flats)"));
}

TEST_CASE("Geometry: a part that overlaps a nut, a head or a washer is an error") {
    Machine machine;
    PrismMesh rib;
    rib.box({6.0, 3.0, -3.0}, {30.0, 5.0, 3.0});  // a flat of the nut is 6.5 mm from the axis
    machine.add("rib", rib);
    CHECK(all(check(machine).errors).find(R"("B1_nut" overlaps "rib"; expected parts that do not overlap)") !=
          std::string::npos);
    Machine touching;
    PrismMesh foot;
    foot.box({-2.0, -30.0, -2.0}, {2.0, -22.9, 2.0});  // the head ends at -22.9
    touching.add("foot", foot);
    CHECK(all(check(touching).errors) == "");
    Machine deep;
    PrismMesh post;
    post.box({-2.0, -30.0, -2.0}, {2.0, -22.8, 2.0});
    deep.add("post", post);
    CHECK(all(check(deep).errors) ==
          at_joint(R"("B1_bolt" overlaps "post"; expected parts that do not overlap)"));
}

TEST_CASE("Geometry: a part beside a washer may overlap it by 0.05 mm") {
    for (const double edge : {7.96, 7.9}) {  // the washer has a radius of 8 mm
        Machine machine;
        PrismMesh key;
        key.box({edge, 0.2, -1.0}, {12.0, 1.5, 1.0});
        machine.add("key", key);
        CAPTURE(edge);
        CHECK(all(check(machine).errors) ==
              (edge > 7.95
                   ? ""
                   : at_joint(R"("B1_washer_nut" overlaps "key"; expected parts that do not overlap)")));
    }
}

TEST_CASE("Geometry: a hexagon is measured at any angle and winding, and a square is not a hexagon") {
    PrismMesh nut;
    nut.between(circle(4.0), hexagon(13.0), 0.0, 6.8);
    auto triangles = triangles_of(nut);
    for (const double angle : {0.0, 0.3, 1.0}) {
        for (geometry::Triangle& t : triangles) {
            std::swap(t.b, t.c);
            for (Vec3* p : {&t.a, &t.b, &t.c})
                *p = {p->x * std::cos(angle) - p->z * std::sin(angle), p->y,
                      p->x * std::sin(angle) + p->z * std::cos(angle)};
        }
        const auto measured = geometry::measure_hexagon(triangles);
        REQUIRE(measured);
        CHECK(measured->across_flats == doctest::Approx(13.0 * mm).epsilon(1e-9));
        CHECK(measured->unevenness < 1e-9);
    }
    PrismMesh block;
    block.between(circle(4.0), geometry_test::square(13.0), 0.0, 6.8);
    CHECK_FALSE(geometry::measure_hexagon(triangles_of(block)));
    CHECK_FALSE(geometry::measure_hexagon({}));
    PrismMesh twelve;
    twelve.between(circle(4.0, 12), circle(7.0, 12), 0.0, 6.8);
    CHECK_FALSE(geometry::measure_hexagon(triangles_of(twelve)));
    // Off the axis and with inverted winding: the centre is found.
    auto shifted = triangles_of(nut);
    for (geometry::Triangle& t : shifted) {
        std::swap(t.b, t.c);
        for (Vec3* p : {&t.a, &t.b, &t.c}) *p += Vec3{0.1, 0.0, -0.05} * mm;
    }
    const auto beside = geometry::measure_hexagon(shifted);
    REQUIRE(beside);
    CHECK(beside->centre.x == doctest::Approx(0.1 * mm));
    CHECK(beside->centre.z == doctest::Approx(-0.05 * mm));
}
