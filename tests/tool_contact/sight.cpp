// What simulated trainees see: where they put their heads for it, and that the ways which they take among
// obstacles are free, asked of contact itself.
#include "game/motion/visibility_model.hpp"

#include "game/motion/path_planning.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/skip.hpp"
#include "tests/tool_contact/support.hpp"

using namespace bolt;
using namespace bolt::motion;
using namespace bolt::trainees;

namespace {

constexpr double hover = 0.035;  // m

// Of poses along a way, the share at which the wrench is within `near` of something.
double share_touching(servo::ToolContact& touch, const Pose& from, const Pose& to, const Vec3& bulge,
                      double near) {
    int touching = 0;
    constexpr int steps = 60;
    for (int i = 0; i <= steps; ++i) {
        const Pose pose = along(from, to, static_cast<double>(i) / steps, bulge);
        collision::clear_cache(touch.narrow_phase, touch.world, touch.wrench);
        std::array<collision::Contact, 1> any;
        if (collision::find_contacts(touch.world, touch.wrench, pose, near, touch.narrow_phase, any).count >
            0)
            ++touching;
    }
    return static_cast<double>(touching) / (steps + 1);
}

}  // namespace

TEST_CASE("Visibility: the head moves only as far as needed to see the nut") {
    test::Workbench bench("zq350");
    const servo::ToolContact& touch = *bench.state.tool_contact;
    Sight sight;
    int looked = 0, content = 0;
    for (const std::size_t joint : {0U, 5U, 8U})
        for (std::uint64_t seed = 1; seed <= 8; ++seed) {
            CAPTURE(joint);
            CAPTURE(seed);
            Random random(seed, 1);
            const Pose wrench = bench.wrench(joint, hover);
            const Vec3 seat = bench.setup.nuts[joint].seat;
            const auto seen = [&](const Vec3& eye) {
                return place_seen(sight, bench.setup, touch, joint, wrench, eye);
            };
            // From below and behind, the casing is in the way.
            const Vec3 from = sight.eye = seat + Vec3(0.3, 0.2, seat.z > 0.0 ? -0.6 : 0.6);
            const auto move = look_round(sight, bench.setup, touch, joint, wrench, 0.65, random);
            CHECK(move.has_value() == (seen(from) < 0.65));
            if (!move) continue;
            ++looked;
            content += seen(move->eye) >= 0.65 ? 1 : 0;
            CHECK(seen(move->eye) >= seen(from));
            CHECK(glm::length(move->eye - seat) == doctest::Approx(glm::length(from - seat)));
            const double direct = std::acos(
                std::min(1.0, glm::dot(glm::normalize(move->eye - seat), glm::normalize(from - seat))));
            CHECK(move->turn >= direct - 1e-9);
            CHECK(move->glances >= 1);
            sight.eye = move->eye;
            if (seen(move->eye) >= 0.65)
                CHECK(!look_round(sight, bench.setup, touch, joint, wrench, 0.65, random));
        }
    MESSAGE(content << " of " << looked << " found what they looked for");
    CHECK(looked >= 8);
    CHECK(2 * content >= looked);
    CHECK(content < looked);  // whoever always finds it knows what is seen from where they are not
}

TEST_CASE("Visibility: with less sight placement is worse, and improves with every contact") {
    CHECK(placing_noise(1e-3, 1.0, 0) == doctest::Approx(1e-3).epsilon(0.01));
    CHECK(placing_noise(1e-3, 0.25, 0) == doctest::Approx(2e-3).epsilon(0.05));
    for (double share = 0.0; share < 1.0; share += 0.1)
        CHECK(placing_noise(1e-3, share, 0) > placing_noise(1e-3, share + 0.1, 0));
    for (int tries = 0; tries < 6; ++tries)
        CHECK(placing_noise(1e-3, 0.0, tries) > placing_noise(1e-3, 0.0, tries + 1));
    CHECK(placing_noise(1e-3, 0.0, 100) == doctest::Approx(1e-3));
}

TEST_CASE("Path planning: paths from nut to nut meet no obstacle in either direction") {
    if (test::sanitized) return test::skip_rest("twelve paths take minutes under a sanitizer");
    test::Workbench bench("zq350");
    servo::ToolContact& touch = *bench.state.tool_contact;
    const std::size_t joints = bench.setup.nuts.size();
    int ways = 0, touching = 0, straight = 0;
    for (std::size_t i = 0; i < joints; ++i) {
        const std::size_t j = (i + 5) % joints;
        const auto grip_at = [&](std::size_t joint) {
            const GripAngle grip = choose_grip(bench.setup, &touch, joint, 0.0, 0.0, 1.0, to_radians(40.0));
            const servo::NutGeometry& nut = bench.setup.nuts[joint];
            const Vec3 x = std::cos(-grip.handle) * nut.e1 + std::sin(-grip.handle) * nut.e2;
            const Vec3 z = grip.flipped ? -nut.axis : nut.axis;
            return Pose{servo::nut_centre(nut, 0.0) + hover * nut.axis,
                        glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z)))};
        };
        Pose from = grip_at(i);
        const Pose to = grip_at(j);
        straight += share_touching(touch, from, to, Vec3(0.0), 0.5e-3) > 0.0 ? 1 : 0;
        const Way way = way_round(bench.setup, touch, from, to, bench.setup.nuts[j].axis, 0.05);
        double met = 0.0;
        for (const Pose& station : way.stations) {
            met += share_touching(touch, from, station, Vec3(0.0), 0.5e-3);
            from = station;
        }
        met += share_touching(touch, from, to, way.bulge, 0.5e-3);
        ++ways;
        touching += met > 0.0 ? 1 : 0;
    }
    MESSAGE("of " << ways << " ways " << straight << " meet something gone straight, " << touching
                  << " as they are gone");
    CHECK(straight >= 6);
    CHECK(touching <= 1);
}
