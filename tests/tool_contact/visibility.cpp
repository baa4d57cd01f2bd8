// The visibility model and path planning of simulated trainees. Contact queries verify that planned paths are
// free.
#include "game/motion/visibility_model.hpp"

#include "game/motion/path_planning.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/skip.hpp"
#include "tests/tool_contact/support.hpp"

using namespace bolt;
using namespace bolt::motion;

namespace {

constexpr double hover = 0.035;  // m

// Share of the poses along a path at which the wrench is within `near` (m) of an obstacle.
double share_touching(servo::ToolContact& contact, const Pose& from, const Pose& to, const Vec3& bulge,
                      double near) {
    int touching = 0;
    constexpr int steps = 60;
    collision::clear_cache(contact.narrow_phase, contact.world, contact.wrench);
    for (int i = 0; i <= steps; ++i) {
        const Pose pose = arc_pose(from, to, static_cast<double>(i) / steps, bulge);
        std::array<collision::Contact, 1> any;
        if (collision::find_contacts(contact.world, contact.wrench, pose, near, contact.narrow_phase, any)
                .count > 0)
            ++touching;
    }
    return static_cast<double>(touching) / (steps + 1);
}

}  // namespace

TEST_CASE("Visibility: the head moves only as far as needed to see the nut") {
    test::Workbench bench("zq350");
    const servo::ToolContact& contact = *bench.state.tool_contact;
    VisibilityModel visibility;
    int searches = 0, successes = 0;
    for (const std::size_t joint : {0U, 5U, 8U})
        for (std::uint64_t seed = 1; seed <= 8; ++seed) {
            CAPTURE(joint);
            CAPTURE(seed);
            Random random(seed, 1);
            const Pose wrench = bench.wrench(joint, hover);
            const Vec3 seat = bench.setup.nuts[joint].seat;
            const auto visible_share = [&](const Vec3& eye) {
                return target_visibility(visibility, bench.setup, contact, joint, wrench, eye);
            };
            // From below and behind, where the casing occludes the nut.
            const Vec3 from = visibility.eye = seat + Vec3(0.3, 0.2, seat.z > 0.0 ? -0.6 : 0.6);
            const auto move = improve_view(visibility, bench.setup, contact, joint, wrench, 0.65, random);
            CHECK(move.has_value() == (visible_share(from) < 0.65));
            if (!move) continue;
            ++searches;
            successes += visible_share(move->eye) >= 0.65 ? 1 : 0;
            CHECK(visible_share(move->eye) >= visible_share(from));
            CHECK(glm::length(move->eye - seat) == doctest::Approx(glm::length(from - seat)));
            const double direct = std::acos(
                std::min(1.0, glm::dot(glm::normalize(move->eye - seat), glm::normalize(from - seat))));
            CHECK(move->turn >= direct - 1e-9);
            CHECK(move->glances >= 1);
            visibility.eye = move->eye;
            if (visible_share(move->eye) >= 0.65)
                CHECK(!improve_view(visibility, bench.setup, contact, joint, wrench, 0.65, random));
        }
    MESSAGE(successes << " of " << searches << " searches reached the wanted visibility");
    CHECK(searches >= 8);
    CHECK(2 * successes >= searches);
    CHECK(successes <
          searches);  // the search must not use the visibility from places where the head has not been
}

TEST_CASE("Visibility: with less sight placement is worse, and improves with every contact") {
    CHECK(placement_noise(1e-3, 1.0, 0) == doctest::Approx(1e-3).epsilon(0.01));
    CHECK(placement_noise(1e-3, 0.25, 0) == doctest::Approx(2e-3).epsilon(0.05));
    for (double share = 0.0; share < 1.0; share += 0.1)
        CHECK(placement_noise(1e-3, share, 0) > placement_noise(1e-3, share + 0.1, 0));
    for (int tries = 0; tries < 6; ++tries)
        CHECK(placement_noise(1e-3, 0.0, tries) > placement_noise(1e-3, 0.0, tries + 1));
    CHECK(placement_noise(1e-3, 0.0, 100) == doctest::Approx(1e-3));
}

namespace {

struct PathCounts {
    int paths = 0, touching = 0, straight = 0;  // touching: as planned; straight: would touch without a plan
};

// Plans a path from each nut to the nut `step` further in the list.
PathCounts count_paths(test::Workbench& bench, std::size_t step) {
    servo::ToolContact& contact = *bench.state.tool_contact;
    const auto grip_at = [&](std::size_t joint) {
        const HandleAngle handle =
            choose_handle_angle(bench.setup, &contact, joint, {}, 0.0, 1.0, to_radians(40.0));
        const servo::NutGeometry& nut = bench.setup.nuts[joint];
        const Vec3 x = std::cos(-handle.angle) * nut.e1 + std::sin(-handle.angle) * nut.e2;
        const Vec3 z = handle.flipped ? -nut.axis : nut.axis;
        return Pose{servo::nut_centre(nut, 0.0) + hover * nut.axis,
                    glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z)))};
    };
    PathCounts counts;
    const std::size_t joints = bench.setup.nuts.size();
    for (std::size_t i = 0; i < joints; ++i) {
        const std::size_t j = (i + step) % joints;
        Pose from = grip_at(i);
        const Pose to = grip_at(j);
        counts.straight += share_touching(contact, from, to, Vec3(0.0), 0.5e-3) > 0.0 ? 1 : 0;
        const ReachPath path = plan_reach(bench.setup, contact, from, to, bench.setup.nuts[j].axis, 0.05);
        double touched = 0.0;
        for (const Pose& waypoint : path.waypoints) {
            touched += share_touching(contact, from, waypoint, Vec3(0.0), 0.5e-3);
            from = waypoint;
        }
        touched += share_touching(contact, from, to, path.bulge, 0.5e-3);
        ++counts.paths;
        counts.touching += touched > 0.0 ? 1 : 0;
    }
    MESSAGE("of " << counts.paths << " paths " << counts.straight << " touch an obstacle if straight, "
                  << counts.touching << " as planned");
    return counts;
}

}  // namespace

TEST_CASE("Path planning: paths from nut to nut meet no obstacle in either direction") {
    if (test::sanitized) return test::skip_rest("twelve paths take minutes under a sanitizer");
    test::Workbench bench("zq350");
    const PathCounts counts = count_paths(bench, 5);
    CHECK(counts.straight >= 6);
    CHECK(counts.touching <= 1);
}

TEST_CASE("Path planning: a pull has room for the whole tool, wherever the hand grips it") {
    test::Workbench bench("zq350");
    servo::ToolContact& contact = *bench.state.tool_contact;
    const double stroke = to_radians(50.0);
    const auto chosen = [&](std::size_t joint, double preferred) {
        return choose_handle_angle(bench.setup, &contact, joint, {}, preferred, -1.0, stroke);
    };
    const double grip = bench.setup.wrench.handle_length;
    for (std::size_t joint = 0; joint < bench.setup.nuts.size(); ++joint)
        for (const double preferred : {0.0, 0.5 * pi, pi, 1.5 * pi}) {
            CAPTURE(joint);
            CAPTURE(preferred);
            const HandleAngle at_the_end = chosen(joint, preferred);
            bench.setup.wrench.handle_length = 0.5 * grip;
            const HandleAngle in_the_middle = chosen(joint, preferred);
            bench.setup.wrench.handle_length = grip;
            CHECK(in_the_middle.angle == at_the_end.angle);
            CHECK(in_the_middle.free_swing == at_the_end.free_swing);
            CHECK(at_the_end.free_swing > to_radians(15.0));  // each nut has such an angle
        }
}

TEST_CASE("Path planning: a key is carried around the casing, from its front to its back") {
    if (test::sanitized) return test::skip_rest("28 paths take minutes under a sanitizer");
    auto loaded = content::load_assembly(content::assembly_folder("zq350"), "bearing_covers");
    REQUIRE(loaded.ok());
    test::Workbench bench(std::move(loaded.assembly));
    // Half of the screws are in front and half behind, so each path leads through the casing if straight.
    const PathCounts counts = count_paths(bench, bench.setup.nuts.size() / 2);
    CHECK(counts.straight == counts.paths);
    CHECK(counts.touching <= 1);
}
