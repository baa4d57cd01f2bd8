// The left-handed layout mirrors the right-handed one: hand, resting place of the wrench, shoulder.
#include <doctest/doctest.h>

#include "game/scene/postures.hpp"
#include "game/scene/workplace.hpp"
#include "game/trainer/helped_hand.hpp"
#include "tests/collision/support.hpp"

using namespace bolt;
using namespace bolt::scene;

namespace {

// Greatest deviation of the left hand from the right hand mirrored in the tool's plane y = 0. Positions count
// in m, rotations as the distance between axes.
double off_mirror(const hand::Skeleton& left, const hand::Skeleton& right) {
    const glm::dmat3 across(1, 0, 0, 0, -1, 0, 0, 0, 1), own(-1, 0, 0, 0, 1, 0, 0, 0, 1);
    double most = 0.0;
    for (std::size_t i = 0; i < hand::joint_count; ++i) {
        most = std::max(most, glm::distance(left.position[i], across * right.position[i]));
        const glm::dmat3 image = across * glm::mat3_cast(right.rotation[i]) * own;
        const glm::dmat3 is = glm::mat3_cast(left.rotation[i]);
        for (int axis = 0; axis < 3; ++axis) most = std::max(most, glm::distance(is[axis], image[axis]));
    }
    return most;
}

double off_mirror(const Postures& left, const Postures& right) {
    double most = std::max(off_mirror(left.on_nut, right.on_nut), off_mirror(left.open, right.open));
    for (std::size_t i = 0; i < left.on_handle.size(); ++i)
        most = std::max(most, off_mirror(left.on_handle[i], right.on_handle[i]));
    return most;
}

const render::BoundingBox machine{{-0.4F, -0.1F, -0.2F}, {0.3F, 0.35F, 0.25F}};
const double middle = 0.5 * (static_cast<double>(machine.low.x) + static_cast<double>(machine.high.x));
Vec3 in_mirror(const Vec3& p) { return {2.0 * middle - p.x, p.y, p.z}; }

}  // namespace

TEST_CASE("Left hand: its postures mirror the right hand's, around a handle too") {
    const Postures right = make_postures(nullptr, 0.15, hand::Side::right);
    const Postures left = make_postures(nullptr, 0.15, hand::Side::left);
    CHECK(off_mirror(left, right) < 1e-12);
    CHECK(off_mirror(right, right) > 0.05);  // the check can fail

    const collision::ContactMesh parts[] = {
        contact_test::box(Vec3(-20.0, -12.0, -3.5) * mm, Vec3(240.0, 12.0, 3.5) * mm).mesh()};
    const auto bar = collision::make_tool(parts);
    REQUIRE(bar);
    const Postures right_closed = make_postures(&*bar, 0.15, hand::Side::right);
    // A digit stops within stop_tolerance of the bar. Over half a bone (20 mm) this changes its bend by at
    // most stop_tolerance / 20 mm.
    CHECK(off_mirror(make_postures(&*bar, 0.15, hand::Side::left), right_closed) <
          4.0 * hand::stop_tolerance / 0.02);
    CHECK(off_mirror(right_closed, make_postures(nullptr, 0.15)) > 0.05);  // the hand did close on the bar
}

TEST_CASE("Left hand: the natural posture at the handle mirrors the right hand's") {
    const Postures right = make_postures(nullptr, 0.15, hand::Side::right);
    const Postures left = make_postures(nullptr, 0.15, hand::Side::left);
    const Vec3 shoulder(0.35, 0.4, 0.5), in_tools_mirror(0.35, -0.4, 0.5);
    // In the tool's own frame the mirror plane is that of the postures.
    for (const Vec3& up : {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(0.3, 0, 0.95)})
        CHECK(natural_handle_posture(left, Pose{}, up, in_tools_mirror) ==
              natural_handle_posture(right, Pose{}, up, shoulder));
}

TEST_CASE("Left hand: wrench, waiting hand and shoulder are on the other side of the machine") {
    using hand::Side;
    const Pose right = wrench_rest_pose(machine, 0.01), left = wrench_rest_pose(machine, 0.01, Side::left);
    for (const double along : {0.0, 0.1, 0.25})
        CHECK(glm::distance(left * Vec3(along, 0, 0), in_mirror(right * Vec3(along, 0, 0))) < 1e-12);
    CHECK(glm::distance(left.orientation * Vec3(0, 0, 1), Vec3(0, 1, 0)) < 1e-12);  // the normal points up
    const trainer::HelpedHand r = trainer::make_hand(right), l = trainer::make_hand(left, Side::left);
    CHECK(glm::distance(l.pose.position, in_mirror(r.pose.position)) < 1e-12);
    const Vec3 shoulder = shoulder_position(machine, {Side::left, std::nullopt});
    CHECK(glm::distance(shoulder, in_mirror(shoulder_position(machine))) < 1e-6);
    CHECK(shoulder.x < machine.low.x);
}

TEST_CASE("Seated trainee: the shoulder follows the eye height and is never higher than when standing") {
    const double standing = shoulder_position(machine).y;
    double before = -10.0;
    for (double eyes = 0.9; eyes <= 1.5; eyes += 0.1) {
        const double y = shoulder_position(machine, {hand::Side::right, eyes}).y;
        CHECK(y <= standing);
        CHECK(y >= before);
        before = y;
    }
    // Eyes at 1.2 m, bench at 0.85 m, shoulders 0.2 m below the eyes, foot of the machine at -0.1 m.
    CHECK(shoulder_position(machine, {hand::Side::right, 1.2}).y == doctest::Approx(1.2 - 0.85 - 0.2 - 0.1));
}
