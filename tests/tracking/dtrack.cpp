// DTrack's packets, and their reception over UDP.
#include "engine/tracking/dtrack.hpp"

#include <doctest/doctest.h>

#include <string>

#include "engine/base/random.hpp"
#include "engine/tracking/dtrack_receiver.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/replaced.hpp"
#include "tests/tracking/sender.hpp"

namespace dtrack_test {

using namespace bolt;
using namespace bolt::tracking;
using test::replaced;

namespace {

// The packet of ART's documentation: body 0 is turned by about 160 degrees, body 2 stands upright.
const std::string packet =
    "fr 21753\r\n"
    "ts 39596.024831\r\n"
    "6dcal 3\r\n"
    "6d 2 [0 1.000][326.848 -187.216 109.503 -160.4704 -3.6963 -7.0913][-0.940508 -0.339238 -0.019025 "
    "0.333599 -0.932599 0.137735 -0.064467 0.123194 0.990286] [2 0.512][1000.0 2000.0 -500.0 0.0 0.0 "
    "0.0][1.000000 0.000000 0.000000 0.000000 1.000000 0.000000 0.000000 0.000000 1.000000] \r\n";

std::string frame_text(int number) {
    return "fr " + std::to_string(number) + "\n6d 1 [0 1.0][" + std::to_string(number) +
           " 0 0 0 0 0][1 0 0 0 1 0 0 0 1]\n";
}

DtrackFrame parsed(const std::string& text) {
    const auto frame = parse_dtrack(text);
    REQUIRE_MESSAGE(frame, text);
    return *frame;
}

DtrackReceiver opened() {
    auto receiver = DtrackReceiver::open(0);
    if (!receiver) FAIL(receiver.error().message());
    return std::move(*receiver);
}

// The receiver has counted `packets` packets; returns the newest frame of all polls.
std::optional<DtrackFrame> received(DtrackReceiver& receiver, std::uint64_t packets) {
    std::optional<DtrackFrame> newest;
    CHECK(test::eventually([&] {
        if (auto frame = receiver.poll()) newest = std::move(frame);
        return receiver.counts().good_packets + receiver.counts().malformed_packets >= packets;
    }));
    return newest;
}

}  // namespace

TEST_CASE("DTrack: flysticks of both kinds of lines have a pose, buttons and a stick") {
    const std::string matrix = "[0 -1 0 1 0 0 0 0 1]";  // columns: a turn by -90 degrees about z
    const DtrackFrame frame = parsed("fr 7\r\n6df2 3 2 [0 1.000 6 2][100.0 200.0 -300.0]" + matrix +
                                     "[5 0.25 -2.00] [1 -1.000 8 0][0 0 0][0 0 0 0 0 0 0 0 0][-128] \r\n");
    REQUIRE(frame.flysticks.size() == 2);
    const DtrackFlystick* first = find_flystick(frame, 0);
    REQUIRE(first != nullptr);
    REQUIRE(first->pose);
    CHECK(glm::length(first->pose->position - Vec3(0.1, 0.2, -0.3)) < 1e-12);
    CHECK(glm::length(first->pose->orientation * Vec3(1, 0, 0) - Vec3(0, -1, 0)) < 1e-12);
    CHECK(first->buttons == 5U);
    CHECK(first->stick_x == 0.25);
    CHECK(first->stick_y == -1.0);
    // The cameras do not see the second one, but its buttons arrive.
    const DtrackFlystick* second = find_flystick(frame, 1);
    REQUIRE(second != nullptr);
    CHECK_FALSE(second->pose);
    CHECK(second->buttons == 0xFFFFFF80U);
    CHECK(find_flystick(frame, 2) == nullptr);
    CHECK(frame.invalid_bodies == 0);
    const DtrackFrame old = parsed("fr 7\n6df 1 [2 0.9 3][1 2 3 0 0 0]" + matrix + "\n");
    REQUIRE(find_flystick(old, 2) != nullptr);
    CHECK(find_flystick(old, 2)->buttons == 3U);
    const DtrackFrame negative = parsed("fr 7\n6df 1 [2 0.9 -128][1 2 3 0 0 0]" + matrix + "\n");
    REQUIRE(find_flystick(negative, 2) != nullptr);
    CHECK(find_flystick(negative, 2)->buttons == 0xFFFFFF80U);
    CHECK(find_flystick(old, 2)->pose->position == Vec3(1, 2, 3) * mm);
    CHECK(parsed("fr 1\n6df2 4 0\n").flysticks.empty());
    // More than 32 buttons are in several integers.
    const DtrackFrame many = parsed("fr 1\n6df2 1 1 [0 1 40 1][0 0 0][1 0 0 0 1 0 0 0 1][2 1 0.5]\n");
    CHECK(many.flysticks[0].buttons == 2U);
    CHECK(many.flysticks[0].stick_x == 0.5);
    CHECK(parsed("fr 1\n6df2 1 1 [0 1 2 0][0 0 0][2 0 0 0 1 0 0 0 1][0]\n").invalid_bodies == 1);
    for (const char* damaged :
         {"6df2 1 1 [0 1 2 2][0 0 0][1 0 0 0 1 0 0 0 1][0 0]",
          "6df2 1 1 [0 1 2][0 0 0][1 0 0 0 1 0 0 0 1][0]", "6df2 1 1 [0 1 2 0][0 0][1 0 0 0 1 0 0 0 1][0]",
          "6df2 1 2 [0 1 2 0][0 0 0][1 0 0 0 1 0 0 0 1][0]", "6df2 1",
          "6df2 1 1 [0 1 -2 0][0 0 0][1 0 0 0 1 0 0 0 1][]",
          "6df2 1 1 [0 1 2 1][0 0 0][1 0 0 0 1 0 0 0 1][0 nan]",
          "6df 1 [0 1][0 0 0 0 0 0][1 0 0 0 1 0 0 0 1]",
          "6df2 1 1 [0 1 99999 0][0 0 0][1 0 0 0 1 0 0 0 1][0]"})
        CHECK_MESSAGE(!parse_dtrack(std::string("fr 1\n") + damaged + "\n"), damaged);
}

TEST_CASE("DTrack: a packet with two bodies is read in metres, its matrix by columns") {
    const DtrackFrame frame = parsed(packet);
    CHECK(frame.number == 21753);
    CHECK(frame.time == 39596.024831);
    CHECK(frame.calibrated_bodies == 3);
    REQUIRE(frame.bodies.size() == 2);
    CHECK(frame.invalid_bodies == 0);
    const DtrackBody* head = find_body(frame, 0);
    REQUIRE(head != nullptr);
    CHECK(head->quality == 1.0);
    CHECK(glm::length(head->pose.position - Vec3(0.326848, -0.187216, 0.109503)) < 1e-12);
    // The first three numbers are the body's x axis in the room, and so on.
    CHECK(glm::length(head->pose.orientation * Vec3(1, 0, 0) - Vec3(-0.940508, -0.339238, -0.019025)) < 1e-5);
    CHECK(glm::length(head->pose.orientation * Vec3(0, 1, 0) - Vec3(0.333599, -0.932599, 0.137735)) < 1e-5);
    CHECK(glm::length(head->pose.orientation * Vec3(0, 0, 1) - Vec3(-0.064467, 0.123194, 0.990286)) < 1e-5);
    CHECK(std::abs(glm::length(head->pose.orientation) - 1.0) < 1e-12);
    CHECK(find_body(frame, 2)->pose.position == Vec3(1.0, 2.0, -0.5));
    CHECK(find_body(frame, 1) == nullptr);  // known to the tracker, but not seen
}

TEST_CASE("DTrack: any rotation is read from its matrix, also with three digits") {
    Random random(5);
    for (int i = 0; i < 200; ++i) {
        const Quat turn = random_turn(random);
        for (const int digits : {6, 3}) {
            std::string text = "fr 1\n6d 1 [0 1.0][0 0 0 0 0 0][";
            for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)})
                for (int k = 0; k < 3; ++k) {
                    char number[32];
                    (void)std::snprintf(number, sizeof number, "%.*f ", digits, (turn * axis)[k]);
                    text += number;
                }
            const DtrackFrame frame = parsed(text + "]\n");
            REQUIRE(frame.bodies.size() == 1);
            CHECK(glm::length(turn_between(turn, frame.bodies[0].pose.orientation)) <
                  (digits == 6 ? 5e-6 : 2e-3));
        }
    }
}

TEST_CASE("DTrack: packets without bodies, without a time, and with lines of other devices are good") {
    CHECK(parsed("fr 5").bodies.empty());
    CHECK(parsed("fr 5\n6d 0 \n").bodies.empty());
    CHECK_FALSE(parsed("fr 5\n").time);
    CHECK(parsed("ts 1.5\r\nfr 4294967295\r\n").number == 4294967295U);
    const DtrackFrame frame = parsed(packet +
                                     "ts2 1700000000 123456 789 12345\r\n"
                                     "6df2 1 1 [0 -1.0 8 2][0 0 0][0 0 0 0 0 0 0 0 0][0 0.0 0.0]\r\n"
                                     "6df 1 [0 -1.000 0][0 0 0 0 0 0][0 0 0 0 0 0 0 0 0]\r\n"
                                     "3d 1 [210 1.000][3.5 -190.2 96.5]\r\n"
                                     "6dmt 1 [0 1.0 0][1 2 3][1 0 0 0 1 0 0 0 1]\r\n"
                                     "glcal 0\r\ngl 0\r\n\xff\xfe garbage of a later version\r\n");
    CHECK(frame.bodies.size() == 2);
}

TEST_CASE("DTrack: a body that is not seen is no body") {
    CHECK(parsed("fr 1\n6d 1 [0 -1.000][0 0 0 0 0 0][0 0 0 0 0 0 0 0 0]").bodies.empty());
    CHECK(parsed("fr 1\n6d 1 [0 -1.000][0 0 0 0 0 0][0 0 0 0 0 0 0 0 0]").invalid_bodies == 0);
}

TEST_CASE("DTrack: a body whose values are no pose is refused, and the others are kept") {
    const auto refused = [](const std::string& from, const std::string& to) {
        const DtrackFrame frame = parsed(replaced(packet, from, to));
        CHECK(frame.bodies.size() == 1);
        CHECK(find_body(frame, 2) != nullptr);
        CHECK(frame.invalid_bodies == 1);
    };
    refused("326.848", "nan");
    refused("326.848", "inf");
    refused("326.848", "1e300");
    refused("326.848", "1000001");  // more than 1 km
    refused("-0.940508", "nan");
    refused("-0.940508", "0.940508");  // no rotation
    refused("0.990286", "-0.990286");
    refused("[-0.940508 -0.339238 -0.019025", "[0 0 0");
    refused("[0 1.000]", "[0 nan]");
    // A reflection has unit columns at right angles.
    CHECK(parsed("fr 1\n6d 1 [0 1][0 0 0 0 0 0][-1 0 0 0 1 0 0 0 1]").invalid_bodies == 1);
}

TEST_CASE("DTrack: damaged packets are refused as a whole") {
    for (const std::string text : {"",
                                   "\n",
                                   "garbage",
                                   "fr",
                                   "fr x",
                                   "fr -1",
                                   "fr 99999999999",
                                   "fr 1 2",
                                   "fr 1\nfr 2",
                                   "6d 0\n",
                                   "fr 1\nts",
                                   "fr 1\nts x",
                                   "fr 1\nts nan",
                                   "fr 1\n6dcal",
                                   "fr 1\n6d",
                                   "fr 1\n6d 1",
                                   "fr 1\n6d -1",
                                   "fr 1\n6d 1000000 [0 1.0]",
                                   "fr 1\n6d 2 [0 1][0 0 0 0 0 0][1 0 0 0 1 0 0 0 1]",
                                   "fr 1\n6d 1 [0 1][0 0 0 0 0 0][1 0 0 0 1 0 0 0 1] x",
                                   "fr 1\n6d 1 [0 1][0 0 0 0 0][1 0 0 0 1 0 0 0 1]",
                                   "fr 1\n6d 1 [0 1][0 0 0 0 0 0 0][1 0 0 0 1 0 0 0 1]",
                                   "fr 1\n6d 1 [0 1][0 0 0 0 0 0][1 0 0 0 1 0 0 0 1 0]",
                                   "fr 1\n6d 1 [0.5 1][0 0 0 0 0 0][1 0 0 0 1 0 0 0 1]",
                                   "fr 1\n6d 1 (0 1)(0 0 0 0 0 0)(1 0 0 0 1 0 0 0 1)"})
        CHECK_MESSAGE(!parse_dtrack(text), text);
}

TEST_CASE("DTrack: a packet that is cut anywhere gives the whole line or nothing of it") {
    const std::size_t line = packet.find("6d 2 ");
    for (std::size_t size = 0; size < packet.size(); ++size) {
        const auto frame = parse_dtrack(packet.substr(0, size));
        // Without its last bracket the line of the bodies is cut.
        if (size > line + 2 && size < packet.size() - 3) CHECK_MESSAGE(!frame, size);
        if (frame) CHECK((frame->bodies.empty() || frame->bodies.size() == 2));
    }
}

TEST_CASE("DTrack: any bytes give a valid frame or none") {
    Random random(17);
    int good = 0;
    for (int i = 0; i < 20000; ++i) {
        std::string text = packet;
        const int changes = 1 + static_cast<int>(random.uniform(0.0, 4.0));
        for (int k = 0; k < changes; ++k)
            text[static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(text.size())))] =
                static_cast<char>(random.bits());
        const auto frame = parse_dtrack(text);
        if (!frame) continue;
        ++good;
        for (const DtrackBody& body : frame->bodies) {
            CHECK(finite(body.pose.position));
            CHECK(std::abs(glm::length(body.pose.orientation) - 1.0) < 1e-9);
        }
    }
    CHECK(good > 300);
    CHECK(good < 19000);
}

TEST_CASE("DTrack: the newest frame of those that arrived on the UDP port is returned") {
    DtrackReceiver receiver = opened();
    CHECK(receiver.port() > 0);
    CHECK_FALSE(receiver.poll());
    const test::UdpSender sender(receiver.port());
    for (int i = 1; i <= 3; ++i) sender.send(frame_text(i));
    const auto frame = received(receiver, 3);
    REQUIRE(frame);
    CHECK(frame->number == 3);
    CHECK(frame->bodies.at(0).pose.position.x == doctest::Approx(0.003));
    CHECK(receiver.counts().good_packets == 3);
    CHECK_FALSE(receiver.poll());
}

TEST_CASE("DTrack: damaged, empty and too long packets are counted and harm nothing") {
    DtrackReceiver receiver = opened();
    const test::UdpSender sender(receiver.port());
    sender.send("garbage");
    sender.send("");
    sender.send(frame_text(7) + std::string(max_dtrack_packet, ' '));
    sender.send(frame_text(8));
    const auto frame = received(receiver, 4);
    REQUIRE(frame);
    CHECK(frame->number == 8);
    CHECK(receiver.counts().good_packets == 1);
    CHECK(receiver.counts().malformed_packets == 3);
    sender.send("fr 9\n6d 1 [0 1][nan 0 0 0 0 0][1 0 0 0 1 0 0 0 1]");
    CHECK(received(receiver, 5)->bodies.empty());
    CHECK(receiver.counts().invalid_bodies == 1);
}

TEST_CASE("DTrack: an overtaken or repeated packet is dropped, and a restarted tracker is followed") {
    DtrackReceiver receiver = opened();
    const test::UdpSender sender(receiver.port());
    sender.send(frame_text(5000));
    CHECK(received(receiver, 1)->number == 5000);
    sender.send(frame_text(4999));
    sender.send(frame_text(5000));
    CHECK_FALSE(received(receiver, 3));
    CHECK(receiver.counts().late_packets == 2);
    sender.send(frame_text(1));  // the measurement was started again
    CHECK(received(receiver, 4)->number == 1);
    sender.send(frame_text(2));
    CHECK(received(receiver, 5)->number == 2);
    // The number wraps at 2^32.
    sender.send("fr 4294967000\n");
    CHECK(received(receiver, 6)->number == 4294967000U);
    sender.send("fr 4294967295\n");
    CHECK(received(receiver, 7)->number == 4294967295U);
    sender.send("fr 0\n");
    CHECK(received(receiver, 8)->number == 0);
    sender.send("fr 4294967295\n");
    CHECK_FALSE(received(receiver, 9));
}

TEST_CASE("DTrack: a poll reads a bounded number of packets") {
    DtrackReceiver receiver = opened();
    const test::UdpSender sender(receiver.port());
    for (int i = 1; i <= max_packets_per_poll + 10; ++i) sender.send(frame_text(i));
    (void)receiver.poll();
    CHECK(receiver.counts().good_packets <= static_cast<std::uint64_t>(max_packets_per_poll));
}

TEST_CASE("DTrack: a port that another program has, and a number that is none, are errors") {
    const DtrackReceiver first = opened();
    const auto second = DtrackReceiver::open(first.port());
    REQUIRE_FALSE(second);
    CHECK(second.error().code == ErrorCode::no_device);
    CHECK(second.error().message().find("UDP port " + std::to_string(first.port())) == 0);
    CHECK_FALSE(DtrackReceiver::open(70000));
    CHECK_FALSE(DtrackReceiver::open(-1));
}

}  // namespace dtrack_test
