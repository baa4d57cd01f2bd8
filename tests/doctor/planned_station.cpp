// A request becomes a planned station, or an error that names the fault.
#include "game/station/station_setup.hpp"

#include <doctest/doctest.h>

#include <filesystem>

#include "content/format/assembly.hpp"
#include "engine/base/file.hpp"
#include "haptics/device/virtual_devices.hpp"
#include "haptics/hand/kinematics.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/folder.hpp"
#include "tools/emulate/glove.hpp"

using namespace bolt;
using namespace bolt::station;
using namespace bolt::station_setup;
using test::Folder;

namespace {

content::Assembly assembly(const std::string& name) {
    content::LoadedAssembly loaded = content::load_assembly(name);
    REQUIRE(loaded.ok());
    return std::move(loaded.assembly);
}

std::string error_of(const content::Assembly& what, const StationRequest& request) {
    const Result<PlannedStation> planned = plan_station(what, request);
    return planned ? "" : planned.error().message();
}

content::GloveCalibration calibration(hand::Side hand, std::size_t sensors) {
    content::GloveCalibration c;
    c.trainee = "Ada";
    c.hand = hand;
    c.sensors = sensors;
    c.date = "2026-11-22";
    c.quality = 0.9;
    for (const hand::Sensor sensor : hand::sensors_of(sensors))
        c.calibration.fits[hand::index(sensor)] = hand::LinearFit{0.0125, 40.0};
    return c;
}

}  // namespace

TEST_CASE(
    "Planned station: in every shipped assembly the wrench begins on the nut, holds it and stays in place") {
    for (const std::string name : {"cover-m8", "dn200-pn16", "zq350"})
        for (const bool tight : {false, true}) {
            CAPTURE(name);
            CAPTURE(tight);
            const content::Assembly what = assembly(name);
            StationRequest request;
            request.tightened = tight;
            Result<PlannedStation> planned = plan_station(what, request);
            REQUIRE_MESSAGE(planned, (planned ? "" : planned.error().message()));
            CHECK(planned->obstacles);
            const servo::Setup setup = planned->options.make_setup({}, 1e-3);
            Result<servo::State> state = planned->options.make_state(setup);
            REQUIRE(state);
            CHECK(state->tool_contact.has_value());
            servo::TickInput input;
            input.commanded_tool = servo::to_commanded_tool(planned->options.home);
            input.dead_man = true;
            input.grip = servo::Grip::wrench;
            servo::Output output;
            for (int i = 0; i < 700; ++i) output = servo::tick(setup, *state, input);
            CHECK(output.joint == 0);
            CHECK(glm::length(output.constrained_tool.position - planned->options.home.position) < 0.5e-3);
            CHECK(glm::length(output.force) < 1.0);
            CHECK((output.clamp > 1000.0) == tight);
        }
}

TEST_CASE("Planned station: without obstacles, and on another nut") {
    const content::Assembly what = assembly("cover-m8");
    StationRequest request;
    request.obstacles = false;
    request.joint = 2;
    Result<PlannedStation> planned = plan_station(what, request);
    REQUIRE(planned);
    CHECK(!planned->obstacles);
    const servo::Setup setup = planned->options.make_setup({}, 1e-3);
    Result<servo::State> state = planned->options.make_state(setup);
    REQUIRE(state);
    servo::TickInput input;
    input.commanded_tool = servo::to_commanded_tool(planned->options.home);
    input.grip = servo::Grip::wrench;
    input.dead_man = true;
    servo::tick(setup, *state, input);
    CHECK(servo::tick(setup, *state, input).joint == 2);
}

TEST_CASE("Planned station: it can be started; without a selected device the substitute moves the tool") {
    const content::Assembly what = assembly("cover-m8");
    device::VirtualPuck mouse({}, device::steady_timer());
    StationRequest request;
    request.fallback_mover = mouse.factory();
    Result<PlannedStation> planned = plan_station(what, request);
    REQUIRE(planned);
    planned->options.device_threads.priority = planned->options.servo.priority = 0;
    planned->options.servo.lock_memory = false;
    planned->options.open_timeout = 60.0;
    Result<Station> station = Station::start(std::move(planned->options));
    REQUIRE_MESSAGE(station, (station ? "" : station.error().message()));
    StationControls controls;
    controls.grip = servo::Grip::wrench;
    controls.dead_man = true;
    station->set_controls(controls);
    REQUIRE(test::eventually([&] { return station->latest_tick().output.joint == 0; }));
    REQUIRE(test::eventually([&] { return station->link_stats().mover.samples > 10; }));
    CHECK(station->mover_status()->description->name == "mouse and keyboard");
    CHECK(station->wheel_status() == nullptr);
    CHECK(station->glove_report() == nullptr);
}

TEST_CASE("Planned station: what a station file says holds for its devices only") {
    content::StationFile file;
    content::StationMover& arm = file.arm.emplace();
    arm.device = "haply:0";
    arm.mounting = {0.5 * pi, 0.1, 0.2};
    arm.scale = 3.0;
    arm.power_ratio = 0.25;
    arm.buttons = Buttons{4, 8, 16, 32};
    arm.limits.force = 5.0;
    content::StationWheel& wheel = file.wheel.emplace();
    wheel.device = "1209:ffb0";
    wheel.config.full_torque = 8.0;
    wheel.buttons = Buttons{2, 0, 1, 0};
    const auto planned_with = [&](const char* mover, const char* turner) {
        PlannedStation planned;
        planned.devices.mover.emplace().id = mover;
        planned.devices.wheel.emplace().id = turner;
        const device::WheelConfig config = apply_station(file, planned);
        return std::pair(std::move(planned), config);
    };
    const auto [same, config] = planned_with("haply:0", "1209:ffb0");
    CHECK(same.options.workspace.rotation == content::orientation_of(arm.mounting));
    CHECK(same.options.workspace.scale == 3.0);
    CHECK(same.options.workspace.power_ratio == 0.25);
    CHECK(same.options.mover_buttons == Buttons{4, 8, 16, 32});
    CHECK(same.options.mover_limit_bounds == arm.limits);
    CHECK(same.options.wheel_buttons == Buttons{2, 0, 1, 0});
    CHECK(config == wheel.config);

    const auto [other, usual] = planned_with("haply:1", "1209:ffb1");
    CHECK(other.options.workspace.rotation == Quat(1, 0, 0, 0));
    CHECK(!other.options.workspace.scale);
    CHECK(other.options.mover_buttons == Buttons{});
    CHECK(other.options.mover_limit_bounds == force::LimitBounds{});
    CHECK(other.options.wheel_buttons == Buttons{});
    CHECK(usual == device::WheelConfig{});
}

TEST_CASE("Planned station: errors are reported before a device is opened") {
    const content::Assembly what = assembly("cover-m8");
    CHECK(error_of(what, {.devices = {"256f:0000"}}).find("boltwright devices") != std::string::npos);
    const Folder folder;
    const auto rig = folder / "rig.json";
    REQUIRE(write_file(rig, "{\"format\": \"boltwright rig 1\", \"most_torque_Nm\": 400}"));
    CHECK(error_of(what, {.wheel_config_file = rig}).find("rig.json:1:") != std::string::npos);
    CHECK(error_of(what, {.glove = "/dev/null"}).find("not a serial port") != std::string::npos);
    CHECK(error_of(what, {.glove = folder / "none"}).find("adapter plugged in?") != std::string::npos);
    content::Assembly bare = assembly("cover-m8");
    bare.wrench.model.clear();  // its wrench is generated
    CHECK(make_hand_setup(bare, calibration(hand::Side::right, 22)));
}

TEST_CASE("Wearer: the calibration must match the trainee, the side and the number of sensors") {
    const content::Assembly what = assembly("cover-m8");
    const Folder folder;
    auto glove = emulate::SerialGlove::start({.sensors = 22, .hand = hand::Side::left});
    REQUIRE(glove);
    StationRequest request;
    request.glove = glove->port();
    CHECK(!plan_station(what, request)->options.hand);
    request.trainee = "Ada";
    request.calibrations = folder.path();
    const auto store = [&](hand::Side hand, std::size_t sensors) {
        REQUIRE(content::save_glove_calibration(content::glove_calibration_path(folder.path(), "Ada", hand),
                                                calibration(hand, sensors)));
    };
    store(hand::Side::right, 22);
    CHECK(error_of(what, request).find("no calibration of Ada's left hand") != std::string::npos);
    CHECK(error_of(what, request).find("boltwright glove calibrate --trainee \"Ada\"") != std::string::npos);
    store(hand::Side::left, 18);
    CHECK(error_of(what, request).find("with 18 sensors, and this one has 22") != std::string::npos);
    store(hand::Side::left, 22);
    const Result<PlannedStation> planned = plan_station(what, request);
    REQUIRE_MESSAGE(planned, (planned ? "" : planned.error().message()));
    REQUIRE(planned->options.hand);
    CHECK(planned->options.hand->wearer.hand.side == hand::Side::left);
    CHECK(planned->calibration->date == "2026-11-22");
    CHECK(planned->glove == glove->port());
}

TEST_CASE("Wearer: either hand grasps every shipped wrench, the thumb towards the jaw") {
    for (const std::string name : {"cover-m8", "dn200-pn16", "zq350"})
        for (const hand::Side side : {hand::Side::left, hand::Side::right}) {
            CAPTURE(name);
            CAPTURE(static_cast<int>(side));
            const Result<HandSetup> setup = make_hand_setup(assembly(name), calibration(side, 22));
            REQUIRE(setup);
            hand::GraspState grasp;
            for (int i = 0; i < 8; ++i)
                update_grasp(grasp, {}, setup->tool, setup->wearer.hand,
                             {true, hand::closed_hand_angles(1.0), setup->wrist}, 1.0 / 80.0);
            CHECK(grasp.held);
            for (int i = 0; i < 40; ++i)
                update_grasp(grasp, {}, setup->tool, setup->wearer.hand,
                             {true, hand::closed_hand_angles(0.0), setup->wrist}, 1.0 / 80.0);
            CHECK(!grasp.held);
            const hand::Skeleton joints =
                hand::joints(setup->wearer.hand, hand::closed_hand_angles(0.0), setup->wrist);
            CHECK(joints.position[hand::thumb_tip].x < joints.position[hand::little_tip].x);
            CHECK(joints.position[hand::palm].z > 0.0);
        }
}
