// The limits that tools/verify/arms uses are those that the drivers announce.
#include <doctest/doctest.h>

#include "haptics/device/force_dimension.hpp"
#include "tests/device/haply_bench.hpp"
#include "tests/device/open_haptics_bench.hpp"
#include "tests/support/emulated_arms.hpp"
#include "tools/verify/arms/arm_facts.hpp"

namespace device_arm_facts_test {

using namespace bolt;
using namespace bolt::device;
using namespace bolt::test;

namespace {

void compare(const char* key, const Result<std::unique_ptr<DeviceDriver>>& opened) {
    CAPTURE(key);
    REQUIRE_MESSAGE(opened, (opened ? "" : opened.error().message()));
    const Description& driver = (*opened)->description();
    const arm_validation::ArmFacts* facts = arm_validation::find_arm(key);
    REQUIRE(facts != nullptr);
    const Description announced = facts->announced();
    CHECK(announced.renders == driver.renders);
    CHECK(announced.half_workspace.x == driver.half_workspace.x);
    for (const auto limit :
         {&force::OutputLimits::force, &force::OutputLimits::torque, &force::OutputLimits::stiffness,
          &force::OutputLimits::torsion, &force::OutputLimits::damping, &force::OutputLimits::angular_damping,
          &force::OutputLimits::force_slew_rate, &force::OutputLimits::torque_slew_rate})
        CHECK(announced.limits.*limit == driver.limits.*limit);
    CHECK(announced.limits.delay == driver.limits.delay);
}

struct Model {
    const char* key;
    bool wrist, motors;
    int (*number)(char);  // by which the library names it
};
constexpr Model models[] = {{"omega3", false, false, [](char) { return 33; }},
                            {"omega7", true, false, [](char) { return 35; }},
                            {"delta3", false, false, [](char) { return 63; }},
                            {"falcon", false, false, [](char) { return 60; }},
                            {"sigma7", true, true, [](char) { return 104; }},
                            {"lambda7", true, true, [](char) { return 108; }},
                            // An unknown number: the weakest arm with these joints.
                            {"falcon", false, false, [](char) { return 9999; }},
                            {"omega7", true, false, [](char) { return 9999; }},
                            {"sigma7", true, true, [](char) { return 9999; }}};

bool no_wrist(char) { return false; }

}  // namespace

TEST_CASE("Arm facts: the limits of Force Dimension's arms are those of the driver") {
    const ForceDimensionControls arm;
    const auto api = load_force_dimension({BOLT_EMULATED_FORCE_DIMENSION});
    REQUIRE(api);
    for (const Model& model : models) {
        arm.reset();
        arm.active_wrist(model.motors ? 1 : 0);
        ForceDimensionApi used = *api;
        used.get_type = model.number;
        if (!model.wrist) used.has_wrist = no_wrist;
        compare(model.key, open_force_dimension(used, {0, true}, steady_timer()));
    }
    arm.reset();
}

TEST_CASE("Arm facts: the limits of OpenHaptics' arms are those of the driver") {
    OpenHapticsBench bench;
    bench.arm.report({"Touch", 6, 3, {-200, -200, -200, 200, 200, 200}, 0.5, 3.3, 0.88});
    compare("touch", bench.open());
    bench.arm.report({"PHANTOM Premium 1.5", 6, 3, {-300, -300, -300, 300, 300, 300}, 3.5, 8.5, 1.4});
    compare("premium", bench.open());
}

TEST_CASE("Arm facts: the limits of the Inverse3 are those of the driver") {
    compare("inverse3", HaplyBench().open());
}

}  // namespace device_arm_facts_test
