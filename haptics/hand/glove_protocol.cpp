#include "haptics/hand/glove_protocol.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace bolt::hand {

namespace {

constexpr bool is_dij(Sensor s) {
    return s == Sensor::index_dij || s == Sensor::middle_dij || s == Sensor::ring_dij ||
           s == Sensor::little_dij;
}

constexpr std::array<Sensor, 22> all = [] {
    std::array<Sensor, 22> sensors{};
    for (std::size_t i = 0; i < sensors.size(); ++i) sensors[i] = static_cast<Sensor>(i);
    return sensors;
}();

constexpr std::array<Sensor, 18> without_dij = [] {
    std::array<Sensor, 18> sensors{};
    std::size_t n = 0;
    for (const Sensor s : all)
        if (!is_dij(s)) sensors[n++] = s;
    return sensors;
}();

constexpr std::array<const char*, sensor_count> names = {
    "thumb roll",       "thumb MPJ",  "thumb IJ",       "thumb abduction", "index MPJ",        "index PIJ",
    "index DIJ",        "middle MPJ", "middle PIJ",     "middle DIJ",      "middle abduction", "ring MPJ",
    "ring PIJ",         "ring DIJ",   "ring abduction", "little MPJ",      "little PIJ",       "little DIJ",
    "little abduction", "palm arch",  "wrist pitch",    "wrist yaw"};

}  // namespace

std::span<const Sensor> sensors_of(std::size_t count) {
    if (count == all.size()) return all;
    if (count == without_dij.size()) return without_dij;
    return {};
}

const char* name_of(Sensor sensor) { return names[index(sensor)]; }

namespace {

enum class Verdict { whole, wanting, wrong };

// Classifies the bytes that follow a letter.
Verdict judge(const GloveFrameReader& reader, GloveFrame& frame) {
    const GloveFrameLayout& layout = reader.layout;
    const auto bytes = std::span(reader.bytes).first(reader.count);
    if (bytes.front() != static_cast<std::uint8_t>(reader.letter)) return Verdict::wrong;
    const auto sensors = sensors_of(layout.sensors);
    for (std::size_t i = 0; i < sensors.size(); ++i) {
        if (1 + i == bytes.size()) return Verdict::wanting;
        if (bytes[1 + i] == 0) return Verdict::wrong;
        frame.raw[index(sensors[i])] = bytes[1 + i];
    }
    std::size_t at = 1 + sensors.size() + (layout.time ? 5U : 0U);
    if (layout.status) {
        if (at >= bytes.size()) return Verdict::wanting;
        frame.status = bytes[at++];
    }
    for (; at < bytes.size(); at += 2) {
        if (bytes[at] == 0) return Verdict::whole;
        if (bytes[at] != 'e' || (frame.too_slow && frame.unplugged)) return Verdict::wrong;
        if (at + 1 == bytes.size()) return Verdict::wanting;
        bool& complaint = bytes[at + 1] == 's' ? frame.too_slow : frame.unplugged;
        if ((bytes[at + 1] != 's' && bytes[at + 1] != 'g') || complaint) return Verdict::wrong;
        complaint = true;
    }
    return Verdict::wanting;
}

// The letter did not start a frame; continue with the next one.
void give_up(GloveFrameReader& reader) {
    const auto end = reader.bytes.begin() + static_cast<std::ptrdiff_t>(reader.count);
    const auto next = std::find(reader.bytes.begin() + 1, end, static_cast<std::uint8_t>(reader.letter));
    reader.lost += static_cast<std::uint64_t>(next - reader.bytes.begin());
    reader.count =
        static_cast<std::size_t>(std::copy(next, end, reader.bytes.begin()) - reader.bytes.begin());
}

}  // namespace

void read_frames(GloveFrameReader& reader, std::span<const std::uint8_t> bytes,
                 FunctionRef<void(const GloveFrame&)> on_frame) {
    for (const std::uint8_t byte : bytes) {
        reader.bytes[reader.count++] = byte;
        while (reader.count > 0) {
            GloveFrame frame;
            const Verdict verdict = judge(reader, frame);
            if (verdict == Verdict::wanting) break;
            if (verdict == Verdict::wrong) {
                give_up(reader);
                continue;
            }
            ++reader.frames;
            reader.count = 0;
            on_frame(frame);
        }
    }
}

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

GloveSession::GloveSession(const GloveSessionOptions& options)
    : options_(options), handshake_(options.handshake) {}

std::vector<std::uint8_t> GloveSession::start_handshake(double now, GloveState meanwhile) {
    state_ = meanwhile;
    lost_ += reader_.lost;
    reader_ = {};
    handshake_ = GloveHandshake(options_.handshake);
    return handshake_.update({}, now);
}

std::vector<std::uint8_t> GloveSession::update(std::span<const std::uint8_t> received, double now,
                                               FunctionRef<void(const GloveFrame&)> on_frame) {
    if (!started_) {
        started_ = true;
        return start_handshake(now, GloveState::handshake);
    }
    if (state_ == GloveState::streaming) {
        bool unplugged = !identity_.plugged;
        read_frames(reader_, received, [&](const GloveFrame& frame) {
            ++frames_;
            since_ = now;
            unplugged = frame.unplugged;
            trouble_ = frame.unplugged  ? "the glove is not plugged into its box"
                       : frame.too_slow ? "the line is too slow for this rate of samples"
                                        : "";
            if (!frame.unplugged) on_frame(frame);
        });
        identity_.plugged = !unplugged;
        if (now - since_ < options_.silence) return {};
        trouble_ = "the glove gives nothing any more";
        return start_handshake(now, GloveState::silent);
    }
    if (state_ == GloveState::rejected) {
        if (now - since_ < options_.pause) return {};
        return start_handshake(now, GloveState::handshake);
    }
    auto said = handshake_.update(received, now);
    if (handshake_.done()) {
        identity_ = handshake_.identity();
        reader_.layout = {identity_.sensors, false, false};
        trouble_.clear();
        state_ = GloveState::streaming;
        since_ = now;
        ++handshakes_;
    } else if (handshake_.failed()) {
        trouble_ = handshake_.failed()->message();
        state_ = GloveState::rejected;
        since_ = now;
    }
    return said;
}

}  // namespace bolt::hand
