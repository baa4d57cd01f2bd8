#include "haptics/hand/finger_closure.hpp"

#include <doctest/doctest.h>

#include <glm/geometric.hpp>

#include "tests/collision/support.hpp"

namespace hand_fingertip_contact_test {

using namespace bolt;
using namespace bolt::collision;
using namespace bolt::hand;
using namespace contact_test;

namespace {

constexpr double away = 200.0;

// A flat bar like a wrench's handle: 150 mm long, 20 mm high, 8 mm thick.
ToolShape bar() {
    const std::vector<ContactMesh> parts{
        box(Vec3(0.0, -10.0, -4.0) * mm, Vec3(150.0, 10.0, 4.0) * mm).mesh()};
    return make_tool(parts).value();
}

Fingertips tips(const Vec3& thumb, const Vec3& index) {
    Fingertips t;
    t.at.fill(Vec3(away, 0.0, 0.0) * mm * 3.0);
    t.at[0] = thumb * mm;
    t.at[1] = index * mm;
    return t;
}

}  // namespace

TEST_CASE("FingertipGrasp: pads on both faces hold a handle") {
    const ToolShape tool = bar();
    const FingertipGrasp g = fingertip_grasp(tool, tips({80.0, 0.0, 12.5}, {80.0, 2.0, -13.0}));
    CHECK(g.held);
    CHECK(g.tips[0].distance == doctest::Approx(0.5 * mm).epsilon(1e-5));
    CHECK(g.tips[1].distance == doctest::Approx(1.0 * mm).epsilon(1e-5));
    CHECK(glm::length(g.tips[0].point - Vec3(80.0, 0.0, 4.0) * mm) < 1e-6);
    CHECK(g.tips[0].normal.z == doctest::Approx(1.0));
    CHECK(g.tips[1].normal.z == doctest::Approx(-1.0));
    CHECK(g.tips[2].distance == infinite_distance);
}

TEST_CASE("FingertipGrasp: pads that do not press from opposite sides do not hold") {
    const ToolShape tool = bar();
    CHECK_FALSE(fingertip_grasp(tool, tips({80.0, 0.0, 12.0}, {90.0, 0.0, 12.0})).held);  // the same face
    CHECK_FALSE(
        fingertip_grasp(tool, tips({80.0, 0.0, 12.0}, {80.0, 18.0, 0.0})).held);  // a face and an edge
    CHECK_FALSE(fingertip_grasp(tool, tips({80.0, 0.0, 12.0}, {80.0, 0.0, -15.0}))
                    .held);  // one tip does not touch yet
    CHECK_FALSE(
        fingertip_grasp(tool, tips({80.0, 0.0, 12.0}, {100.0, 0.0, -12.0})).held);  // the bar would turn away
    CHECK_FALSE(fingertip_grasp(tool, tips({80.0, 0.0, 300.0}, {80.0, 0.0, -300.0})).held);
    CHECK(fingertip_grasp(tool, tips({80.0, 18.0, 0.0}, {80.0, -18.0, 0.0})).held);  // on its edges
}

TEST_CASE("FingertipGrasp: the thumb must oppose") {
    const ToolShape tool = bar();
    Fingertips t = tips({80.0, 0.0, 200.0}, {80.0, 0.0, 12.0});
    t.at[3] = Vec3(80.0, 0.0, -12.0) * mm;
    CHECK_FALSE(fingertip_grasp(tool, t).held);
    t.at[0] = Vec3(82.0, 0.0, 12.0) * mm;
    CHECK(fingertip_grasp(tool, t).held);  // thumb and ring finger
}

TEST_CASE("FingertipGrasp: a pad inside the handle reports its depth") {
    const FingertipGrasp g = fingertip_grasp(bar(), tips({80.0, 0.0, 11.0}, {80.0, 0.0, -2.0}));
    CHECK(g.tips[0].distance == doctest::Approx(-1.0 * mm).epsilon(1e-5));
    CHECK(g.tips[1].distance == doctest::Approx(-10.0 * mm).epsilon(1e-5));  // the centre is inside
    CHECK(g.tips[1].normal.z == doctest::Approx(-1.0));
    CHECK(g.held);
}

}  // namespace hand_fingertip_contact_test
