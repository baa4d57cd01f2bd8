// The head from the tracker of a display file: DTrack on this machine, recorded poses, poses that are added.
#include "game/head_tracking/head_source.hpp"

#include <doctest/doctest.h>

#include "engine/base/file.hpp"
#include "tests/displays/support.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/folder.hpp"
#include "tests/tracking/sender.hpp"

namespace head_source_test {

using namespace bolt;
using bolt::head_tracking::HeadSource;
using content::HeadTracker;
using content::HeadTracking;
using tracking::HeadStatus;

namespace {

HeadSource opened(const HeadTracking& head, const std::filesystem::path& folder = {}) {
    auto source = HeadSource::open(head, folder);
    if (!source) FAIL(source.error().message());
    return std::move(*source);
}

std::string packet(int number, int body, double x_mm) {
    return "fr " + std::to_string(number) + "\r\n6d 1 [" + std::to_string(body) + " 1.0][" +
           std::to_string(x_mm) + " 0 1700 0 0 0][1 0 0 0 1 0 0 0 1]\r\n";
}

}  // namespace

TEST_CASE("Head source: without a tracker the head is fixed") {
    HeadTracking head;
    head.fixed_head.position = {0.1, 1.5, 0.2};
    HeadSource source = opened(head);
    for (const double now : {0.0, 1.0, 100.0}) {
        CHECK(source.at(now).pose.position == Vec3(0.1, 1.5, 0.2));
        CHECK(source.at(now).status == HeadStatus::faded);
    }
    CHECK(source.counts().samples == 0);
}

TEST_CASE("Head source: the tracked body of DTrack is the head, in the axes of the room") {
    HeadTracking head;
    head.tracker = HeadTracker::dtrack;
    head.port = 0;  // a free one
    head.body = 3;
    head.axes = {{{0, false}, {2, false}, {1, true}}};  // its z is up
    head.head_in_body.position = {0.0, -0.05, 0.0};
    HeadSource source = opened(head);
    const test::UdpSender sender(source.port());
    double now = 10.0;
    CHECK(source.at(now).status == HeadStatus::faded);
    for (int i = 1; i <= 60; ++i) {
        sender.send(packet(i, 3, 100.0));
        now += 1.0 / 60.0;
        CHECK(test::eventually([&] {
            (void)source.at(now);
            return source.counts().samples == static_cast<std::uint64_t>(i);
        }));
    }
    CHECK(source.at(now).status == HeadStatus::tracked);
    CHECK(glm::length(source.at(now).pose.position - Vec3(0.1, 1.65, 0.0)) < 1e-9);
    // Another body is not the head.
    sender.send(packet(61, 1, 500.0));
    now += 0.2;
    CHECK(test::eventually([&] {
        (void)source.at(now);
        return source.counts().dtrack.good_packets == 61;
    }));
    CHECK(source.at(now).status == HeadStatus::held);
    CHECK(source.at(now).pose.position.x == doctest::Approx(0.1));
    CHECK(source.counts().bodies == std::vector<int>{1, 3});
    CHECK(source.counts().samples == 60);
    now += 10.0;
    CHECK(glm::length(source.at(now).pose.position - head.fixed_head.position) < 1e-9);
}

TEST_CASE("Head source: recorded poses are played once from the first call on, and end at the fixed head") {
    const test::Folder folder;
    std::string text = "t_s,x_m,y_m,z_m,qw,qx,qy,qz\n";
    for (int i = 0; i < 100; ++i)
        text += std::to_string(50.0 + 0.01 * i) + "," + std::to_string(0.002 * i) + ",1.6,0,1,0,0,0\n";
    REQUIRE(write_file(folder / "walk.csv", text));
    HeadTracking head;
    head.tracker = HeadTracker::file;
    head.recording = "walk.csv";
    HeadSource source = opened(head, folder.path());
    for (int i = 0; i < 50; ++i) (void)source.at(1000.0 + 0.01 * i + 0.001);
    CHECK(source.at(1000.5).pose.position.x == doctest::Approx(0.1).epsilon(0.05));
    CHECK(source.at(1000.5).status == HeadStatus::tracked);
    for (int i = 0; i < 50; ++i) (void)source.at(1000.501 + 0.01 * i);
    CHECK(source.counts().samples == 100);
    CHECK(source.at(1010.0).status == HeadStatus::faded);
    head.recording = "none.csv";
    const auto missing = HeadSource::open(head, folder.path());
    REQUIRE_FALSE(missing);
    CHECK(displays_test::has(missing.error().message(), "none.csv"));
}

TEST_CASE("Head source: poses that the caller adds are those of the tracked body") {
    HeadTracking head;
    head.scale = 2.0;
    head.tracker_in_room.position = {0.0, 1.0, 0.0};
    HeadSource source = opened(head);
    source.add_sample({5.0, {{0.1, 0.2, 0.3}, {1, 0, 0, 0}}});
    const auto shown = source.at(5.0);
    CHECK(shown.status == HeadStatus::tracked);
    CHECK(glm::length(shown.pose.position - Vec3(0.2, 1.4, 0.6)) < 1e-12);
}

TEST_CASE("Head source: a port that another program has is an error") {
    HeadTracking head;
    head.tracker = HeadTracker::dtrack;
    head.port = 0;
    const HeadSource first = opened(head);
    head.port = first.port();
    const auto second = HeadSource::open(head, {});
    REQUIRE_FALSE(second);
    CHECK(second.error().code == ErrorCode::no_device);
}

TEST_CASE("Head source: a flystick points in the room, and is gone when DTrack sends it no more") {
    HeadTracking head;
    head.tracker = HeadTracker::dtrack;
    head.port = 0;
    head.axes = {{{0, false}, {2, false}, {1, true}}};  // its z is up
    content::Flystick& flystick = head.flystick.emplace();
    flystick.id = 1;
    flystick.aim_in_body.position = {0.0, 0.0, -0.1};
    flystick.select = 4;
    flystick.menu = 0;
    HeadSource source = opened(head);
    const test::UdpSender sender(source.port());
    CHECK_FALSE(source.at(1.0).status == HeadStatus::tracked);
    CHECK_FALSE(source.wand());
    const auto send = [&](int number, const char* quality, int buttons) {
        sender.send("fr " + std::to_string(number) + "\r\n6df2 2 1 [1 " + quality +
                    " 8 2][500 200 1200][1 0 0 0 1 0 0 0 1][" + std::to_string(buttons) + " 0.5 -0.25]\r\n");
        const std::uint64_t before = source.counts().dtrack.good_packets;
        CHECK(test::eventually([&] {
            (void)source.at(1.0);
            return source.counts().dtrack.good_packets > before;
        }));
    };
    send(1, "1.0", 8);
    REQUIRE(source.wand());
    REQUIRE(source.wand()->aim);
    // Up in the room is the tracker's z; the viewer's forward is its y.
    CHECK(glm::length(source.wand()->aim->position - Vec3(0.5, 1.2, -0.3)) < 1e-12);
    CHECK(glm::length(source.wand()->aim->orientation * Vec3(0, 0, -1) - Vec3(0, 0, -1)) < 1e-12);
    CHECK(source.wand()->select);
    CHECK_FALSE(source.wand()->menu);
    CHECK_FALSE(source.wand()->tool);
    CHECK(source.wand()->stick_x == 0.5);
    CHECK(source.wand()->stick_y == -0.25);
    send(2, "-1.0", 4);
    REQUIRE(source.wand());
    CHECK_FALSE(source.wand()->aim);
    CHECK_FALSE(source.wand()->select);
    CHECK(source.wand()->tool);
    (void)source.at(1.05);
    CHECK(source.wand());
    (void)source.at(1.2);
    CHECK_FALSE(source.wand());
}

}  // namespace head_source_test
