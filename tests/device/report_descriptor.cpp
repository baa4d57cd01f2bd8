#include "haptics/device/report_descriptor.hpp"

#include <doctest/doctest.h>

#include "engine/base/random.hpp"
#include "haptics/device/space_mouse.hpp"
#include "tests/device/descriptors.hpp"

namespace device_report_descriptor_test {

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

TEST_CASE("ReportDescriptor: the buttons, padding and axes of a mouse have the right bit offsets") {
    const ReportDescriptor d = parsed(mouse());
    CHECK(!d.numbered);
    CHECK(d.fields.size() == 5);
    CHECK(report_size(d, ReportKind::input, 0) == 3);
    const ReportField* y = find_field(d, ReportKind::input, {1, 0x31});
    REQUIRE(y);
    CHECK(y->bit == 16);
    CHECK(y->relative);
    CHECK(value_of(*y, Bytes{0, 0, 0xfb}) == -5);
    CHECK(!value_of(*y, Bytes{0, 0}));
    const ReportField* third = find_field(d, ReportKind::input, {9, 3});
    REQUIRE(third);
    CHECK(value_of(*third, Bytes{4, 0, 0}) == 1);
    CHECK(find_field(d, ReportKind::input, {1, 0x31}, Usage{1, 2}) == y);
    CHECK(find_field(d, ReportKind::input, {1, 0x31}, Usage{1, 5}) == nullptr);
}

TEST_CASE("ReportDescriptor: pucks that report in three reports and in one decode the same motion") {
    const auto layout_of = [](const Bytes& bytes) {
        const auto layout = six_axis_layout(parsed(bytes));
        REQUIRE(layout);
        return *layout;
    };
    const SixAxisLayout three = layout_of(puck_in_three()), one = layout_of(puck_in_one());
    CHECK(three.buttons.size() == 2);
    CHECK(one.buttons.size() == 15);
    SixAxisState a, b;
    const auto low = [](int v) { return static_cast<std::uint8_t>(v & 0xff); };
    const auto high = [](int v) { return static_cast<std::uint8_t>(v >> 8 & 0xff); };
    const int v[6] = {350, -175, 0, 35, -350, 70};
    CHECK(decode_report(three, Bytes{1, low(v[0]), high(v[0]), low(v[1]), high(v[1]), low(v[2]), high(v[2])},
                        a));
    CHECK(decode_report(three, Bytes{2, low(v[3]), high(v[3]), low(v[4]), high(v[4]), low(v[5]), high(v[5])},
                        a));
    Bytes all{1};
    for (const int x : v) {
        all.push_back(low(x));
        all.push_back(high(x));
    }
    CHECK(decode_report(one, all, b));
    for (std::size_t i = 0; i < 6; ++i) {
        CHECK(a.deflection[i] == doctest::Approx(v[i] / 350.0));
        CHECK(a.deflection[i] == b.deflection[i]);
    }
    CHECK(decode_report(three, Bytes{3, 2, 0}, a));
    CHECK(a.buttons == 2U);
    CHECK(decode_report(three, Bytes{3, 1, 0}, a));
    CHECK(a.buttons == 1U);
    CHECK(a.deflection[0] == 1.0);  // a button report causes no motion

    CHECK(!decode_report(three, Bytes{}, a));
    CHECK(!decode_report(three, Bytes{1, 2}, a));
    CHECK(!decode_report(three, Bytes{77, 1, 2, 3, 4, 5, 6}, a));
    CHECK(!six_axis_layout(parsed(mouse())));
}

TEST_CASE("ReportDescriptor: values of any offset and width round-trip and change no other bit") {
    Random random(4);
    for (int trial = 0; trial < 5000; ++trial) {
        ReportField f;
        f.bits = static_cast<std::uint8_t>(1 + random.bits() % 32);
        f.bit = static_cast<std::uint32_t>(random.bits() % 64);
        const bool has_sign = f.bits > 1 && random.bits() % 2 == 0;
        f.low = has_sign ? -(std::int64_t{1} << (f.bits - 1)) : 0;
        f.high = has_sign ? (std::int64_t{1} << (f.bits - 1)) - 1 : (std::int64_t{1} << f.bits) - 1;
        Bytes report(16);
        for (auto& byte : report) byte = static_cast<std::uint8_t>(random.bits());
        const Bytes before = report;
        const auto value =
            f.low + static_cast<std::int64_t>(random.bits() % static_cast<std::uint64_t>(f.high - f.low + 1));
        REQUIRE(write_value(f, value, report));
        CHECK(value_of(f, report) == value);
        for (std::uint32_t bit = 0; bit < 128; ++bit) {
            if (bit >= f.bit && bit < f.bit + f.bits) continue;
            CHECK((report[bit / 8] >> (bit % 8) & 1) == (before[bit / 8] >> (bit % 8) & 1));
        }
        CHECK(write_value(f, std::int64_t{1} << 40, report));
        CHECK(value_of(f, report) == f.high);
    }
}

TEST_CASE("ReportDescriptor: a maximum of 255 in one byte is unsigned, and a null state has no value") {
    DescriptorBuilder d;
    d.page(1).usage(5).begin(1).usage(0x30).item(0x14, 0, 1).item(0x24, 0xff, 1).fields(1, 8).input(0x42);
    const ReportDescriptor made = parsed(d.end().out);
    CHECK(made.fields.front().high == 255);
    DescriptorBuilder hat;
    hat.page(1).usage(5).begin(1).usage(0x39).range(0, 7).fields(1, 4).input(0x42).fields(1, 4).input(3);
    const ReportDescriptor with_hat = parsed(hat.end().out);
    CHECK(value_of(with_hat.fields.front(), Bytes{7}) == 7);
    CHECK(!value_of(with_hat.fields.front(), Bytes{8}));
}

TEST_CASE("ReportDescriptor: fields wider than a value keep their offset, and array usages are found") {
    DescriptorBuilder d;
    d.page(0xff00).usage(0).begin(1).id(0xa1).usage(1).range(0, 4).fields(1, 8).output(2);
    d.usage(5).fields(1, 64).output(2).usage(6).fields(1, 16).output(2).end();
    d.page(0xf).usage(0x96).begin(2).id(12).usage(0x98).usage(0x97).usage(0x9a);
    d.range(3, 5).fields(1, 8).output(0).end();
    d.usage(0x77).begin(2).usage(0x79).usage(0x7b).range(0, 1).fields(2, 1).output(2).fields(6, 1).output(3);
    const ReportDescriptor made = parsed(d.end().out);
    CHECK(find_field(made, ReportKind::output, {0xff00, 5}) == nullptr);
    const ReportField* behind = find_field(made, ReportKind::output, {0xff00, 6});
    REQUIRE(behind);
    CHECK(behind->bit == 72);
    CHECK(report_size(made, ReportKind::output, 0xa1) == 11);

    const auto enable = find_selector(made, ReportKind::output, {0xf, 0x97});
    REQUIRE(enable);
    CHECK(enable->value == 4);
    CHECK(!find_selector(made, ReportKind::output, {0xf, 0x99}));
    CHECK(!find_selector(made, ReportKind::feature, {0xf, 0x97}));
    CHECK(!find_selector(made, ReportKind::output, {0xf, 0x97}, Usage{0xf, 0x77}));
    const auto stop = find_selector(made, ReportKind::output, {0xf, 0x7b});
    REQUIRE(stop);
    CHECK(stop->field.bit == 9);
    CHECK(stop->value == 1);
}

TEST_CASE("ReportDescriptor: normalised values keep their sign if the range includes negative ones") {
    const auto normalised = [](std::int64_t low, std::int64_t high, std::int64_t value) {
        ReportField field;
        field.low = low;
        field.high = high;
        return normalized_value(field, value);
    };
    CHECK(normalised(-350, 350, -175) == -0.5);
    CHECK(normalised(-128, 127, 64) == 0.5);
    CHECK(normalised(0, 1023, 1023) == 1.0);
    CHECK(normalised(10, 20, 15) == 0.5);
    CHECK(normalised(-100, 0, -100) == -1.0);
    CHECK(normalised(-100, 0, 0) == 0.0);
    CHECK(normalised(-100, -20, -20) == -0.2);
    CHECK(normalised(0, 0, 0) == 0.0);
}

TEST_CASE("ReportDescriptor: errors name the problem and the byte") {
    const auto message = [](const Bytes& bytes) {
        const auto d = parse_report_descriptor(bytes);
        REQUIRE(!d);
        return d.error().message();
    };
    CHECK(message({}).find("no fields") != std::string::npos);
    CHECK(message({0xc0}).find("not begun") != std::string::npos);
    CHECK(message({0x05}).find("byte 0: it ends within an item") != std::string::npos);
    CHECK(message({0xb4}).find("a Pop item without a Push item; expected a Push item before each Pop item") !=
          std::string::npos);
    Bytes open = mouse();
    open.pop_back();
    CHECK(message(open).find("not ended") != std::string::npos);
    CHECK(message(DescriptorBuilder().page(1).usage(0x30).range(5, 1).fields(1, 8).input(2).out)
              .find("from 5 to 1") != std::string::npos);
    CHECK(message(
              DescriptorBuilder().page(1).usage(0x30).range(0, 1).item(0x94, 1).item(0x74, 300).input(2).out)
              .find("300 bits") != std::string::npos);
    const Bytes whole = puck_in_three();
    for (std::size_t cut = 0; cut < whole.size(); ++cut)
        CHECK(!parse_report_descriptor(std::span(whole).first(cut)));
}

}  // namespace device_report_descriptor_test
