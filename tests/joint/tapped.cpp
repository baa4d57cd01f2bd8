// Screws in tapped holes, studs, heads that are turned and locking nuts, compared with published values.

#include <doctest/doctest.h>

#include "haptics/joint/design.hpp"
#include "haptics/joint/group.hpp"
#include "haptics/joint/mechanistic.hpp"
#include "haptics/joint/nut.hpp"
#include "tests/joint/support.hpp"

using namespace bolt;
using namespace bolt::joint;

namespace {

// M12x40 of class 10.9 with a socket head, through 20 mm of steel.
JointDesign screw(std::string_view material = "C45") {
    JointDesign d;
    d.form = JointForm::tapped_hole;
    d.head = HeadShape::socket;
    d.turned = TurnedPart::head;
    d.thread = parse_thread("M12").value();
    d.bolt_class = property_class("10.9", 12e-3).value();
    d.bolt_length = 0.040;
    d.members = {{0.020, 205e9}};
    d.hole = {tapped_material(material).value(), 0.020, 0.0};
    d.friction.thread = d.friction.bearing = 0.12;
    d.friction.static_ratio = 1.0;
    d.running_drag = 0.0;
    d.axis = Vec3(1, 0, 0);
    d.start_gap = 0.017;
    return d;
}

}  // namespace

// Bossard, tests with M6 to M16, as multiples of d. VDI 2230 demands the engagement for 1.2 times the bolt's
// tensile strength.
TEST_CASE("Tapped hole: the needed engagement agrees with Bossard's tests within a tenth") {
    struct Row {
        const char* material;
        double shares[3];
    };
    const Row rows[] = {{"S235", {1.0, 1.25, 1.4}},
                        {"S355", {0.9, 1.0, 1.2}},
                        {"C45", {0.8, 0.9, 1.0}},
                        {"GJL-250", {1.0, 1.25, 1.4}}};
    const char* const classes[] = {"8.8", "10.9", "12.9"};
    for (const Row& row : rows)
        for (int i = 0; i < 3; ++i) {
            CAPTURE(row.material);
            CAPTURE(classes[i]);
            double sum = 0.0;
            for (const char* size : {"M6", "M10", "M16"}) {
                const ThreadSize thread = parse_thread(size).value();
                const PropertyClass bolt = property_class(classes[i], thread.size.d).value();
                sum += needed_engagement(thread.thread, bolt, tapped_material(row.material).value(), 1.2) /
                       thread.size.d / 3.0;
            }
            CHECK(std::abs(sum / row.shares[i] - 1.0) < 0.1);
        }
}

TEST_CASE(
    "Tapped hole: the needed engagement strips exactly at the bolt's strength, and idle pitches carry "
    "nothing") {
    for (const TappedMaterial& material : tapped_materials())
        for (const char* name : {"M5", "M8", "M16x1.5", "M24"}) {
            CAPTURE(material.name);
            CAPTURE(name);
            const ThreadSize thread = parse_thread(name).value();
            const PropertyClass bolt = property_class("8.8", thread.size.d).value();
            const double needed = needed_engagement(thread.thread, bolt, material);
            CHECK(stripping_forces(thread.thread, bolt, material, needed).least() /
                      (bolt.R_m * thread.thread.A_s) ==
                  doctest::Approx(1.0).epsilon(1e-9));
            CHECK(stripping_forces(thread.thread, bolt, material, 2.0 * thread.thread.pitch).least() == 0.0);
            CHECK(stripping_forces(thread.thread, bolt, material, 1.1 * needed).internal >
                  stripping_forces(thread.thread, bolt, material, needed).internal);
        }
    CHECK_FALSE(tapped_material("S253"));
    CHECK(tapped_material("S253").error().expected == "did you mean \"S235\"?");
}

// S. Voigt, Hochschule Anhalt, exercise for VDI 2230: hydraulic cylinder with M12, E = 210 GPa. Compliances
// are compared as ratios, as in derivation.cpp.
TEST_CASE("Tapped hole: the bolt's compliance equals the printed example of a hydraulic cylinder") {
    const ScrewThread thread = metric_thread(12e-3, 1.75e-3);
    const double bolt = bolt_compliance(thread, 210e9, 42e-3, 20.5e-3, {0.4, 0.0, 1.0, 0.33, 210e9});
    CHECK(bolt / 2.95e-9 == doctest::Approx(1.0).epsilon(0.003));
    const Member plate{42e-3, 210e9};
    CHECK(member_compliance({&plate, 1}, 21.11e-3, 13.5e-3, 80e-3) / 0.3546e-9 ==
          doctest::Approx(1.0).epsilon(0.003));
}

TEST_CASE("Tapped hole: one deformation cone has the closed form of VDI 2230 with w = 2") {
    const double d_w = 17.23e-3, d_h = 13.5e-3, l = 30e-3, E = 110e9;
    const Member plate{l, E};
    const double tan_phi = 0.348 + 0.013 * std::log(l / d_w) + 0.193 * std::log(3.0);
    const double D = d_w + 2.0 * l * tan_phi;
    const double expected =
        2.0 * std::log((d_w + d_h) * (D - d_h) / ((d_w - d_h) * (D + d_h))) / (2.0 * E * pi * d_h * tan_phi);
    const double one = member_compliance({&plate, 1}, d_w, d_h, 0.0, DeformationCones::one);
    CHECK(one / expected == doctest::Approx(1.0).epsilon(1e-9));
    // The soft layer matters most where the cone is narrow.
    const Member soft_first[] = {{0.5 * l, 70e9}, {0.5 * l, E}},
                 soft_last[] = {{0.5 * l, E}, {0.5 * l, 70e9}};
    CHECK(member_compliance(soft_first, d_w, d_h, 0.0, DeformationCones::one) >
          member_compliance(soft_last, d_w, d_h, 0.0, DeformationCones::one));
    CHECK(member_compliance(soft_first, d_w, d_h, 0.0) / member_compliance(soft_last, d_w, d_h, 0.0) ==
          doctest::Approx(1.0).epsilon(1e-9));
}

TEST_CASE("Turned part: a head brings its own dimensions, hardness and bearing") {
    JointDesign d = screw();
    CHECK(turned_part_size(d).across_flats == doctest::Approx(10e-3));
    CHECK(turned_part_size(d).depth == doctest::Approx(6e-3));
    CHECK(d.bearing_diameter() == doctest::Approx(0.5 * (17.23e-3 + 13.5e-3)));
    CHECK(d.thread_on_bolt() == doctest::Approx(36e-3));  // 2 d + 12 mm
    d.head = HeadShape::hexagon;
    CHECK(turned_part_size(d).across_flats == doctest::Approx(18e-3));
    CHECK(turned_part_size(d).height == doctest::Approx(7.5e-3));
    CHECK(turned_part_size(d).depth == 0.0);
    CHECK(turned_part_hardness(d) == doctest::Approx(320 * 9.80665e6));
    d.turned = TurnedPart::nut;
    CHECK(turned_part_size(d).height == doctest::Approx(10.8e-3));
    CHECK(turned_part_hardness(d) == nut_hardness(d.bolt_class, d.thread.size.d));
    d.locking_insert = true;
    CHECK(turned_part_size(d).height == doctest::Approx(14.9e-3));
}

TEST_CASE("Tapped hole: torque and clamp force obey Motosh with the head's bearing") {
    const JointDesign design = screw();
    const GroupParameters group = test::single(design);
    const std::vector<CurveSample> run = torque_angle_curve(group, {.torque = 80.0});
    const double levers =
        torque_levers(design.thread.thread, 0.12, 0.12, design.bearing_diameter()).tightening_lever();
    const CurveSample& last = run.back();
    CHECK(last.torque >= 80.0);
    CHECK(last.torque / (last.clamp * levers) == doctest::Approx(1.0).epsilon(1e-3));
}

TEST_CASE("Tapped hole: too short an engagement strips at its force, and the clamp force never exceeds it") {
    JointDesign design = screw("AlSi9Cu3");
    design.hole.engagement = 0.012;
    const double strip = stripping_forces(design.thread.thread, design.bolt_class, design.hole.material,
                                          design.hole.engagement)
                             .least();
    const GroupParameters group = test::single(design);
    CHECK(group.joints[0].strip_load == doctest::Approx(strip));
    MechanisticState s;
    double highest = 0.0;
    for (double angle = 0.0; angle < to_radians(13.0 * 360.0); angle += to_radians(0.03)) {
        advance(group.joints[0], s, {angle, 1.0}, 1e-3);
        highest = std::max(highest, s.clamp);
    }
    CHECK(s.condition == JointCondition::stripped);
    CHECK(highest / strip == doctest::Approx(1.0).epsilon(0.02));
    design.hole.engagement = 0.030;  // the bolt breaks first
    const GroupParameters deep = test::single(design);
    CHECK(deep.joints[0].strip_load > design.bolt_class.R_m * design.thread.thread.A_s);
}

TEST_CASE("Stud: its second engaged thread and the hole add compliance, its nut turns") {
    JointDesign stud = screw("GJL-250");
    stud.form = JointForm::stud;
    stud.head = HeadShape::hexagon;
    stud.turned = TurnedPart::nut;
    JointDesign through = stud;
    through.form = JointForm::through_bolt;
    const BoltEnds ends = bolt_ends(stud);
    CHECK(ends.engaged_threads == 2.0);
    const double d = 12e-3, A_N = 0.25 * pi * d * d, A_3 = stud.thread.thread.A_d3();
    const double more = 0.5 * d / A_3 / 205e9 + 0.33 * d / A_N / 110e9 - 0.5 * d / A_N / 205e9;
    const auto bolt = [](const JointDesign& design) {
        return bolt_compliance(design.thread.thread, 205e9, 20e-3, 5e-3, bolt_ends(design));
    };
    CHECK((bolt(stud) - bolt(through)) / more == doctest::Approx(1.0).epsilon(1e-9));
    CHECK(turned_part_size(stud).height == through.thread.size.nut_height);
    // The hole is stronger than the nut or weaker.
    stud.hole.engagement = 0.03;
    CHECK(test::single(stud).joints[0].strip_load == test::single(through).joints[0].strip_load);
    stud.hole.engagement = 0.008;
    CHECK(test::single(stud).joints[0].strip_load < test::single(through).joints[0].strip_load);
}

TEST_CASE("Locking insert: it drags once the bolt's end has reached it, and wears as ISO 2320 allows") {
    JointDesign design = test::m16_flange_joint();
    design.locking_insert = true;
    design.prevailing_torque = 16.0;
    design.running_drag = 0.0;
    design.friction.static_ratio = 1.0;
    design.axis = Vec3(1, 0, 0);
    const double out = design.bolt_length - design.grip_length();
    design.start_gap = out - 1.5 * design.thread.thread.pitch;  // started by one and a half turns
    const MechanisticParameters p = test::single(design).joints[0];
    MechanisticState s;
    const auto drag = [&](double threads_in) {  // m of the bolt inside the nut
        s.angle = (threads_in - 1.5 * design.thread.thread.pitch) / p.levers.lead;
        return resistance(p, s).tighten;
    };
    const double metal = 2.0 / 3.0 * 19.1e-3, pitch = design.thread.thread.pitch;
    CHECK(drag(metal - 0.1e-3) == doctest::Approx(0.0).epsilon(1e-9));
    CHECK(drag(metal + 1.5 * pitch) == doctest::Approx(8.0).epsilon(1e-3));
    CHECK(drag(metal + 3.1 * pitch) == doctest::Approx(16.0).epsilon(1e-3));
    CHECK(resistance(p, s).loosen == doctest::Approx(-16.0).epsilon(1e-3));
    s.uses = 5.0;  // the fifth removal
    CHECK(resistance(p, s).tighten == doctest::Approx(16.0 * 3.0 / 4.5).epsilon(1e-3));
}

TEST_CASE("Locking insert: a nut with a prevailing torque of its own drags from the first turn") {
    JointDesign design = test::m16_flange_joint();
    design.prevailing_torque = 16.0;
    design.running_drag = 0.0;
    design.axis = Vec3(1, 0, 0);
    CHECK(resistance(test::single(design).joints[0], {}).tighten == doctest::Approx(16.0 * 1.15));
}
