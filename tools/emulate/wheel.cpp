#include "tools/emulate/wheel.hpp"

#include <algorithm>
#include <cmath>

#include "engine/base/math.hpp"
#include "tools/emulate/hid_device.hpp"

namespace bolt::emulate {

namespace {

constexpr int variable = 2, array = 0, padding = 3;
constexpr int desktop = 1, simulation = 2, buttons = 9, pid = 0xf;

DescriptorBuilder& value(DescriptorBuilder& d, int usage, std::int64_t low, std::int64_t high, int bits) {
    return d.usage(usage).range(low, high).fields(1, bits).output(variable);
}

// Adds the axes-enable bits and two direction fields of `bits` bits with the maximum `high`.
void directions(DescriptorBuilder& d, std::int64_t high, int bits) {
    d.usage(0x55)
        .begin(2)
        .page(desktop)
        .usage(0x30)
        .usage(0x31)
        .range(0, 1)
        .fields(2, 1)
        .output(variable)
        .end();
    d.page(pid).usage(0x56).fields(1, 1).output(variable).fields(5, 1).output(padding);
    d.usage(0x57).begin(2).item(0x08, 0xa0001, 4).item(0x08, 0xa0002, 4);
    d.range(0, high).fields(2, bits).output(variable).end();
}

}  // namespace

Bytes board_descriptor() {
    DescriptorBuilder d;
    d.page(desktop).usage(4).begin(1).begin(0).id(1);
    d.page(buttons).usages(1, 64).range(0, 1).fields(64, 1).input(variable).page(desktop);
    for (const int axis : {0x30, 0x31, 0x32, 0x33, 0x34, 0x35, 0x37, 0x36}) d.usage(axis);
    d.range(-32767, 32767).fields(8, 16).input(variable).end();

    for (const bool out : {true, false}) {
        if (out) d.page(0xff00).usage(0).begin(1);
        d.id(0xa1);
        int usage = 0;
        for (const int bits : {8, 16, 8, 32, 64, 64}) {
            d.usage(++usage).range(0, 4).fields(1, bits);
            out ? d.output(variable) : d.input(variable);
        }
        if (!out) d.end();
    }

    d.page(pid).usage(0x92).begin(2).id(2);
    for (const int state : {0x9f, 0xa0, 0xa4, 0xa6, 0x94}) d.usage(state);
    d.range(0, 1).fields(5, 1).input(variable).fields(3, 1).input(padding).end();

    d.usage(0x21).begin(2).id(1);
    value(d, 0x22, 1, 40, 8).usage(0x25).begin(2);
    for (const int type : {0x26, 0x27, 0x30, 0x31, 0x32, 0x33, 0x34, 0x40, 0x41, 0x42, 0x43}) d.usage(type);
    d.range(1, 11).fields(1, 8).output(array).end();
    d.usage(0x50).usage(0x54).usage(0x51).usage(0xa7).range(0, 32767).fields(4, 16).output(variable);
    value(d, 0x52, 0, 255, 8);
    value(d, 0x53, 1, 8, 8);
    directions(d, 35900, 16);
    d.end();

    d.usage(0x73).begin(2).id(5);
    value(d, 0x22, 1, 40, 8);
    value(d, 0x70, -32767, 32767, 16).end();

    d.usage(0x77).begin(2).id(10);
    value(d, 0x22, 1, 40, 8).usage(0x78).begin(2).usage(0x79).usage(0x7a).usage(0x7b);
    d.range(1, 3).fields(1, 8).output(array).end();
    value(d, 0x7c, 0, 255, 8).end();

    d.usage(0x90).begin(2).id(11);
    value(d, 0x22, 1, 40, 8).end();

    d.usage(0x95).begin(2).id(12).usage(0x96).begin(2);
    for (int command = 0x97; command <= 0x9c; ++command) d.usage(command);
    d.range(1, 6).fields(8, 1).output(variable).end().end();

    d.usage(0x7d).begin(2).id(13);
    value(d, 0x7e, 0, 255, 8).end();

    d.usage(0xab).begin(2).id(17).usage(0x25).begin(2);
    for (const int type : {0x26, 0x27, 0x30, 0x31, 0x32, 0x33, 0x34, 0x40, 0x41, 0x42, 0x43}) d.usage(type);
    d.range(1, 11).fields(1, 8).feature(array).end();
    d.page(desktop).usage(0x3b).range(0, 511).fields(1, 10).feature(variable).fields(1, 6).feature(1).end();

    d.page(pid).usage(0x89).begin(2).id(18).usage(0x22).range(1, 40).fields(1, 8).feature(variable);
    d.usage(0x8b).begin(2).usage(0x8c).usage(0x8d).usage(0x8e).range(1, 3).fields(1, 8).feature(array).end();
    d.usage(0xac).range(0, 65535).fields(1, 16).feature(array).end();
    return d.end().out;
}

Bytes generic_wheel_descriptor() {
    DescriptorBuilder d;
    d.page(desktop).usage(4).begin(1).id(1);
    d.page(simulation).usage(0xc8).range(0, 65535).fields(1, 16).input(variable);
    d.page(buttons).usages(1, 8).range(0, 1).fields(8, 1).input(variable);

    d.page(pid).usage(0x21).begin(2).id(0x11);
    value(d, 0x22, 1, 8, 8)
        .usage(0x25)
        .begin(2)
        .usage(0x40)
        .usage(0x26)
        .range(1, 2)
        .fields(1, 8)
        .output(array)
        .end();
    value(d, 0x50, 0, 65535, 16);
    value(d, 0x52, 0, 100, 8);
    directions(d, 255, 8);
    d.end();

    d.usage(0x73).begin(2).id(0x15);
    value(d, 0x70, -10000, 10000, 16).end();

    d.usage(0x77).begin(2).id(0x1a);
    value(d, 0x22, 1, 8, 8)
        .usage(0x78)
        .begin(2)
        .usage(0x7b)
        .usage(0x79)
        .range(1, 2)
        .fields(1, 8)
        .output(array)
        .end();
    d.end();

    d.usage(0x96).begin(2).id(0x1c).usage(0x9a).usage(0x99).usage(0x97).usage(0x98);
    d.range(1, 4).fields(1, 8).output(array).end();

    d.usage(0x7d).begin(2).id(0x1d);
    value(d, 0x7e, 0, 100, 8).end();
    return d.end().out;
}

namespace {

constexpr double wheel_step = 0.00025;    // s, time step of the mechanics
constexpr double report_period = 0.001;   // s, between reports
constexpr double repeat_period = 0.1;     // s, after which a board repeats an unchanged report
constexpr std::uint8_t effect_block = 1;  // index of the only effect block

unsigned read_u16(std::span<const std::uint8_t> report, std::size_t at) {
    return at + 1 < report.size() ? report[at] | static_cast<unsigned>(report[at + 1]) << 8U : 0U;
}

}  // namespace

EmulatedWheel::EmulatedWheel(const EmulatedWheelOptions& options)
    : options_(options), random_(options.faults.seed) {
    description_ =
        options.board
            ? HidDescription{0x1209, 0xffb0, "Emulated OpenFFBoard", options.serial, board_descriptor()}
            : HidDescription{0x1234, 0x5678, "Emulated wheel", options.serial, generic_wheel_descriptor()};
    if (!options.board) options_.power = 1.0;
}

double EmulatedWheel::torque() const {
    if (springs_ && options_.centring_spring > 0.0) return -options_.centring_spring * angle_;
    if (!enabled_ || !loaded_ || !set_ || !playing_ ||
        time_ - started_ > std::min(options_.effect_life, duration_))
        return 0.0;
    // The direction of an effect is the one from which its force comes: a force from the right turns the
    // wheel to the left.
    return -magnitude_ * effect_gain_ * gain_ * options_.power * options_.full_torque;
}

std::vector<Bytes> EmulatedWheel::advance(double now) {
    std::vector<Bytes> out;
    if (now - time_ > 1.0) time_ = next_ = now - 1.0;
    for (; time_ + wheel_step <= now; time_ += wheel_step) {
        const double pull = torque() + hand_stiffness * (hand - angle_) - options_.damping * speed_;
        speed_ += pull / options_.inertia * wheel_step;
        angle_ += speed_ * wheel_step;
        if (time_ < next_) continue;
        next_ += report_period;
        if (stalled) continue;
        Bytes report = axis_report();
        if (report != last_report_ || (options_.board && time_ - last_report_time_ >= repeat_period)) {
            last_report_ = report;
            last_report_time_ = time_;
            out.push_back(std::move(report));
        }
        // The endpoint carries one report per millisecond.
        if (!answers_.empty()) {
            out.push_back(std::move(answers_.front()));
            answers_.erase(answers_.begin());
        }
    }
    return with_faults(std::move(out), options_.faults, random_);
}

Bytes EmulatedWheel::axis_report() const {
    const double share = std::clamp(angle_ / (0.5 * to_radians(options_.degrees)), -1.0, 1.0);
    if (options_.board) {
        Bytes report(1 + 8 + 16);
        report[0] = 1;
        for (std::size_t i = 0; i < 4; ++i) report[1 + i] = static_cast<std::uint8_t>(buttons >> (8 * i));
        const auto x = static_cast<std::int16_t>(std::lround(share * 32767.0));
        report[9] = static_cast<std::uint8_t>(x & 0xff);
        report[10] = static_cast<std::uint8_t>(x >> 8 & 0xff);
        return report;
    }
    const auto x = static_cast<unsigned>(std::lround((share + 1.0) * 0.5 * 65535.0));
    return {1, static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(x >> 8U),
            static_cast<std::uint8_t>(buttons)};
}

void EmulatedWheel::control(std::uint8_t bits) {
    if ((bits & 0x01U) != 0) enabled_ = true;
    if ((bits & 0x02U) != 0) enabled_ = false;
    if ((bits & 0x0cU) != 0) playing_ = false;
    if ((bits & 0x0cU) != 0) springs_ = (bits & 0x08U) != 0;
    if ((bits & 0x08U) != 0) {
        enabled_ = false;
        loaded_ = set_ = false;
        magnitude_ = 0.0;
    }
}

void EmulatedWheel::answer_request(std::span<const std::uint8_t> request) {
    if (request.size() < 25 || request[1] != 1) return;
    Bytes reply(request.begin(), request.begin() + 25);
    std::int64_t value = 0;
    if (read_u16(request, 2) != 0xa01 || request[4] != 0 || request[6] != 0)
        reply[1] = 13;  // not found
    else if (request[5] == 0)
        value = std::lround(options_.power * 32767.0);
    else if (request[5] == 1)
        value = std::lround(options_.degrees);
    else if (request[5] == 9)
        value = std::lround(angle_ / (2.0 * pi) * options_.counts_per_turn);
    else
        reply[1] = 13;
    for (std::size_t i = 0; i < 8; ++i)
        reply[9 + i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i));
    answers_.push_back(std::move(reply));
}

void EmulatedWheel::output(std::span<const std::uint8_t> report) {
    if (stalled || report.empty()) return;
    ++reports_received_;
    const auto byte = [&](std::size_t at) { return at < report.size() ? report[at] : std::uint8_t{0}; };
    const auto start_or_stop = [&](bool start) {
        playing_ = start;
        if (start) started_ = time_;
    };
    if (options_.board) {
        const bool ours = byte(1) == effect_block && loaded_;
        switch (report[0]) {
            case 0x01:
                if (!ours || byte(2) != 1) return;
                duration_ = read_u16(report, 3) / 1000.0;
                effect_gain_ = byte(11) / 255.0;
                // Only the east–west component of the direction acts on a wheel.
                if ((byte(13) & 4U) != 0) effect_gain_ *= std::sin(read_u16(report, 14) / 36000.0 * 2.0 * pi);
                set_ = true;
                return;
            case 0x05:
                if (ours) magnitude_ = static_cast<std::int16_t>(read_u16(report, 2)) / 32767.0;
                return;
            case 0x0a:
                if (ours && (byte(2) == 1 || byte(2) == 3)) start_or_stop(byte(2) == 1);
                return;
            case 0x0b:
                if (ours) loaded_ = set_ = playing_ = false;
                return;
            case 0x0c:
                return control(byte(1));
            case 0x0d:
                gain_ = byte(1) / 255.0;
                return;
            case 0xa1:
                return answer_request(report);
            default:
                return;
        }
    }
    switch (report[0]) {
        case 0x11:
            if (byte(1) != effect_block || byte(2) != 2) return;
            duration_ = read_u16(report, 3) / 1000.0;
            effect_gain_ = byte(5) / 100.0 * std::sin(byte(7) / 256.0 * 2.0 * pi);
            set_ = true;
            return;
        case 0x15:
            magnitude_ = static_cast<std::int16_t>(read_u16(report, 1)) / 10000.0;
            return;
        case 0x1a:
            if (byte(1) == effect_block && (byte(2) == 1 || byte(2) == 2)) start_or_stop(byte(2) == 2);
            return;
        case 0x1c: {
            constexpr std::uint8_t as_bits[] = {0, 0x08, 0x04, 0x01, 0x02};
            if (byte(1) < std::size(as_bits)) control(as_bits[byte(1)]);
            loaded_ = true;  // its effect block always exists
            return;
        }
        case 0x1d:
            gain_ = byte(1) / 100.0;
            return;
        default:
            return;
    }
}

void EmulatedWheel::set_feature(std::span<const std::uint8_t> report) {
    if (stalled || !options_.board || report.size() < 2) return;
    ++reports_received_;
    if (report[0] == 17 && report[1] == 1) loaded_ = true;
}

Bytes EmulatedWheel::get_feature(std::uint8_t report) {
    if (stalled || !options_.board || report != 18) return {};
    return {18, loaded_ ? effect_block : std::uint8_t{0}, loaded_ ? std::uint8_t{1} : std::uint8_t{2}, 39, 0};
}

}  // namespace bolt::emulate
