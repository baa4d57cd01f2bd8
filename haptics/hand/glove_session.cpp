#include "haptics/hand/glove_session.hpp"

namespace bolt::hand {

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
