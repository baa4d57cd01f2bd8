#include "haptics/hand/glove_protocol.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace bolt::hand {

namespace {

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

enum class FrameMatch { complete, incomplete, mismatch };

// Matches the bytes of the reader, which begin with a letter, against the frame layout.
FrameMatch match_frame(const GloveFrameReader& reader, GloveFrame& frame) {
    const GloveFrameLayout& layout = reader.layout;
    const auto bytes = std::span(reader.bytes).first(reader.count);
    if (bytes.front() != static_cast<std::uint8_t>(reader.letter)) return FrameMatch::mismatch;
    const auto sensors = sensors_of(layout.sensors);
    for (std::size_t i = 0; i < sensors.size(); ++i) {
        if (1 + i == bytes.size()) return FrameMatch::incomplete;
        if (bytes[1 + i] == 0) return FrameMatch::mismatch;
        frame.raw[index(sensors[i])] = bytes[1 + i];
    }
    std::size_t at = 1 + sensors.size() + (layout.time ? 5U : 0U);
    if (layout.status) {
        if (at >= bytes.size()) return FrameMatch::incomplete;
        frame.status = bytes[at++];
    }
    for (; at < bytes.size(); at += 2) {
        if (bytes[at] == 0) return FrameMatch::complete;
        if (bytes[at] != 'e' || (frame.too_slow && frame.unplugged)) return FrameMatch::mismatch;
        if (at + 1 == bytes.size()) return FrameMatch::incomplete;
        bool& flag = bytes[at + 1] == 's' ? frame.too_slow : frame.unplugged;
        if ((bytes[at + 1] != 's' && bytes[at + 1] != 'g') || flag) return FrameMatch::mismatch;
        flag = true;
    }
    return FrameMatch::incomplete;
}

// The letter did not start a frame; continue with the next such letter.
void resynchronise(GloveFrameReader& reader) {
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
            const FrameMatch match_result = match_frame(reader, frame);
            if (match_result == FrameMatch::incomplete) break;
            if (match_result == FrameMatch::mismatch) {
                resynchronise(reader);
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
constexpr std::size_t longest_reply = 64;

enum class Match { yes, incomplete, no };

// Compares the beginning of the bytes with a prefix; `incomplete` if there are too few bytes.
Match match_prefix(std::span<const std::uint8_t> bytes, std::string_view with) {
    for (std::size_t i = 0; i < with.size(); ++i) {
        if (i == bytes.size()) return Match::incomplete;
        if (bytes[i] != static_cast<std::uint8_t>(with[i])) return Match::no;
    }
    return Match::yes;
}

constexpr std::string_view unknown_command = {"e?\r\n\0", 5};

}  // namespace

std::vector<std::uint8_t> GloveHandshake::query_bytes() const {
    const auto bytes = [](std::string_view text) { return Bytes(text.begin(), text.end()); };
    switch (step_) {
        case HandshakeStep::stop_streaming:
            return {stop_streaming};
        case HandshakeStep::query_sensors:
            return bytes("?S");
        case HandshakeStep::query_samples:
            return bytes("?N");
        case HandshakeStep::set_samples:
            return {'N', static_cast<std::uint8_t>(identity_.sensors)};
        case HandshakeStep::query_side:
            return bytes("?R");
        case HandshakeStep::query_plugged:
            return bytes("?G");
        case HandshakeStep::query_version:
            return bytes("?V");
        case HandshakeStep::disable_status:
            return {'U', 0};
        case HandshakeStep::disable_time:
            return {'D', 0};
        case HandshakeStep::set_rate:
            return bytes(fmt::format("t {} 1\r", std::lround(ticks_per_second / options_.rate)));
        case HandshakeStep::streaming:
            return {'S'};
    }
    return {};
}

GloveHandshake::Bytes GloveHandshake::start_step(HandshakeStep step, double now) {
    attempts_ = step == step_ ? attempts_ + 1 : 1;
    step_ = step;
    since_ = last_byte_ = now;
    if (step != HandshakeStep::streaming) reply_.clear();
    return query_bytes();
}

void GloveHandshake::fail_with(std::string what, std::string expected) {
    Error error;
    error.code = ErrorCode::no_device;
    error.what = std::move(what);
    error.expected = std::move(expected);
    failed_ = std::move(error);
}

// Returns true if the reply to this step is complete; drops unrelated bytes before it. "Unknown command"
// counts as a reply where old firmware lacks the command.
bool GloveHandshake::parse_reply() {
    const Bytes query = query_bytes();
    while (!reply_.empty()) {
        if (match_prefix(reply_, unknown_command) == Match::yes) {
            reply_.erase(reply_.begin(),
                         reply_.begin() + static_cast<std::ptrdiff_t>(unknown_command.size()));
            if (step_ == HandshakeStep::query_sensors || step_ == HandshakeStep::query_samples ||
                step_ == HandshakeStep::set_samples) {
                fail_with("the device on the port does not report its sensors",
                          "a CyberGlove with 18 or 22 sensors");
                return false;
            }
            return true;
        }
        if (match_prefix(reply_, unknown_command) == Match::incomplete) return false;
        const std::string_view letters(reinterpret_cast<const char*>(query.data()),
                                       query.front() == '?' ? 2U : 1U);
        const Match match = match_prefix(reply_, letters);
        if (match == Match::incomplete) return false;
        if (match == Match::yes) {
            std::uint8_t value = 0;
            if (step_ == HandshakeStep::query_version || step_ == HandshakeStep::set_rate) {
                const auto end = std::find(reply_.begin(), reply_.end(), 0);
                if (end == reply_.end() && reply_.size() < longest_reply) return false;
                if (step_ == HandshakeStep::query_version)
                    for (auto c = reply_.begin() + 2; c != end; ++c)
                        if (*c >= 0x20 && *c < 0x7f) identity_.version += static_cast<char>(*c);
                reply_.erase(reply_.begin(), end == reply_.end() ? end : end + 1);
                return true;
            }
            const std::size_t length = letters.size() + (query.front() == '?' ? 2U : 1U);
            if (reply_.size() < length) return false;
            if (reply_[length - 1] == 0) {
                value = reply_[length - 2];
                reply_.erase(reply_.begin(), reply_.begin() + static_cast<std::ptrdiff_t>(length));
                return store_value(value);
            }
        }
        reply_.erase(reply_.begin());
    }
    return false;
}

bool GloveHandshake::store_value(std::uint8_t value) {
    switch (step_) {
        case HandshakeStep::query_sensors:
            identity_.sensors = value;
            if (sensors_of(value).empty()) {
                fail_with(fmt::format("the glove has {} sensors", value), "18 or 22");
                return false;
            }
            return true;
        case HandshakeStep::query_samples:
            samples_ = value;
            return true;
        case HandshakeStep::query_side:
            identity_.side = value != 0 ? Side::right : Side::left;
            return true;
        case HandshakeStep::query_plugged:
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
        return start_step(HandshakeStep::stop_streaming, now);
    }
    if (!received.empty()) last_byte_ = now;
    if (step_ == HandshakeStep::stop_streaming) {
        if (now - last_byte_ >= options_.quiet_time) return start_step(HandshakeStep::query_sensors, now);
        if (now - since_ < options_.quiet_timeout) return {};
        if (attempts_ < options_.tries) return start_step(HandshakeStep::stop_streaming, now);
        fail_with("the port is never quiet", "a CyberGlove at 115200 baud, which stops streaming on command");
        return {};
    }
    reply_.insert(reply_.end(), received.begin(), received.end());
    if (parse_reply()) {
        HandshakeStep next = static_cast<HandshakeStep>(static_cast<int>(step_) + 1);
        if (next == HandshakeStep::set_samples && samples_ == identity_.sensors)
            next = HandshakeStep::query_side;
        return start_step(next, now);
    }
    if (failed_) return {};
    if (now - since_ < options_.reply_timeout) return {};
    if (attempts_ < options_.tries) return start_step(step_, now);
    if (step_ >= HandshakeStep::query_side)
        return start_step(static_cast<HandshakeStep>(static_cast<int>(step_) + 1), now);
    fail_with("no device on the port answers as a glove",
              "a CyberGlove at 115200 baud; is its interface unit switched on, and is this its port?");
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
            fault_message_ =
                frame.unplugged
                    ? "the glove is not plugged into its interface unit; expected its plug in the unit"
                : frame.too_slow ? "the serial line is too slow for this sample rate; expected a faster line "
                                   "or fewer samples a second"
                                 : "";
            if (!frame.unplugged) on_frame(frame);
        });
        identity_.plugged = !unplugged;
        if (now - since_ < options_.silence) return {};
        fault_message_ =
            "the glove has stopped sending data; expected a glove that is switched on and plugged in";
        return start_handshake(now, GloveState::silent);
    }
    if (state_ == GloveState::rejected) {
        if (now - since_ < options_.pause) return {};
        return start_handshake(now, GloveState::handshake);
    }
    auto outgoing = handshake_.update(received, now);
    if (handshake_.done()) {
        identity_ = handshake_.identity();
        reader_.layout = {identity_.sensors, false, false};
        fault_message_.clear();
        state_ = GloveState::streaming;
        since_ = now;
        ++handshakes_;
    } else if (handshake_.failed()) {
        fault_message_ = handshake_.failed()->message();
        state_ = GloveState::rejected;
        since_ = now;
    }
    return outgoing;
}

}  // namespace bolt::hand
