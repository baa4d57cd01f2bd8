// What somebody asks for becomes a station, or words about what is wrong with it.
#include "game/station/plan.hpp"

#include <doctest/doctest.h>

#include <filesystem>

#include "content/format/load.hpp"
#include "engine/base/file.hpp"
#include "haptics/device/puck.hpp"
#include "haptics/hand/closing.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/folder.hpp"
#include "tools/emulate/glove_line.hpp"

using namespace bolt;
using namespace bolt::station;
using test::Folder;

namespace {

content::Assembly assembly(const std::string& name) {
    content::Loaded loaded = content::load_assembly(name);
    REQUIRE(loaded.ok());
    return std::move(loaded.assembly);
}

std::string wrong(const content::Assembly& what, const Wanted& wanted) {
    const Result<Planned> planned = make_plan(what, wanted);
    return planned ? "" : planned.error().message();
}

content::GloveCalibration calibration(glove::Hand hand, std::size_t sensors) {
    content::GloveCalibration c;
    c.trainee = "Ada";
    c.hand = hand;
    c.sensors = sensors;
    c.date = "2026-11-22";
    c.quality = 0.9;
    for (const glove::Sensor sensor : glove::sensors_of(sensors))
        c.calibration.lines[glove::index(sensor)] = glove::Line{0.0125, 40.0};
    return c;
}

}  // namespace

TEST_CASE(
    "every assembly that is shipped: the wrench begins on the nut, holds it, and stays where it is put") {
    for (const std::string name : {"cover-m8", "dn200-pn16", "zq350"})
        for (const bool tight : {false, true}) {
            CAPTURE(name);
            CAPTURE(tight);
            const content::Assembly what = assembly(name);
            Wanted wanted;
            wanted.tight = tight;
            Result<Planned> planned = make_plan(what, wanted);
            REQUIRE_MESSAGE(planned, (planned ? "" : planned.error().message()));
            CHECK(planned->obstacles);
            const servo::Setup setup = planned->plan.setup({}, 1e-3);
            Result<servo::State> state = planned->plan.state(setup);
            REQUIRE(state);
            CHECK(state->touch.has_value());
            servo::Input input;
            input.device = servo::sample_of(planned->plan.home);
            input.enabled = true;
            input.grip = servo::Grip::wrench;
            servo::Output output;
            for (int i = 0; i < 700; ++i) output = servo::tick(setup, *state, input);
            CHECK(output.joint == 0);
            CHECK(glm::length(output.tool.position - planned->plan.home.position) < 0.5e-3);
            CHECK(glm::length(output.force) < 1.0);
            CHECK((output.clamp > 1000.0) == tight);
        }
}

TEST_CASE("a plan without obstacles, on another nut") {
    const content::Assembly what = assembly("cover-m8");
    Wanted wanted;
    wanted.obstacles = false;
    wanted.joint = 2;
    Result<Planned> planned = make_plan(what, wanted);
    REQUIRE(planned);
    CHECK(!planned->obstacles);
    const servo::Setup setup = planned->plan.setup({}, 1e-3);
    Result<servo::State> state = planned->plan.state(setup);
    REQUIRE(state);
    servo::Input input;
    input.device = servo::sample_of(planned->plan.home);
    input.grip = servo::Grip::wrench;
    input.enabled = true;
    servo::tick(setup, *state, input);
    CHECK(servo::tick(setup, *state, input).joint == 2);
}

TEST_CASE("a plan can be started: with no device chosen, what stands in for it moves the tool") {
    const content::Assembly what = assembly("cover-m8");
    device::Puck mouse({}, device::steady_timer());
    Wanted wanted;
    wanted.otherwise = mouse.open();
    Result<Planned> planned = make_plan(what, wanted);
    REQUIRE(planned);
    planned->plan.line.priority = planned->plan.servo.priority = 0;
    planned->plan.servo.lock_memory = false;
    planned->plan.patience = 60.0;
    Result<Station> station = Station::start(std::move(planned->plan));
    REQUIRE_MESSAGE(station, (station ? "" : station.error().message()));
    Wishes wishes;
    wishes.grip = servo::Grip::wrench;
    wishes.held = true;
    station->wish(wishes);
    REQUIRE(test::eventually([&] { return station->newest().output.joint == 0; }));
    REQUIRE(test::eventually([&] { return station->passed().mover.samples > 10; }));
    CHECK(station->mover()->description->name == "mouse and keyboard");
    CHECK(station->wheel() == nullptr);
    CHECK(station->gloved() == nullptr);
}

TEST_CASE("what is wrong with a plan is said before anything is opened") {
    const content::Assembly what = assembly("cover-m8");
    CHECK(wrong(what, {.devices = {"256f:0000"}}).find("boltwright devices") != std::string::npos);
    const Folder folder;
    const auto rig = folder / "rig.json";
    REQUIRE(write_file(rig, "{\"format\": \"boltwright rig 1\", \"most_torque_Nm\": 400}"));
    CHECK(wrong(what, {.rig = rig}).find("rig.json:1:") != std::string::npos);
    CHECK(wrong(what, {.glove = "/dev/null"}).find("no serial port") != std::string::npos);
    CHECK(wrong(what, {.glove = folder / "none"}).find("adapter plugged in?") != std::string::npos);
    content::Assembly bare = assembly("cover-m8");
    bare.wrench.model.clear();
    CHECK(!hand_plan(bare, calibration(glove::Hand::right, 22)));
}

TEST_CASE("a glove's hand is the trainee's whose calibration is kept, of that hand and that many sensors") {
    const content::Assembly what = assembly("cover-m8");
    const Folder folder;
    auto line = emulate::GloveLine::start({.sensors = 22, .hand = glove::Hand::left});
    REQUIRE(line);
    Wanted wanted;
    wanted.glove = line->port();
    CHECK(!make_plan(what, wanted)->plan.hand);
    wanted.trainee = "Ada";
    wanted.calibrations = folder.path();
    const auto keep = [&](glove::Hand hand, std::size_t sensors) {
        REQUIRE(content::save_glove_calibration(content::glove_calibration_path(folder.path(), "Ada", hand),
                                                calibration(hand, sensors)));
    };
    keep(glove::Hand::right, 22);
    CHECK(wrong(what, wanted).find("no calibration of Ada's left hand") != std::string::npos);
    CHECK(wrong(what, wanted).find("boltwright glove calibrate --trainee \"Ada\"") != std::string::npos);
    keep(glove::Hand::left, 18);
    CHECK(wrong(what, wanted).find("with 18 sensors, and this one has 22") != std::string::npos);
    keep(glove::Hand::left, 22);
    const Result<Planned> planned = make_plan(what, wanted);
    REQUIRE_MESSAGE(planned, (planned ? "" : planned.error().message()));
    REQUIRE(planned->plan.hand);
    CHECK(planned->plan.hand->wearer.hand.side == hand::Side::left);
    CHECK(planned->worn->date == "2026-11-22");
    CHECK(planned->glove == line->port());
}

TEST_CASE("either hand takes every wrench that is shipped where it lies in it, the thumb towards the jaw") {
    for (const std::string name : {"cover-m8", "dn200-pn16", "zq350"})
        for (const glove::Hand side : {glove::Hand::left, glove::Hand::right}) {
            CAPTURE(name);
            CAPTURE(static_cast<int>(side));
            const Result<HandPlan> plan = hand_plan(assembly(name), calibration(side, 22));
            REQUIRE(plan);
            grip::Grip grip;
            for (int i = 0; i < 8; ++i)
                step(grip, {}, plan->tool, plan->wearer.hand, {true, hand::closing(1.0), plan->wrist},
                     1.0 / 80.0);
            CHECK(grip.held);
            for (int i = 0; i < 40; ++i)
                step(grip, {}, plan->tool, plan->wearer.hand, {true, hand::closing(0.0), plan->wrist},
                     1.0 / 80.0);
            CHECK(!grip.held);
            const hand::Skeleton joints = hand::joints(plan->wearer.hand, hand::closing(0.0), plan->wrist);
            CHECK(joints.position[hand::thumb_tip].x < joints.position[hand::little_tip].x);
            CHECK(joints.position[hand::palm].z > 0.0);
        }
}
