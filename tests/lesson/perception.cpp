// The perception of a simulated trainee, against the torques that it is given.
#include "game/lesson/judge.hpp"
#include "game/trainees/human_model.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "content/format/assembly.hpp"
#include "game/lesson/lesson.hpp"
#include "game/session/lesson_session.hpp"
#include "game/trainees/trainee.hpp"
#include "tests/support/haptic_world.hpp"

namespace lesson_perception_test {

using namespace bolt;
using namespace bolt::trainees;

namespace {

constexpr double dt = 1e-3, reaction = 0.2, stiffness = 2000.0;  // N·m/rad

// A nut turned at a steady rate: it sticks, then its torque rises by `slope`, then by `after`.
struct Bolt {
    double breakaway = 30.0, slope = 120.0, yields_at = 60.0, after = 20.0;  // N·m, N·m/rad

    [[nodiscard]] double torque(double turned) const {
        const double stuck = breakaway / stiffness;
        if (turned < stuck) return stiffness * turned;
        const auto both = [](double k) { return k * stiffness / (k + stiffness); };
        const double whole = breakaway + both(slope) * (turned - stuck);
        if (whole < yields_at) return whole;
        const double at = stuck + (yields_at - breakaway) / both(slope);
        return yields_at + both(after) * (turned - at);
    }
};

// Torque of the bolt, N·m, at which the hand detects yield; 0: not within half a turn.
double detected_at(const Bolt& bolt) {
    DelayedPerception perception(reaction, dt, stiffness);
    for (int i = 0; i < 9000; ++i) {
        const double turned = to_radians(20.0) * i * dt;
        if (perception.update(bolt.torque(turned), turned, 0.0, true).yields) return bolt.torque(turned);
    }
    return 0.0;
}

}  // namespace

TEST_CASE("Perception: returns the values of one reaction time ago") {
    DelayedPerception perception(reaction, dt, stiffness);
    for (int i = 0; i < 1000; ++i) {
        const Percept& felt = perception.update(2.0 * i * dt, 0.0, 0.1 * i, true);
        const double then = std::max(0.0, (i - 1) * dt - reaction);
        CHECK(felt.torque == doctest::Approx(2.0 * then));
        CHECK(felt.nut_speed == doctest::Approx(100.0 * then));
    }
}

TEST_CASE("Perception: yield is detected soon, steady growth and a sticking nut never") {
    const Bolt bolt;
    const double detected = detected_at(bolt);
    CHECK(detected > bolt.yields_at);
    // One reaction time and twice the time to detect a slope, at 20° per second.
    CHECK(detected < bolt.yields_at + bolt.after * to_radians(20.0 * reaction + 3.5));
    CHECK(detected_at({.after = bolt.slope}) == 0.0);
    CHECK(detected_at({.breakaway = 59.0, .after = bolt.slope}) == 0.0);
}

TEST_CASE("Perception: the torque of a nut is exact, on a device with torque and on one without") {
    servo::NutGeometry nut;
    const Vec3 handle(0.6, 0.0, 0.8);
    force::OutputLimits with, without;
    without.torque = 0.0;
    for (const force::OutputLimits& limits : {with, without}) {
        const force::TorqueRendering rendering = force::make_torque_rendering(limits, 100.0, 0.23);
        const force::OutputCommand output = force::render_torque(rendering, 42.0, nut.axis, handle);
        CHECK(felt_torque(rendering, nut, handle, output) == doctest::Approx(42.0));
    }
    CHECK(felt_torque({.scale = 0.0, .as_force = 0.0}, nut, handle, {}) == 0.0);
}

TEST_CASE("Perception: accuracy depends on skill; the reaction time alone does not cause overtightening") {
    const content::LoadedAssembly loaded = content::load_assembly("cover-m8");
    REQUIRE(loaded.ok());
    const auto torques = [&](const char* trainee) {
        std::vector<double> shares;
        for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
            const servo::Setup setup =
                session::make_setup(loaded.assembly, joint::Law::mechanistic, {}, seed, dt);
            servo::State state = servo::initial_state(setup);
            world::World world = test::make_world(state);
            lesson::Lesson lesson =
                lesson::begin(loaded.assembly, lesson::Mode::guided, lesson::Task::tighten);
            SimulatedTrainee hand(find_profile(trainee).value(), seed, setup);
            while (lesson.due() != nullptr && state.tick < 600'000) {
                const servo::Output output = servo::tick(setup, state, hand.act(setup, state, lesson));
                test::observe_tick(lesson, world, state, output);
                lesson.events.clear();
            }
            CHECK(lesson.due() == nullptr);
            for (std::size_t i = 0; i < lesson.joints.size(); ++i)
                shares.push_back(lesson::judge_joint(lesson, i, world).torque /
                                 loaded.assembly.joints[i].spec.torque.target);
        }
        std::sort(shares.begin(), shares.end());
        return shares;
    };
    const std::vector<double> expert = torques("expert"), novice = torques("novice"),
                              clumsy = torques("clumsy");
    const auto high = [](const std::vector<double>& shares) {
        return std::count_if(shares.begin(), shares.end(), [](double s) { return s > 1.1; });
    };
    const auto median = [](const std::vector<double>& shares) { return shares[shares.size() / 2]; };
    MESSAGE("of " << expert.size() << " joints too tight: " << high(expert) << ", " << high(novice) << ", "
                  << high(clumsy) << "; medians of the target " << median(expert) << ", " << median(novice)
                  << ", " << median(clumsy));
    CHECK(high(expert) == 0);
    CHECK(high(novice) < high(clumsy));
    CHECK(high(clumsy) < 15);
    for (const auto* all : {&expert, &novice, &clumsy}) CHECK(std::abs(median(*all) - 1.0) < 0.1);
}

}  // namespace lesson_perception_test
