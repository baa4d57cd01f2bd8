#include "haptics/hand/glove_handshake.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace bolt::hand {

namespace {

constexpr std::uint8_t stop_streaming = 0x03;
constexpr double ticks_per_second = 115200.0;  // of the glove's sample clock
constexpr std::size_t longest_answer = 64;

enum class Match { yes, wanting, no };

// True if the bytes begin with this prefix.
Match begins(std::span<const std::uint8_t> bytes, std::string_view with) {
    for (std::size_t i = 0; i < with.size(); ++i) {
        if (i == bytes.size()) return Match::wanting;
        if (bytes[i] != static_cast<std::uint8_t>(with[i])) return Match::no;
    }
    return Match::yes;
}

constexpr std::string_view unknown = {"e?\r\n\0", 5};

}  // namespace

std::vector<std::uint8_t> GloveHandshake::question() const {
    const auto bytes = [](std::string_view text) { return Bytes(text.begin(), text.end()); };
    switch (step_) {
        case Step::silencing:
            return {stop_streaming};
        case Step::sensors:
            return bytes("?S");
        case Step::samples:
            return bytes("?N");
        case Step::set_samples:
            return {'N', static_cast<std::uint8_t>(identity_.sensors)};
        case Step::hand:
            return bytes("?R");
        case Step::plugged:
            return bytes("?G");
        case Step::version:
            return bytes("?V");
        case Step::no_status:
            return {'U', 0};
        case Step::no_time:
            return {'D', 0};
        case Step::rate:
            return bytes(fmt::format("t {} 1\r", std::lround(ticks_per_second / options_.rate)));
        case Step::streaming:
            return {'S'};
    }
    return {};
}

GloveHandshake::Bytes GloveHandshake::ask(Step step, double now) {
    tries_ = step == step_ ? tries_ + 1 : 1;
    step_ = step;
    since_ = last_byte_ = now;
    if (step != Step::streaming) answer_.clear();
    return question();
}

void GloveHandshake::give_up(std::string what, std::string expected) {
    Error error;
    error.code = ErrorCode::no_device;
    error.what = std::move(what);
    error.expected = std::move(expected);
    failed_ = std::move(error);
}

// Returns true if the reply to this step is complete; drops unrelated bytes before it. "Unknown command"
// counts as a reply where old firmware lacks the command.
bool GloveHandshake::take_answer() {
    const Bytes asked = question();
    while (!answer_.empty()) {
        if (begins(answer_, unknown) == Match::yes) {
            answer_.erase(answer_.begin(), answer_.begin() + static_cast<std::ptrdiff_t>(unknown.size()));
            if (step_ == Step::sensors || step_ == Step::samples || step_ == Step::set_samples) {
                give_up("what is on the line does not know its sensors", "a CyberGlove of 18 or 22 sensors");
                return false;
            }
            return true;
        }
        if (begins(answer_, unknown) == Match::wanting) return false;
        const std::string_view letters(reinterpret_cast<const char*>(asked.data()),
                                       asked.front() == '?' ? 2U : 1U);
        const Match match = begins(answer_, letters);
        if (match == Match::wanting) return false;
        if (match == Match::yes) {
            std::uint8_t value = 0;
            if (step_ == Step::version || step_ == Step::rate) {
                const auto end = std::find(answer_.begin(), answer_.end(), 0);
                if (end == answer_.end() && answer_.size() < longest_answer) return false;
                if (step_ == Step::version)
                    for (auto c = answer_.begin() + 2; c != end; ++c)
                        if (*c >= 0x20 && *c < 0x7f) identity_.version += static_cast<char>(*c);
                answer_.erase(answer_.begin(), end == answer_.end() ? end : end + 1);
                return true;
            }
            const std::size_t length = letters.size() + (asked.front() == '?' ? 2U : 1U);
            if (answer_.size() < length) return false;
            if (answer_[length - 1] == 0) {
                value = answer_[length - 2];
                answer_.erase(answer_.begin(), answer_.begin() + static_cast<std::ptrdiff_t>(length));
                return take_value(value);
            }
        }
        answer_.erase(answer_.begin());
    }
    return false;
}

bool GloveHandshake::take_value(std::uint8_t value) {
    switch (step_) {
        case Step::sensors:
            identity_.sensors = value;
            if (sensors_of(value).empty()) {
                give_up(fmt::format("the glove has {} sensors", value), "18 or 22");
                return false;
            }
            return true;
        case Step::samples:
            samples_ = value;
            return true;
        case Step::hand:
            identity_.hand = value != 0 ? Side::right : Side::left;
            return true;
        case Step::plugged:
            identity_.plugged = (value & 1U) != 0;
            return true;
        default:
            return true;
    }
}

std::vector<std::uint8_t> GloveHandshake::update(std::span<const std::uint8_t> received, double now) {
    if (failed_ || done()) return {};
    if (!started_) {
        started_ = true;
        return ask(Step::silencing, now);
    }
    if (!received.empty()) last_byte_ = now;
    if (step_ == Step::silencing) {
        if (now - last_byte_ >= options_.quiet) return ask(Step::sensors, now);
        if (now - since_ < options_.longest_quiet) return {};
        if (tries_ < options_.tries) return ask(Step::silencing, now);
        give_up("the line is never quiet", "a CyberGlove at 115200 baud, which stops streaming when told to");
        return {};
    }
    answer_.insert(answer_.end(), received.begin(), received.end());
    if (take_answer()) {
        Step next = static_cast<Step>(static_cast<int>(step_) + 1);
        if (next == Step::set_samples && samples_ == identity_.sensors) next = Step::hand;
        return ask(next, now);
    }
    if (failed_) return {};
    if (now - since_ < options_.patience) return {};
    if (tries_ < options_.tries) return ask(step_, now);
    if (step_ >= Step::hand) return ask(static_cast<Step>(static_cast<int>(step_) + 1), now);
    give_up("nothing on the line answers as a glove",
            "a CyberGlove at 115200 baud; is its box switched on, and is this its port?");
    return {};
}

}  // namespace bolt::hand
