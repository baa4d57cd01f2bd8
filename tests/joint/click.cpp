// A click-type torque wrench: trip torque, fall of the torque, re-arming, and energy dissipation for any
// motion of the hand.
#include "haptics/joint/nut.hpp"

#include <doctest/doctest.h>

#include "tests/joint/support.hpp"

using namespace bolt;
using namespace bolt::joint;

namespace {

constexpr double stiffness = 2000.0, set_torque = 40.0, swing = to_radians(4.0), play = 0.01;
constexpr double fixed = 1e9;  // N·m, resistance of a nut that must not turn

Resistance constant(double torque) {
    Resistance r;
    r.tighten = torque;
    r.loosen = -torque;
    return r;
}

// A wrench on a nut with a constant resistance.
struct Bench {
    double dt = 1e-3;
    Resistance held_by = constant(fixed);
    NutDrive drive;
    NutMotion nut;
    NutStep last;
    double hand = 0.0, work = 0.0;  // rad; J of work by the hand
    int clicks = 0;

    explicit Bench(double tick = 1e-3) : dt(tick) {
        drive.engaged = true;
        drive.stiffness = stiffness;
        drive.half_play = play;
        drive.click.set_torque = set_torque;
        drive.click.swing = swing;
    }
    // Runs one tick with the hand at `angle` (rad); returns the torque, N·m.
    double to(double angle) {
        drive.angle = angle;
        last = step_nut(held_by, drive_inertia(stiffness, dt), nut, drive, dt);
        nut = last.nut;
        drive.swung = last.click.swung;
        clicks += last.click.clicked ? 1 : 0;
        work += last.torque * (angle - hand);
        hand = angle;
        return last.torque;
    }
    double by_torque(double torque) { return to(play + torque / stiffness); }
    void slowly_to(double angle, double speed = 0.2) {
        const double from = hand;
        const int n = static_cast<int>(std::abs(angle - from) / (speed * dt)) + 1;
        for (int i = 1; i <= n; ++i) to(from + (angle - from) * i / n);
    }
    // Energy in J stored in the wrench's spring and in the return spring of the mechanism.
    [[nodiscard]] double stored() const {
        const Click& c = drive.click;
        const double wound = last.torque / stiffness;
        return 0.5 * stiffness * wound * wound + c.rearm_torque_share * c.set_torque * drive.swung;
    }
};

}  // namespace

TEST_CASE("Torque wrench: below its set torque and when loosening it equals the plain wrench bit for bit") {
    Bench click, plain;
    plain.drive.click = {};
    Random random(5);
    for (int i = 0; i < 20'000; ++i) {
        const double torque = random.uniform(-3.0 * set_torque, 0.999 * set_torque);
        REQUIRE(click.by_torque(torque) == plain.by_torque(torque));
    }
    CHECK(click.clicks == 0);
    CHECK(click.drive.swung == 0.0);
    CHECK(click.by_torque(set_torque * 1.001) < set_torque);
    CHECK(click.clicks == 1);
}

TEST_CASE("Torque wrench: it trips at play + set torque / stiffness, within the hand's motion of one tick") {
    for (const double dt : {1e-3, 2.5e-4}) {
        Bench bench(dt);
        const double speed = 0.2;
        double greatest = 0.0;
        while (bench.clicks == 0) greatest = std::max(greatest, bench.to(bench.hand + speed * dt));
        CHECK(bench.hand >= play + set_torque / stiffness);
        CHECK(bench.hand <= play + set_torque / stiffness + 1.001 * speed * dt);
        CHECK(greatest <= set_torque);
        CHECK(greatest >= set_torque - stiffness * speed * dt);
    }
}

TEST_CASE(
    "Torque wrench: in a still hand the torque falls continuously, with the time constant of the mechanism") {
    for (const double dt : {1e-3, 2.5e-4}) {
        Bench bench(dt);
        while (bench.clicks == 0) bench.to(bench.hand + 0.05 * dt);
        const Click& c = bench.drive.click;
        const double low = c.swing_torque_share * set_torque, share = dt / c.settling_time;
        double expected = bench.last.torque;
        const double begin = expected;
        for (int i = 0; i < static_cast<int>(0.2 / dt); ++i) {
            const double before = bench.last.torque, torque = bench.to(bench.hand);
            expected =
                (expected + share * low) / (1.0 + share);  // backward Euler of T' = −(T − low)/settling_time
            REQUIRE(torque == doctest::Approx(expected).epsilon(1e-9));
            REQUIRE(before - torque <= share * (set_torque - low) * 1.001);
        }
        CHECK(begin > 0.9 * set_torque);
        CHECK(bench.last.torque == doctest::Approx(low).epsilon(1e-6));
        CHECK(bench.drive.swung == doctest::Approx((set_torque - low) / stiffness).epsilon(0.01));
        CHECK(bench.clicks == 1);
    }
}

TEST_CASE("Torque wrench: a further pull reaches the end of the swing and exceeds the setting") {
    Bench bench;
    const double low = bench.drive.click.swing_torque_share * set_torque;
    const double speed = 0.02, extra = stiffness * bench.drive.click.settling_time * speed;
    bench.slowly_to(play + low / stiffness + 0.9 * swing, speed);
    CHECK(bench.last.torque == doctest::Approx(low + extra).epsilon(0.01));  // torque while it swings
    CHECK(bench.drive.swung < swing);
    bench.slowly_to(play + swing + 1.5 * set_torque / stiffness, speed);
    CHECK(bench.drive.swung == swing);
    CHECK(bench.last.torque == doctest::Approx(1.5 * set_torque));
    CHECK(bench.clicks == 1);
}

TEST_CASE(
    "Torque wrench: after release it swings back only below the re-arming torque, then holds up to its "
    "setting again") {
    Bench bench;
    const Click& c = bench.drive.click;
    bench.slowly_to(play + 0.5 * swing + c.swing_torque_share * set_torque / stiffness);
    for (int i = 0; i < 500; ++i) bench.to(bench.hand);
    const double swung = bench.drive.swung;
    REQUIRE(swung > 0.3 * swing);
    bench.slowly_to(play + swung + 1.05 * c.rearm_torque_share * set_torque / stiffness);
    CHECK(bench.drive.swung == swung);  // it does not move between the two torques
    bench.slowly_to(play);
    for (int i = 0; i < 2000; ++i) bench.to(bench.hand);
    CHECK(bench.drive.swung == 0.0);
    CHECK(bench.last.torque == doctest::Approx(0.0));
    CHECK(bench.clicks == 1);
    bench.slowly_to(play + 0.98 * set_torque / stiffness);
    CHECK(bench.last.torque == doctest::Approx(0.98 * set_torque));
    bench.slowly_to(play + 1.02 * set_torque / stiffness);
    CHECK(bench.clicks == 2);
}

TEST_CASE(
    "Torque wrench: a nut that turns below the set torque never trips it; a tighter nut stops at the click") {
    Bench loose;
    loose.held_by = constant(0.9 * set_torque);
    loose.slowly_to(2.0);
    CHECK(loose.clicks == 0);
    CHECK(loose.nut.angle > 1.9);

    Bench tight;
    tight.held_by = constant(0.8 * set_torque);
    tight.held_by.tighten_slope = 300.0;  // reaches the set torque after 1.5°
    while (tight.clicks == 0) {
        tight.held_by.tighten = 0.8 * set_torque + 300.0 * tight.nut.angle;
        tight.to(tight.hand + 1e-4);
    }
    const double stopped = tight.nut.angle;
    CHECK(stopped == doctest::Approx(0.2 * set_torque / 300.0).epsilon(0.05));
    for (int i = 0; i < 100; ++i) tight.to(tight.hand);
    CHECK(tight.nut.angle == doctest::Approx(stopped).epsilon(1e-3));
}

TEST_CASE("Torque wrench: it never generates energy with random hands and nuts at 1 and 4 kHz") {
    Random random(17);
    for (int trial = 0; trial < 400; ++trial) {
        CAPTURE(trial);
        Bench bench(trial % 2 == 0 ? 1e-3 : 2.5e-4);
        Click& c = bench.drive.click;
        c.set_torque = random.uniform(2.0, 80.0);
        c.swing_torque_share = random.uniform(0.3, 0.9);
        c.rearm_torque_share = random.uniform(0.05, 0.95) * c.swing_torque_share;
        c.settling_time = random.uniform(2e-3, 40e-3);
        c.swing = to_radians(random.uniform(0.5, 10.0));
        bench.drive.half_play = random.uniform(0.0, 0.03);
        bench.held_by = constant(random.chance(0.5) ? fixed : random.uniform(0.3, 2.0) * c.set_torque);
        for (int leg = 0; leg < 12; ++leg) {
            const double stored = bench.stored(), work = bench.work;
            bench.slowly_to(bench.nut.angle + random.uniform(-0.1, 0.2), random.uniform(0.02, 4.0));
            for (int i = 0; i < 200; ++i) bench.to(bench.hand);  // until all motion has stopped
            const double lost = bench.work - work - (bench.stored() - stored);
            REQUIRE(lost >= -1e-9);
            REQUIRE(bench.drive.swung >= 0.0);
            REQUIRE(bench.drive.swung <= c.swing);
            REQUIRE(std::isfinite(bench.last.torque));
        }
    }
}

TEST_CASE("Torque wrench: under every law tightening stops at the click and is reproducible bit for bit") {
    const auto run = [](const GroupParameters& group, double dt, double trips) {
        std::vector<JointState> joints = initial_state(group, 1);
        NutDrive drive;
        drive.engaged = true;
        drive.stiffness = stiffness;
        drive.half_play = play;
        drive.click.set_torque = trips;
        drive.click.swing = swing;
        double greatest = 0.0;
        bool clicked = false;
        for (int i = 0; i < 4'000'000 && !clicked; ++i) {
            drive.angle += 1.5 * dt;
            const ClickStep click = step_group(group, joints, 0, drive, dt);
            drive.swung = click.swung;
            clicked = click.clicked;
            greatest = std::max(greatest, joints[0].torque);
        }
        for (int i = 0; i < 1000; ++i) drive.swung = step_group(group, joints, 0, drive, dt).swung;
        CHECK(clicked);
        CHECK(greatest <= trips * (1.0 + 1e-12));
        CHECK(greatest > 0.8 * trips);
        CHECK(joints[0].torque < 0.9 * trips);
        return std::pair(joints[0].nut.angle, joints[0].torque);
    };
    PublishedParameters published;
    for (const double dt : {1e-3, 2.5e-4})
        for (const GroupParameters& group :
             {test::single(test::m16_flange_joint()), make_published_group({published})}) {
            const double trips = group.law == Law::published ? 0.6 * published.T_max_Nm : 60.0;
            CHECK(run(group, dt, trips) == run(group, dt, trips));
        }
}
