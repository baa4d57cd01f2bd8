// What a simulated trainee notices of the nut in its hand, held against what it was given to feel.
#include "game/trainees/human_model.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "content/format/assembly.hpp"
#include "game/lesson/lesson.hpp"
#include "game/session/lesson_session.hpp"
#include "game/trainees/trainee.hpp"

using namespace bolt;
using namespace bolt::trainees;

namespace {

constexpr double dt = 1e-3, reaction = 0.2, stiffness = 2000.0;  // N·m/rad

// A hand that turns at a steady rate: the nut sticks, then its torque grows by `slope`, then by `after`.
struct Bolt {
    double breakaway = 30.0, slope = 120.0, gives_at = 60.0, after = 20.0;  // N·m, N·m/rad

    [[nodiscard]] double torque(double turned) const {
        const double stuck = breakaway / stiffness;
        if (turned < stuck) return stiffness * turned;
        const auto both = [](double k) { return k * stiffness / (k + stiffness); };
        const double whole = breakaway + both(slope) * (turned - stuck);
        if (whole < gives_at) return whole;
        const double at = stuck + (gives_at - breakaway) / both(slope);
        return gives_at + both(after) * (turned - at);
    }
};

// N·m that the bolt had when the hand first said that it gives; 0: it did not within half a turn.
double noticed_at(const Bolt& bolt) {
    Nerves nerves(reaction, dt, stiffness);
    for (int i = 0; i < 9000; ++i) {
        const double turned = to_radians(20.0) * i * dt;
        if (nerves.feel(bolt.torque(turned), turned, 0.0, true).yields) return bolt.torque(turned);
    }
    return 0.0;
}

}  // namespace

TEST_CASE("Perception: what is felt was so a reaction time ago") {
    Nerves nerves(reaction, dt, stiffness);
    for (int i = 0; i < 1000; ++i) {
        const Feeling& felt = nerves.feel(2.0 * i * dt, 0.0, 0.1 * i, true);
        const double then = std::max(0.0, (i - 1) * dt - reaction);
        CHECK(felt.torque == doctest::Approx(2.0 * then));
        CHECK(felt.nut_speed == doctest::Approx(100.0 * then));
    }
}

TEST_CASE(
    "Perception: a bolt that gives is felt soon, one that grows on never, and a nut that sticks tells "
    "nothing") {
    const Bolt bolt;
    const double noticed = noticed_at(bolt);
    CHECK(noticed > bolt.gives_at);
    // A reaction time and twice what it takes to tell a slope, at 20 degrees a second.
    CHECK(noticed < bolt.gives_at + bolt.after * to_radians(20.0 * reaction + 3.5));
    CHECK(noticed_at({.after = bolt.slope}) == 0.0);
    CHECK(noticed_at({.breakaway = 59.0, .after = bolt.slope}) == 0.0);
}

TEST_CASE("Perception: the torque of a nut is felt as it is, on a device with torque and on one without") {
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

TEST_CASE("Perception: skill decides how well a torque is met: nobody overtightens by reacting late alone") {
    const content::Loaded loaded = content::load_assembly("cover-m8");
    REQUIRE(loaded.ok());
    const auto torques = [&](const char* trainee) {
        std::vector<double> shares;
        for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
            const servo::Setup setup =
                session::make_setup(loaded.assembly, joint::Law::mechanistic, {}, seed, dt);
            servo::State state = servo::initial_state(setup);
            lesson::Lesson lesson =
                lesson::begin(loaded.assembly, lesson::Mode::guided, lesson::Task::tighten);
            Operator hand(find_profile(trainee).value(), seed, setup);
            while (lesson.due() != nullptr && state.tick < 600'000) {
                lesson::observe(lesson, state, servo::tick(setup, state, hand.act(setup, state, lesson)));
                lesson.events.clear();
            }
            CHECK(lesson.due() == nullptr);
            for (std::size_t i = 0; i < lesson.joints.size(); ++i)
                shares.push_back(lesson::judge_joint(lesson, i, state).torque /
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
