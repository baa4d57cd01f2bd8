// Parameters derived from a design, compared with closed forms, and the boundaries between the stages of the
// law.

#include <doctest/doctest.h>

#include "haptics/joint/design.hpp"
#include "haptics/joint/group.hpp"
#include "haptics/joint/mechanistic.hpp"
#include "tests/joint/support.hpp"

using namespace bolt;
using namespace bolt::joint;

namespace {

// The elastic joint only: no drag, no breakaway, no embedding.
JointDesign plain() {
    JointDesign d = test::m16_flange_joint();
    d.friction.static_ratio = 1.0;
    d.running_drag = 0.0;
    d.embedding_time = 1e12;
    d.axis = Vec3(1, 0, 0);
    return d;
}

// Angle (rad) at which the joint alone carries the clamp force `force`, with its present plastic deformation.
double angle_at(const MechanisticParameters& p, const MechanisticState& s, double force) {
    return (p.seat.closure(force) + p.start_gap + s.plastic + s.stripped + s.embedding) / p.levers.lead;
}

MechanisticState tightened(const MechanisticParameters& p, double force, double share = 1.0) {
    MechanisticState s;
    advance(p, s, {angle_at(p, s, force), share}, 1e-3);
    return s;
}

}  // namespace

TEST_CASE("Derive: in a group the flange's own compliance adds to bolt and members") {
    std::vector<JointDesign> designs(2, plain());
    designs[1].seat = Vec3(0.1, 0.0, 0.0);
    const FlangePlate plate = FlangePlate::make(0.024, 110e9, 0.25, 1e11);
    const GroupParameters group = make_group(designs, &plate, 1);
    const double own = square(plate.length()) / (8.0 * plate.rigidity);
    const double delta = joint_compliance(designs[0]) + own;
    CHECK(own > 0.05 * delta);
    std::vector<JointState> joints = initial_state(group, 2);
    const MechanisticParameters& p = group.joints[0];
    for (const double force : {1e3, 10e3, 40e3}) {
        const double closure = delta * force + p.seat.scale * std::log(force / p.seat.touch_force);
        turn_nut(group, joints, 0, (closure + 2e-3) / (2e-3 / (2.0 * pi)), 1.0, 1e-3);
        CHECK(joints[0].clamp == doctest::Approx(force).epsilon(1e-6));
    }
}

TEST_CASE("Derive: joints couple as far as ten lengths of the plate and no further") {
    const FlangePlate plate = FlangePlate::make(0.024, 110e9, 0.25, 1e11);
    const double l = plate.length();
    for (const double lengths : {1.0, 5.0, 9.9}) {
        const std::vector<Vec3> seats = {Vec3(0.0), Vec3(0.6 * lengths * l, 0.0, 0.8 * lengths * l)};
        const InteractionMatrix m = interaction_matrix(plate, seats);
        REQUIRE(m.row_begin == std::vector<std::uint32_t>{0, 1, 2});
        CHECK(m.column == std::vector<std::uint32_t>{1, 0});
        for (const double w : m.value)
            CHECK(w / plate.deflection_per_force(lengths * l) == doctest::Approx(1.0).epsilon(1e-9));
    }
    const InteractionMatrix far =
        interaction_matrix(plate, std::vector<Vec3>{Vec3(0.0), Vec3(10.1 * l, 0.0, 0.0)});
    CHECK(far.column.empty());
    CHECK(std::abs(plate.deflection_per_force(10.0 * l)) < 1e-3 * plate.deflection_per_force(0.0));
}

// Compliances are of the order of 1e-9 m/N. They are compared as ratios, because the tolerance of doctest's
// Approx is epsilon times (1 + value).
TEST_CASE("Derive: the deflection under one bolt equals Hertz's l2/8D") {
    const FlangePlate plate = FlangePlate::make(0.024, 110e9, 0.25, 1e11);
    const double hertz = square(plate.length()) / (8.0 * plate.rigidity);
    CHECK(plate.deflection_per_force(0.0) / hertz == doctest::Approx(1.0).epsilon(1e-9));
}

TEST_CASE("Derive: the slopes of the resistance are its derivatives over the angle of the elastic joint") {
    JointDesign design = plain();
    design.friction.static_ratio = 1.3;
    const GroupParameters group = test::single(design);
    const MechanisticParameters& p = group.joints[0];
    for (const double force : {500.0, 5e3, 40e3}) {
        CAPTURE(force);
        MechanisticState s = tightened(p, force);
        s.breakaway = 0.5;
        s.uses = 2.0;
        const auto at = [&](double by) {
            MechanisticState t = s;
            t.angle += by;
            t.clamp = p.seat.at(closure_at_angle(p, t, t.angle)).force;
            return resistance(p, t);
        };
        const double h = 1e-5;
        const Resistance r = resistance(p, s), more = at(h), less = at(-h);
        CHECK(r.tighten_slope > 0.0);
        CHECK(r.tighten_slope == doctest::Approx((more.tighten - less.tighten) / (2 * h)).epsilon(1e-5));
        CHECK(r.loosen_slope < 0.0);
        CHECK(r.loosen_slope == doctest::Approx((more.loosen - less.loosen) / (2 * h)).epsilon(1e-5));
    }
}

TEST_CASE("Derive: less thread torque raises the yield load, at rest and while loosening") {
    const GroupParameters group = test::single(plain());
    const MechanisticParameters& p = group.joints[0];
    const auto yields_at = [&](double share) {
        double last = 0.0;
        MechanisticState s;
        for (double force = 70e3; s.plastic == 0.0 && force < 200e3; force += 20.0) {
            last = force;
            advance(p, s, {angle_at(p, s, force), share}, 1e-3);
        }
        return last;
    };
    const auto expected = [&](double share) {
        // tan(phi + rho'); d0 is the diameter of the stress area.
        const double phi = std::atan(0.002 / (pi * p.thread.d2));
        const double rho = std::atan(share * 0.12 / std::cos(pi / 6.0));
        const double shear = 1.5 * p.thread.d2 / p.thread.d0() * std::tan(phi + rho);
        return p.bolt.elastic_load / std::sqrt(1.0 + 3.0 * square(shear));
    };
    for (const double share : {-1.0, 0.0, 0.5, 1.0})
        CHECK(yields_at(share) == doctest::Approx(expected(share)).epsilon(5e-4));
    CHECK(yields_at(-1.0) > 1.05 * yields_at(1.0));
    CHECK(yields_at(0.0) > 1.02 * yields_at(-1.0));
}

TEST_CASE("Derive: linearity begins at three quarters of the elastic stiffness, yield at half of it") {
    const GroupParameters group = test::single(plain());
    const MechanisticParameters& p = group.joints[0];
    MechanisticState s;
    // Plastic flow is complete within each long step, so the rate has no effect.
    const double step = 2e-4, dt = 1.0;
    double clamp[3] = {0.0, 0.0, 0.0};
    int changes = 0;
    for (double angle = 6.0; angle < 16.0 && changes < 3; angle += step) {
        const Stage before = s.stage;
        advance(p, s, {angle, 1.0}, dt);
        clamp[0] = clamp[1];
        clamp[1] = clamp[2];
        clamp[2] = s.clamp;
        const double tangent = (clamp[2] - clamp[0]) / (2 * step * p.levers.lead) * p.seat.compliance;
        if (s.stage == before) continue;
        ++changes;
        if (s.stage == Stage::transition) CHECK(s.clamp == doctest::Approx(p.seat.touch_force).epsilon(0.02));
        if (s.stage == Stage::linearity) CHECK(tangent == doctest::Approx(0.75).epsilon(0.005));
        if (s.stage == Stage::yield) CHECK(tangent == doctest::Approx(0.5).epsilon(0.05));
    }
    CHECK(changes == 3);
    CHECK(s.stage == Stage::yield);
}

TEST_CASE("Derive: the seat closes over half the rms roughness and the misfit") {
    for (const double Rz : {6.3e-6, 16e-6, 100e-6}) {
        JointDesign design = plain();
        design.roughness_Rz = Rz;
        design.misfit = 7e-6;
        const double scale = test::single(design).joints[0].seat.scale;
        CHECK(scale / (0.5 * Rz / 5.5 + 7e-6) == doctest::Approx(1.0).epsilon(1e-12));
    }
}

TEST_CASE("Derive: stripping lasts over three quarters of the nut's height") {
    JointDesign design = plain();
    design.nut_strength = 300e6;
    const GroupParameters group = test::single(design);
    const MechanisticParameters& p = group.joints[0];
    std::vector<JointState> joints = initial_state(group, 1);
    double sheared_at = 0.0, highest = 0.0;
    for (int i = 0; i < 100'000; ++i) {
        turn_nut(group, joints, 0, joints[0].nut.angle + 1e-3, 1.0, 1e-3);
        highest = std::max(highest, joints[0].clamp);
        if (joints[0].condition != JointCondition::stripped) continue;
        if (sheared_at == 0.0) sheared_at = joints[0].nut.angle;
        if (joints[0].clamp < 0.01 * highest) break;
        const double gone = joints[0].mechanistic.stripped / (0.75 * design.thread.size.nut_height);
        if (gone > 0.1 && gone < 0.5)
            REQUIRE(joints[0].clamp == doctest::Approx(300e6 * p.thread.A_s * (1.0 - gone)).epsilon(0.05));
    }
    REQUIRE(sheared_at > 0.0);

    CHECK(joints[0].nut.angle - sheared_at ==
          doctest::Approx(0.75 * design.thread.size.nut_height / (2e-3 / (2.0 * pi))).epsilon(0.1));
}

TEST_CASE("Derive: a necked bolt breaks at 80 % of its greatest load") {
    const ThreadSize m16 = parse_thread("M16").value();
    for (const std::string& name : property_class_names()) {
        const PropertyClass grade = property_class(name, 0.016).value();
        const PlasticCurve c = PlasticCurve::make(m16.thread, grade, 0.03, 3e-9);
        CHECK(c.at(c.fracture * (1.0 - 1e-12)).load ==
              doctest::Approx(0.8 * grade.R_m * m16.thread.A_s).epsilon(1e-6));
    }
}

TEST_CASE("Derive: a tenth of the reference load causes a tenth of the embedding") {
    JointDesign design = plain();
    design.embedding_time = 5.0;
    const GroupParameters group = test::single(design);
    const MechanisticParameters& p = group.joints[0];
    for (const double share : {0.1, 0.5, 1.0}) {
        MechanisticState s;
        for (int i = 0; i < 2000; ++i) advance(p, s, {angle_at(p, s, share * p.reference_load), 1.0}, 0.1);
        CHECK(s.embedding / p.embedding == doctest::Approx(share).epsilon(1e-3));
    }
}

TEST_CASE("Derive: the nut's weight lowers the torque downward, raises it upward and adds friction") {
    JointDesign design = plain();
    design.nut_mass = 0.05;
    const auto on = [&](const Vec3& axis) {
        design.axis = axis;
        return test::single(design).joints[0];
    };
    const double lead = 0.05 * 9.81 * 2e-3 / (2.0 * pi);
    const double friction = 0.05 * 9.81 * 0.12 * 0.5 * (0.016 - 0.64952 * 2e-3) / std::cos(pi / 6.0);
    for (const double up : {1.0, -1.0, 0.5, 0.0}) {
        CAPTURE(up);
        const MechanisticParameters p = on(Vec3(std::sqrt(1.0 - up * up), up, 0.0));
        const Resistance r = resistance(p, MechanisticState{});
        CHECK(std::abs(r.lead_torque + up * lead) < 1e-12);
        CHECK(std::abs(r.tighten + up * lead - std::abs(up) * friction) < 1e-12);
        CHECK(std::abs(r.loosen + up * lead + std::abs(up) * friction) < 1e-12);
    }
}

TEST_CASE(
    "Derive: a locking nut breaks away at the static ratio times its prevailing torque, then runs at that "
    "torque") {
    JointDesign design = plain();
    design.prevailing_torque = 32.0;
    design.friction.static_ratio = 1.25;
    const MechanisticParameters p = test::single(design).joints[0];
    MechanisticState s;
    CHECK(resistance(p, s).tighten == doctest::Approx(40.0));
    CHECK(resistance(p, s).loosen == doctest::Approx(-40.0));
    s.breakaway = 0.0;
    CHECK(resistance(p, s).tighten == doctest::Approx(32.0));
    CHECK(resistance(p, s).loosen == doctest::Approx(-32.0));
}

TEST_CASE("Derive: friction of thread and bearing scatter independently with the same spread") {
    JointDesign design = plain();
    design.friction.scatter = 0.06;
    const std::vector<JointDesign> designs(400, design);
    const GroupParameters group = make_group(designs, nullptr, 7);
    double x = 0.0, y = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;
    for (const MechanisticParameters& p : group.joints) {
        const double a = p.levers.thread, b = p.levers.bearing;
        x += a;
        y += b;
        xx += a * a;
        yy += b * b;
        xy += a * b;
    }
    const double n = 400.0;
    const double vx = xx / n - square(x / n), vy = yy / n - square(y / n);
    const double r = (xy / n - x / n * (y / n)) / std::sqrt(vx * vy);
    CHECK(std::abs(r) < 0.15);
    CHECK(std::sqrt(vy) / (y / n) == doctest::Approx(0.06).epsilon(0.15));
}

TEST_CASE(
    "Derive: loosening in the yield stage of the published law takes the clamp force times the loosening "
    "lever") {
    const PublishedParameters p;
    const GroupParameters group = make_published_group({p});
    const PublishedBoundaries b = published_boundaries(p);
    // The published friction levers minus the lead.
    const double lever = (-2.0 / (2.0 * pi) + 0.3 * 14.7 / (2.0 * std::cos(pi / 6.0)) + 0.4 * 24.0) * 1e-3;
    for (const double further : {0.0, 45.0, 90.0}) {
        const PublishedResponse off = evaluate_published(p, {}, b.yield + further, Direction::loosen);
        REQUIRE(off.stage == Stage::yield);
        const double clamp = published_yield_torque(p, b.yield + further) / ((lever + 4e-3 / (2.0 * pi)));
        CHECK(off.clamp == doctest::Approx(clamp).epsilon(1e-9));
        CHECK(off.torque == doctest::Approx(-clamp * lever).epsilon(1e-9));
        JointState joint;
        joint.nut.angle = to_radians(b.yield + further);
        CHECK(resistance(group, 0, joint).loosen == doctest::Approx(-clamp * lever).epsilon(1e-9));
    }
}
