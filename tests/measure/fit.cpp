// The fit recovers a joint from curves of that joint, and says what it cannot recover.
#include "game/measure/fit.hpp"

#include <nlohmann/json.hpp>

#include "content/format/assembly.hpp"
#include "haptics/joint/group.hpp"
#include "tests/measure/support.hpp"

namespace fit_test {

using namespace measure_test;

namespace {

joint::JointDesign cover_bolt() {
    const content::LoadedAssembly loaded = content::load_assembly("cover-m8");
    REQUIRE(loaded.ok());
    joint::JointDesign design = loaded.assembly.joints[0].design;
    design.friction.scatter = 0.0;
    return design;
}

// The curve of the design up to `torque`; 0: into yield.
measure::Landmarks run_of(joint::JointDesign design, double torque) {
    design.start_gap = 0.3e-3;
    std::vector<double> angles, torques;
    for (const joint::CurveSample& s :
         joint::torque_angle_curve(joint::make_group({&design, 1}, nullptr, 0), {})) {
        angles.push_back(s.angle);
        torques.push_back(s.torque);
        if (torque > 0.0 && s.torque >= torque) break;
    }
    return measure::find_landmarks(analysis::make_torque_curve(angles, torques, joint::Direction::tighten));
}

bool tells(const measure::JointFit& fit, std::string_view part) {
    return std::any_of(fit.unknown.begin(), fit.unknown.end(),
                       [&](const std::string& text) { return text.find(part) != std::string::npos; });
}

}  // namespace

TEST_CASE("Fit: friction and compliance from runs into yield") {
    joint::JointDesign truth = cover_bolt();
    truth.friction.thread = truth.friction.bearing = 0.16;
    for (joint::Member& member : truth.members) member.E = 60e9;
    const measure::Landmarks run = run_of(truth, 0.0);
    REQUIRE(run.yield);
    const auto fit = measure::fit_joint(cover_bolt(), std::vector{run, run}, joint::Direction::tighten);
    REQUIRE(fit);
    CHECK(fit->friction_fitted);
    CHECK(fit->friction == doctest::Approx(0.16).epsilon(0.02));
    CHECK(fit->compliance == doctest::Approx(joint_compliance(truth)).epsilon(0.02));
    CHECK(fit->members_E == doctest::Approx(60e9).epsilon(0.06));
    CHECK(tells(*fit, "10 % stronger"));
    CHECK(tells(*fit, "thread and of bearing"));
}

TEST_CASE("Fit: without yield the compliance follows from the design's friction, and the fit says so") {
    joint::JointDesign truth = cover_bolt();
    for (joint::Member& member : truth.members) member.E = 40e9;
    const measure::Landmarks run = run_of(truth, 18.0);
    REQUIRE_FALSE(run.yield);
    const auto fit = measure::fit_joint(cover_bolt(), std::vector{run}, joint::Direction::tighten);
    REQUIRE(fit);
    CHECK_FALSE(fit->friction_fitted);
    CHECK(fit->friction == doctest::Approx(0.12));
    CHECK(fit->compliance == doctest::Approx(joint_compliance(truth)).epsilon(0.02));
    CHECK(tells(*fit, "cannot be told apart: without yield"));
}

TEST_CASE("Fit: a joint that no members explain") {
    measure::Landmarks run = run_of(cover_bolt(), 18.0);
    run.linear->slope *= 20.0;
    const auto fit = measure::fit_joint(cover_bolt(), std::vector{run}, joint::Direction::tighten);
    REQUIRE(fit);
    CHECK(fit->compliance == 0.0);
    CHECK(tells(*fit, "No modulus of the members"));
    const auto none = measure::fit_joint(cover_bolt(), {}, joint::Direction::tighten);
    CHECK_FALSE(none.has_value());
}

TEST_CASE("Fit: loosening gives the preload at the design's friction only") {
    const joint::JointDesign design = cover_bolt();
    joint::CurveOptions options;
    options.direction = joint::Direction::loosen;
    options.torque = 20.0;
    std::vector<double> angles, torques;
    double clamp = 0.0;
    for (const joint::CurveSample& s :
         joint::torque_angle_curve(joint::make_group({&design, 1}, nullptr, 0), options)) {
        if (clamp == 0.0) clamp = s.clamp;
        angles.push_back(-s.angle);
        torques.push_back(s.torque);
    }
    const measure::Landmarks run =
        measure::find_landmarks(analysis::make_torque_curve(angles, torques, joint::Direction::loosen));
    const auto fit = measure::fit_joint(design, std::vector{run}, joint::Direction::loosen);
    REQUIRE(fit);
    CHECK(fit->preload == doctest::Approx(clamp).epsilon(0.05));
    CHECK(fit->compliance == 0.0);
    CHECK(tells(*fit, "Preload and friction cannot be told apart"));
}

TEST_CASE("Fit: the joint type that it writes can be pasted into an assembly") {
    const content::LoadedAssembly loaded = content::load_assembly("cover-m8");
    REQUIRE(loaded.ok());
    auto fit =
        measure::fit_joint(cover_bolt(), std::vector{run_of(cover_bolt(), 0.0)}, joint::Direction::tighten);
    REQUIRE(fit);
    fit->design.counter_hold = joint::CounterHold::second_wrench;
    fit->design.friction.held_bearing = 0.2;
    fit->design.start_gap = 7e-3;
    fit->design.nut_mass = 0.012;
    const nlohmann::json fragment = nlohmann::json::parse(measure::joint_type_json(*fit, "measured", 20.0));
    nlohmann::json assembly = nlohmann::json::parse(loaded.assembly.text);
    assembly["materials"] = fragment["materials"];
    assembly["joint_types"]["measured"] = fragment["joint_types"]["measured"];
    assembly["joints"][0]["type"] = "measured";
    const content::LoadedAssembly pasted = content::parse_assembly(assembly.dump(2), "pasted.json");
    for (const Error& error : pasted.errors) FAIL_CHECK(error.message());
    REQUIRE(pasted.ok());
    CHECK(joint_compliance(pasted.assembly.joints[0].design) ==
          doctest::Approx(fit->compliance).epsilon(1e-3));
    const joint::JointDesign& design = pasted.assembly.joints[0].design;
    CHECK(design.friction.thread == doctest::Approx(fit->friction).epsilon(1e-3));
    CHECK(design.counter_hold == joint::CounterHold::second_wrench);
    CHECK(design.friction.held_bearing.value_or(0.0) == doctest::Approx(0.2));
    CHECK(design.start_gap == doctest::Approx(7e-3));
    CHECK(design.nut_mass == doctest::Approx(0.012));
}

}  // namespace fit_test
