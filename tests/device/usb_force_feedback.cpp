#include "haptics/device/usb_force_feedback.hpp"

#include <doctest/doctest.h>

#include "haptics/device/connected_devices.hpp"
#include "haptics/device/wheel.hpp"
#include "tests/device/descriptors.hpp"
#include "tools/emulate/puck.hpp"
#include "tools/emulate/wheel.hpp"

using namespace bolt;
using namespace bolt::device;
using namespace bolt::test;

namespace {

using Bytes = std::vector<std::uint8_t>;

ReportDescriptor parsed(const Bytes& bytes) {
    Result<ReportDescriptor> d = parse_report_descriptor(bytes);
    REQUIRE_MESSAGE(d, (d ? "" : d.error().message()));
    return std::move(*d);
}

}  // namespace

TEST_CASE("UsbForceFeedback: messages for an OpenFFBoard match its firmware byte for byte") {
    auto layout = force_feedback_layout(parsed(emulate::board_descriptor()));
    REQUIRE(layout);
    CHECK(layout->reset.bytes == Bytes{12, 0x08});
    CHECK(layout->stop_all.bytes == Bytes{12, 0x04});
    CHECK(layout->enable.bytes == Bytes{12, 0x01});
    CHECK(layout->gain.bytes == Bytes{13, 255});
    CHECK(layout->create.kind == ReportKind::feature);
    CHECK(layout->create.bytes == Bytes{17, 1, 0, 0});
    CHECK(layout->block_load.bytes.size() == 5);
    select_block(*layout, 3);
    CHECK(layout->start.bytes == Bytes{10, 3, 1, 1});
    CHECK(layout->stop.bytes == Bytes{10, 3, 3, 0});
    CHECK(layout->free.bytes == Bytes{11, 3});
    // Constant force: duration 1 s, no delay, full gain, no trigger button, direction 90 degrees.
    const unsigned direction = 35900 / 4;
    CHECK(layout->set_effect.bytes == Bytes{1, 3, 1, 0xe8, 0x03, 0, 0, 0, 0, 0, 0, 255, 0, 0x01 | 0x04,
                                            static_cast<std::uint8_t>(direction),
                                            static_cast<std::uint8_t>(direction >> 8U), 0, 0});
    set_magnitude(*layout, 1.0);
    CHECK(layout->set_force.bytes == Bytes{5, 3, 0xff, 0x7f});
    set_magnitude(*layout, -2.0);
    CHECK(layout->set_force.bytes == Bytes{5, 3, 0x01, 0x80});
    set_magnitude(*layout, 0.0);
    CHECK(layout->set_force.bytes == Bytes{5, 3, 0, 0});

    CHECK(*parse_block_load(*layout, Bytes{18, 7, 1, 0, 0}) == 7);
    CHECK(!parse_block_load(*layout, Bytes{18, 7, 2, 0, 0}));   // full
    CHECK(!*parse_block_load(*layout, Bytes{18, 7, 0, 0, 0}));  // not yet
    CHECK(!*parse_block_load(*layout, Bytes{18, 77, 1, 0, 0}));
    CHECK(!*parse_block_load(*layout, Bytes{18}));
    CHECK(!*parse_block_load(*layout, Bytes{}));
}

TEST_CASE("UsbForceFeedback: a wheel with missing reports and other numbering works") {
    auto layout = force_feedback_layout(parsed(emulate::generic_wheel_descriptor()));
    REQUIRE(layout);
    CHECK(layout->reset.bytes == Bytes{0x1c, 1});
    CHECK(layout->stop_all.bytes == Bytes{0x1c, 2});
    CHECK(layout->enable.bytes == Bytes{0x1c, 3});
    CHECK(layout->create.bytes.empty());
    CHECK(layout->block_load.bytes.empty());
    CHECK(layout->free.bytes.empty());
    select_block(*layout, 1);
    CHECK(layout->set_effect.bytes == Bytes{0x11, 1, 2, 0xe8, 0x03, 100, 0x05, 63, 0});
    CHECK(layout->start.bytes == Bytes{0x1a, 1, 2});
    CHECK(layout->stop.bytes == Bytes{0x1a, 1, 1});
    set_magnitude(*layout, 0.5);
    CHECK(layout->set_force.bytes == Bytes{0x15, 0x88, 0x13});
}

TEST_CASE("UsbForceFeedback: a device without a usable constant force is rejected with the reason") {
    const auto why = [](const Bytes& bytes) {
        const auto layout = force_feedback_layout(parsed(bytes));
        REQUIRE(!layout);
        return layout.error().message();
    };
    CHECK(why(mouse()).find("no constant-force effect") != std::string::npos);
    DescriptorBuilder one_way;
    one_way.page(1).usage(4).begin(1).page(15).usage(0x73).begin(2).id(5);
    one_way.usage(0x70).range(0, 255).fields(1, 8).output(2).end();
    CHECK(why(one_way.end().out).find("one sign only") != std::string::npos);
    DescriptorBuilder no_start;
    no_start.page(1).usage(4).begin(1).page(15).usage(0x73).begin(2).id(5);
    no_start.usage(0x70).range(-127, 127).fields(1, 8).output(2).end();
    CHECK(why(no_start.end().out).find("start and stop effects") != std::string::npos);
}

TEST_CASE("BoardRequest: OpenFFBoard queries and replies encode and decode") {
    const auto bytes = open_ffboard::encode_message({.command = 9});
    Bytes expected(25);
    expected[0] = 0xa1;
    expected[1] = 1;
    expected[2] = 0x01;
    expected[3] = 0x0a;
    expected[5] = 9;
    CHECK(Bytes(bytes.begin(), bytes.end()) == expected);

    Bytes reply = expected;
    for (std::size_t i = 9; i < 17; ++i) reply[i] = 0xff;
    reply[9] = 0xfe;
    const auto message = open_ffboard::decode_message(reply);
    REQUIRE(message);
    CHECK(open_ffboard::reply_value(open_ffboard::Command::position, *message) == -2);
    CHECK(!open_ffboard::reply_value(open_ffboard::Command::power, *message));
    for (const std::size_t spoiled : {1U, 2U, 4U, 6U}) {
        Bytes other = reply;
        other[spoiled] ^= 0x0fU;
        CHECK(!open_ffboard::reply_value(open_ffboard::Command::position,
                                         *open_ffboard::decode_message(other)));
    }
    const open_ffboard::WheelMessage m{
        open_ffboard::MessageType::write, 0xa02, 3, 0x12345678, -5, 0x123456789abcdef0};
    CHECK(open_ffboard::decode_message(open_ffboard::encode_message(m)) == m);
    reply.pop_back();
    CHECK(!open_ffboard::decode_message(reply));
    CHECK(!open_ffboard::decode_message(Bytes{}));
}

TEST_CASE("HidDevices: kind_of recognises pucks, boards and wheels among all HID devices") {
    CHECK(kind_of({0x1209, 0xffb0, "", ""}, parsed(emulate::board_descriptor())) == DeviceKind::open_ffboard);
    CHECK(kind_of({0x1234, 0x5678, "", ""}, parsed(emulate::generic_wheel_descriptor())) ==
          DeviceKind::wheel);
    CHECK(kind_of({0x256f, 0xc62e, "", ""}, parsed(puck_in_one())) == DeviceKind::puck);
    CHECK(kind_of({0x046d, 0xc077, "", ""}, parsed(mouse())) == DeviceKind::other);
    CHECK(id_of({0x46d, 0xc626, "SpaceNavigator", ""}) == "046d:c626");
    CHECK(id_of({0x1209, 0xffb0, "OpenFFBoard", "AB12"}) == "1209:ffb0:AB12");
    CHECK(udev_rule({0x46d, 0xc626, "", ""}) ==
          R"(KERNEL=="hidraw*", KERNELS=="*:046D:C626.*", TAG+="uaccess")");
    const auto gone = factory_for("0000:0000:nothing")();
    REQUIRE(!gone);
    CHECK(gone.error().lost);
    CHECK(gone.error().message().find("a connected device") != std::string::npos);
}
