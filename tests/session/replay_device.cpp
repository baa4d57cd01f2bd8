#include "game/session/replay.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "haptics/station/station_tick.hpp"
#include "tests/servo/support.hpp"
#include "tests/session/support.hpp"

using namespace bolt;
using namespace bolt::session;
using namespace bolt::session::test;

namespace {

constexpr std::size_t count = 2500;

// A hand that moves and turns, sends no sample in every seventh tick, and releases at the end.
servo::TickInput hand_at(std::size_t i) {
    const double t = 1e-3 * static_cast<double>(i);
    const Quat q = rotation(Vec3(0.2 * std::sin(3.0 * t), t, 0.1));
    servo::TickInput input;
    input.commanded_tool.position[0] = static_cast<float>(0.1 * std::sin(t));
    input.commanded_tool.position[1] = static_cast<float>(0.3 + 0.05 * t);
    input.commanded_tool.orientation[0] = static_cast<float>(q.w);
    input.commanded_tool.orientation[1] = static_cast<float>(q.x);
    input.commanded_tool.orientation[2] = static_cast<float>(q.y);
    input.commanded_tool.orientation[3] = static_cast<float>(q.z);
    input.fresh = i % 7 != 6;
    input.dead_man = i < 2000;
    return input;
}

void record_hand(const std::filesystem::path& file) {
    auto writer = SessionWriter::create(file, sample_header(1e-3));
    REQUIRE(writer);
    for (std::size_t i = 0; i < count; ++i) REQUIRE(writer->append(make_record(hand_at(i), servo::Output{})));
    REQUIRE(writer->finish({}));
}

}  // namespace

TEST_CASE("Replay device: a recorded hand repeats its motion, grip and release in a station") {
    const Folder folder;
    record_hand(folder / "a.session");
    const auto reader = SessionReader::open(folder / "a.session");
    REQUIRE(reader);
    const auto hand = replay_device(*reader);
    REQUIRE(hand);
    CHECK(hand->description.rate == 1000.0);

    device::VirtualTime time;
    device::DeviceSupervisor supervisor(
        device::recorded(hand->description, hand->recording, device::virtual_timer(time)),
        device::virtual_timer(time));
    device::DeviceMailboxes mailboxes;
    device::DeviceSnapshot snapshot;
    station::DeviceLayout layout;
    layout.mover = hand->description;
    layout.mover_buttons = {button_dead_man, 0, button_stop, button_reset};
    layout.home = hand->first;
    const servo::Setup setup = bolt::test::two_joints(station::limits_of(layout));
    station::StationState state = station::initial_state(layout);
    std::size_t next = 0;
    while (time.now < 1e-3 * count) {
        device::run_once(supervisor, mailboxes, snapshot);
        station::StationInputs inputs;
        mailboxes.snapshots.update();
        inputs.mover = mailboxes.snapshots.latest();
        const servo::TickInput input = station::read_inputs(layout, setup, state, inputs);
        if (!input.fresh || next >= count) continue;
        const servo::TickInput was = hand_at(next);
        for (int k = 0; k < 3; ++k)
            REQUIRE(std::abs(input.commanded_tool.position[k] - was.commanded_tool.position[k]) < 1e-6F);
        for (int k = 0; k < 4; ++k)
            REQUIRE(std::abs(input.commanded_tool.orientation[k] - was.commanded_tool.orientation[k]) <
                    1e-6F);
        REQUIRE(input.dead_man == was.dead_man);
        do {
            ++next;
        } while (!hand_at(next).fresh);
    }
    CHECK(next >= count);
}

TEST_CASE("Replay device: a session without ticks is refused") {
    const Folder folder;
    auto writer = SessionWriter::create(folder / "a.session", sample_header(1e-3));
    REQUIRE(writer);
    REQUIRE(writer->finish({}));
    const auto reader = SessionReader::open(folder / "a.session");
    REQUIRE(reader);
    const auto none = replay_device(*reader);
    REQUIRE_FALSE(none);
    CHECK(none.error().message().find("no tick with a fresh device sample") != std::string::npos);
}
