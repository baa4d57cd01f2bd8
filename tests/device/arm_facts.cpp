// The limits that tools/verify/arms uses are those that the drivers announce.
#include <doctest/doctest.h>

#include "haptics/device/force_dimension.hpp"
#include "haptics/device/haply.hpp"
#include "haptics/device/open_haptics.hpp"
#include "haptics/device/vendor_library.hpp"
#include "tools/emulate/arms/force_dimension.h"
#include "tools/emulate/arms/haply.hpp"
#include "tools/emulate/arms/open_haptics.h"
#include "tools/verify/arms/arm_facts.hpp"

namespace device_arm_facts_test {

using namespace bolt;
using namespace bolt::device;

namespace {

void compare(const char* key, const Description& driver) {
    const arm_validation::ArmFacts* facts = arm_validation::find_arm(key);
    REQUIRE(facts != nullptr);
    CAPTURE(key);
    const Description announced = facts->announced();
    CHECK(announced.renders == driver.renders);
    CHECK(announced.reach.x == driver.reach.x);
    for (const auto limit :
         {&force::OutputLimits::force, &force::OutputLimits::torque, &force::OutputLimits::stiffness,
          &force::OutputLimits::torsion, &force::OutputLimits::damping, &force::OutputLimits::angular_damping,
          &force::OutputLimits::force_rate, &force::OutputLimits::torque_rate})
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
    const std::vector<std::filesystem::path> path{BOLT_EMULATED_FORCE_DIMENSION};
    auto api = load_force_dimension(path);
    REQUIRE(api);
    auto library = VendorLibrary::open(path);
    REQUIRE(library);
    decltype(emu_reset)* reset = nullptr;
    decltype(emu_active_wrist)* active_wrist = nullptr;
    library->find("emu_reset", reset);
    library->find("emu_active_wrist", active_wrist);
    REQUIRE(library->check());
    const auto described = [&](const Model& model) {
        reset();
        active_wrist(model.motors ? 1 : 0);
        ForceDimensionApi used = *api;
        used.get_type = model.number;
        if (!model.wrist) used.has_wrist = no_wrist;
        auto opened = open_force_dimension(used, {0, true}, steady_timer());
        REQUIRE(opened);
        return (*opened)->describe();
    };
    for (const Model& model : models) compare(model.key, described(model));
    reset();
}

TEST_CASE("Arm facts: the limits of OpenHaptics' arms are those of the driver") {
    const std::vector<std::filesystem::path> path{BOLT_EMULATED_OPEN_HAPTICS};
    auto api = load_open_haptics(path);
    REQUIRE(api);
    auto library = VendorLibrary::open(path);
    REQUIRE(library);
    decltype(emu_hd_reset)* reset = nullptr;
    decltype(emu_hd_own_clock)* own_clock = nullptr;
    decltype(emu_hd_report)* report = nullptr;
    library->find("emu_hd_reset", reset);
    library->find("emu_hd_own_clock", own_clock);
    library->find("emu_hd_report", report);
    REQUIRE(library->check());
    const auto described = [&](const EmulatedHdReport& arm) {
        reset();
        own_clock();
        report(arm);
        auto opened = open_open_haptics(*api, steady_timer());
        REQUIRE_MESSAGE(opened, (opened ? "" : opened.error().message()));
        Description description = (*opened)->describe();
        return description;
    };
    compare("touch", described({"Touch", 6, 3, {-200, -200, -200, 200, 200, 200}, 0.5, 3.3, 0.88}));
    compare("premium",
            described({"PHANTOM Premium 1.5", 6, 3, {-300, -300, -300, 300, 300, 300}, 3.5, 8.5, 1.4}));
    reset();
}

TEST_CASE("Arm facts: the limits of the Inverse3 are those of the driver") {
    auto service = emulate::EmulatedHaply::start();
    REQUIRE(service);
    HaplyService at;
    at.states.port = (*service)->port();
    at.events.port = static_cast<std::uint16_t>((*service)->port() + 19);
    auto opened = open_haply(at, 0, steady_timer());
    REQUIRE_MESSAGE(opened, (opened ? "" : opened.error().message()));
    compare("inverse3", (*opened)->describe());
}

}  // namespace device_arm_facts_test
