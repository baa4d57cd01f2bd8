// The simulated rig against the joint that it simulates.
#include "game/measure/simulated_rig.hpp"

#include "content/format/assembly.hpp"
#include "haptics/joint/group.hpp"
#include "tests/measure/support.hpp"

namespace simulated_rig_test {

using namespace measure_test;

namespace {

joint::JointDesign m16() {
    const content::LoadedAssembly loaded = content::load_assembly("zq350", "stainless");
    REQUIRE(loaded.ok());
    joint::JointDesign design = loaded.assembly.joints[0].design;
    design.friction.scatter = 0.0;
    return design;
}

measure::RigRun imported(const measure::SensorModel& model, std::uint64_t seed) {
    const auto rows = measure::simulate_run(m16(), 72.0, seed, model);
    return only_run(import_text(measure::simulated_rig_json(model, "rig", "M16"), measure::sensor_csv(rows)));
}

}  // namespace

TEST_CASE("Simulated rig: the import finds the slope and the peak of the simulated joint") {
    const joint::JointDesign design = m16();
    std::vector<double> angles, torques;
    for (const joint::CurveSample& s :
         joint::torque_angle_curve(joint::make_group({&design, 1}, nullptr, 0), {})) {
        angles.push_back(s.angle);
        torques.push_back(s.torque);
        if (s.torque > 72.0) break;
    }
    const measure::Landmarks truth =
        measure::find_landmarks(analysis::make_torque_curve(angles, torques, joint::Direction::tighten));
    const measure::RigRun run = imported({}, 4);
    REQUIRE(truth.linear);
    REQUIRE(run.landmarks.linear);
    CHECK(run.landmarks.linear->slope == doctest::Approx(truth.linear->slope).epsilon(0.05));
    CHECK(run.landmarks.peak.torque == doctest::Approx(72.0).epsilon(0.03));
    CHECK(run.zero == doctest::Approx(0.9).epsilon(0.05));  // 3 N at 0.3 m
    CHECK(run.noise == doctest::Approx(0.4 * 0.3).epsilon(0.1));
    CHECK_FALSE(run.landmarks.yield);
    REQUIRE(run.landmarks.free);
    CHECK(run.landmarks.free->mean < 1.0);
}

TEST_CASE("Simulated rig: equal seeds give equal data, other seeds other data") {
    const auto csv = [](std::uint64_t seed) {
        return measure::sensor_csv(measure::simulate_run(m16(), 72.0, seed));
    };
    CHECK(csv(1) == csv(1));
    CHECK(csv(1) != csv(2));
}

TEST_CASE("Simulated rig: noise and drift are those of the sensor model") {
    measure::SensorModel model;
    model.rest = 20.0;
    model.force_drift = 0.1;
    model.force_noise = 0.5;
    const auto rows = measure::simulate_run(m16(), 30.0, 3, model);
    double sum = 0.0, squares = 0.0;
    const std::size_t count = 9900;  // at rest
    REQUIRE(rows.size() > count);
    for (std::size_t i = 0; i < count; ++i) {
        const double rest = rows[i].force - model.force_offset - 0.1 * rows[i].time;
        sum += rest;
        squares += rest * rest;
        CHECK(rows[i].angle == 0.0);
    }
    CHECK(std::abs(sum / count) < 0.02);
    CHECK(std::sqrt(squares / count) == doctest::Approx(0.5).epsilon(0.03));
}

}  // namespace simulated_rig_test
