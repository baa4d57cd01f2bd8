// Recomputes every figure that the paper prints, and names the rounding or error where the print differs.

#include "haptics/joint/published.hpp"

#include <doctest/doctest.h>

#include "haptics/joint/group.hpp"

using namespace bolt;
using namespace bolt::joint;

namespace {
const PublishedParameters p;
constexpr auto on = Direction::tighten;
constexpr auto off = Direction::loosen;

// Compares to four significant digits.
doctest::Approx four(double value) { return doctest::Approx(value).epsilon(1e-4).scale(0.0); }

double per_area(double (*torque)(const PublishedParameters&, double, Direction)) {
    return torque(p, 1.0, on) - torque(p, 0.0, on);
}
}  // namespace

TEST_CASE(
    "Published law: eq. 1: running down takes -0.5761 N mm; the printed -0.588 has cos 30 degrees rounded to "
    "0.85") {
    CHECK(published_navigation_torque(p, on) * 1e3 == four(-0.5761));
    const double G = 33.3e-3 * 9.8;
    CHECK(-G * (0.5 - 0.3 * 0.85) * 14.7 / 2 == doctest::Approx(-0.588).epsilon(1e-3));
    CHECK(published_navigation_torque(p, off) * 1e3 == four(-1.8225));
}

TEST_CASE("Published law: eq. 2, bearing: -492.27 A h' + 5.149; the print uses mu1 = 0.3 and names it T1") {
    CHECK(per_area(published_bearing_torque) == four(-492.27));
    CHECK(published_bearing_torque(p, 0.0, on) * 1e3 == four(5.149));
    PublishedParameters slip = p;
    slip.mu1 = 0.3;
    const double printed = published_bearing_torque(slip, 1.0, on) - published_bearing_torque(slip, 0.0, on);
    CHECK(printed == four(-369.2048));
    CHECK(published_bearing_torque(slip, 0.0, on) * 1e3 == four(3.8617));
}

TEST_CASE(
    "Published law: eq. 2, thread: 348.478 A h' - 3.645; the print uses cos 30 degrees = 0.86 and names it "
    "T2") {
    CHECK(per_area(published_thread_torque) == four(348.478));
    CHECK(published_thread_torque(p, 0.0, on) * 1e3 == doctest::Approx(-3.645).epsilon(1e-4));
    CHECK(31.2 * (0.5 + 0.3 * 0.86) * 14.7 == four(347.6491));
    CHECK(-33.3e-3 * 9.8 * (0.5 + 0.3 * 0.86) * 14.7 == four(-3.6363));
}

TEST_CASE(
    "Published law: eq. 2, sum: the print's -21.5557 A h' + 0.2254 is the difference of two torques that "
    "both resist") {
    CHECK(-369.2048 + 347.6491 == four(-21.5557));
    CHECK(3.8617 - 3.6363 == doctest::Approx(0.2254).epsilon(1e-3));
}

TEST_CASE("Published law: eq. 3: 14.354 N m per degree, lever arm 12.464 mm; the print rounds to 14.4") {
    CHECK(published_linear_slope(p) == four(14.354));
    CHECK(published_lever(p, on) * 1e3 == four(12.464));
    CHECK(published_degrees_per_newton(p) == doctest::Approx(0.868e-3).epsilon(1e-3));
    CHECK(std::round(published_linear_slope(p) * 10) / 10 == 14.4);
    // The paper inserts a diameter for r_b; with effective radii the arm is 6.734 mm.
    PublishedParameters radii = p;
    radii.r_b_mm = (24.0 + 14.7) / 4;
    CHECK(published_lever(radii, on) * 1e3 == four(6.734));
}

TEST_CASE("Published law: eq. 4: 59.976 N m a quarter turn before the end, 72.126 at the end, in degrees") {
    CHECK(published_yield_torque(p, 7128.0) == four(59.976));
    CHECK(published_yield_torque(p, 7218.0) == four(72.126));
    CHECK(p.theta_max_deg / 360.0 == four(20.05));
    CHECK(to_radians(p.theta_max_deg) / pi == four(40.1));
    // With angles in radians the torque would change by only 0.004 N m over the whole stage.
    CHECK(0.0015 * square(to_radians(90.0)) == doctest::Approx(0.0037).epsilon(0.01));
}

TEST_CASE(
    "Published law: the linear stage takes 4.178 degrees and meets the yield stage without a jump in "
    "torque") {
    const PublishedBoundaries b = published_boundaries(p);
    CHECK(b.yield - b.linearity == four(4.178));
    const PublishedState fresh;
    CHECK(evaluate_published(p, fresh, b.yield - 1e-9, on).torque ==
          doctest::Approx(evaluate_published(p, fresh, b.yield, on).torque).epsilon(1e-8));
}

TEST_CASE(
    "Published law: it has the paper's discontinuities: jumps at the start of stages 2 and 3, and a slope "
    "that falls to 0.27") {
    const PublishedBoundaries b = published_boundaries(p);
    const PublishedState s;
    const auto torque = [&](double degrees) { return evaluate_published(p, s, degrees, on).torque; };
    CHECK(std::abs(torque(b.transition) - torque(b.transition - 1e-9)) > 1e-3);
    CHECK(std::abs(torque(b.linearity) - torque(b.linearity - 1e-9)) > 1.0);
    CHECK((torque(b.yield + 1e-4) - torque(b.yield)) / 1e-4 == doctest::Approx(0.27).epsilon(1e-3));
}

TEST_CASE("Published law: the angle of a torque is the inverse of the tightening curve") {
    const PublishedBoundaries b = published_boundaries(p);
    CHECK(published_angle(p, 59.976) == doctest::Approx(7128.0).epsilon(1e-9));
    CHECK(published_angle(p, 72.126) == 7218.0);
    CHECK(published_angle(p, 80.0) == 7218.0);
    CHECK(published_angle(p, 0.0) == doctest::Approx(b.linearity).epsilon(1e-12));
    CHECK(published_angle(p, -1.0) == published_angle(p, 0.0));
    for (double degrees = b.linearity; degrees <= p.theta_max_deg; degrees += 0.37)
        CHECK(published_angle(p, evaluate_published(p, {}, degrees, on).torque) ==
              doctest::Approx(degrees).epsilon(1e-9));
}

TEST_CASE("Published law: each joint of a group has its own parameters") {
    PublishedParameters stiff = p, weak = p;
    for (double& rate : stiff.spring_rates_1e6) rate *= 2.0;
    weak.T_max_Nm = 60.0;
    weak.theta_max_deg = 3600.0;
    const std::vector<PublishedParameters> laws{p, stiff, weak};
    const GroupParameters group = make_published_group(laws);
    std::vector<JointState> joints = initial_state(group, 3);
    const auto torque = [&](std::size_t i, double before_end) {
        turn_nut(group, joints, i, to_radians(laws[i].theta_max_deg - before_end), 1.0, 1e-3);
        return joints[i].torque;
    };
    for (std::size_t i = 0; i < 3; ++i)
        CHECK(torque(i, 91.0) ==
              doctest::Approx(published_yield_torque(laws[i], laws[i].theta_max_deg - 90.0) -
                              published_linear_slope(laws[i])));
    CHECK(torque(0, 91.0) - torque(1, 91.0) == doctest::Approx(14.354).epsilon(1e-4));
    CHECK(torque(1, 0.0) == doctest::Approx(72.126));
    CHECK(torque(2, 0.0) == doctest::Approx(60.0));
    CHECK(joints[0].published.peak_deg == 0.0);  // turning another nut leaves it alone
    CHECK(resistance(group, 2, joints[2]).tighten == doctest::Approx(60.0));
}

TEST_CASE("Published law: the stages follow in order of the angle") {
    const PublishedBoundaries b = published_boundaries(p);
    const PublishedState s;
    CHECK(evaluate_published(p, s, 0.0, on).stage == Stage::navigation);
    CHECK(evaluate_published(p, s, b.transition + 0.1, on).stage == Stage::transition);
    CHECK(evaluate_published(p, s, b.linearity + 0.1, on).stage == Stage::linearity);
    CHECK(evaluate_published(p, s, b.yield + 0.1, on).stage == Stage::yield);
}

TEST_CASE(
    "Published law: the loosening torque is lower by the lead and follows a shifted elastic line after "
    "yield") {
    const PublishedBoundaries b = published_boundaries(p);
    PublishedState s;
    CHECK(published_lever(p, on) - published_lever(p, off) == doctest::Approx(2e-3 / pi).epsilon(1e-9));
    published_advance(p, s, p.theta_max_deg);
    const double clamp = evaluate_published(p, s, p.theta_max_deg, on).clamp;
    CHECK(clamp == doctest::Approx(72.126 / published_lever(p, on)).epsilon(1e-9));
    // Turning back by the elastic angle of that clamp force removes it.
    const double back = clamp * published_degrees_per_newton(p);
    CHECK(s.set_deg == doctest::Approx(p.theta_max_deg - back - b.linearity).epsilon(1e-9));
    CHECK(evaluate_published(p, s, p.theta_max_deg - back + 0.01, off).clamp < 0.01 * clamp);
    CHECK(evaluate_published(p, s, p.theta_max_deg - 1.0, off).torque < 0.0);
    // Re-tightening follows the elastic line up to the previous angle, then the yield curve.
    CHECK(evaluate_published(p, s, p.theta_max_deg - 1e-6, on).clamp == doctest::Approx(clamp).epsilon(1e-3));
}

TEST_CASE("Published law: the whole curve from the tool's entry point prints the oracle's figures") {
    const GroupParameters group = make_published_group({p});
    CurveOptions options;
    const std::vector<CurveSample> run = torque_angle_curve(group, options);
    REQUIRE(run.size() > 1000);
    CHECK(run.front().torque * 1e3 == four(-0.5761));
    CHECK(run.back().torque == doctest::Approx(72.126).epsilon(1e-4));
    double previous_angle = 0.0, previous_torque = 0.0;
    int linear = 0;
    for (const CurveSample& s : run) {
        if (s.stage == Stage::linearity && linear++ > 0)
            CHECK((s.torque - previous_torque) / to_degrees(s.angle - previous_angle) ==
                  doctest::Approx(14.354).epsilon(1e-3));
        previous_angle = s.angle;
        previous_torque = s.torque;
    }
    CHECK(linear > 100);
}
