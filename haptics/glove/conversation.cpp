#include "haptics/glove/conversation.hpp"

namespace bolt::glove {

Conversation::Conversation(const ConversationOptions& options)
    : options_(options), greeting_(options.greeting) {}

std::vector<std::uint8_t> Conversation::greet(double now, State meanwhile) {
    state_ = meanwhile;
    lost_ += reader_.lost;
    reader_ = {};
    greeting_ = Greeting(options_.greeting);
    return greeting_.go_on({}, now);
}

std::vector<std::uint8_t> Conversation::go_on(std::span<const std::uint8_t> received, double now,
                                              FunctionRef<void(const Frame&)> tell) {
    if (!started_) {
        started_ = true;
        return greet(now, State::greeting);
    }
    if (state_ == State::streaming) {
        bool unplugged = !identity_.plugged;
        read_frames(reader_, received, [&](const Frame& frame) {
            ++frames_;
            since_ = now;
            unplugged = frame.unplugged;
            trouble_ = frame.unplugged  ? "the glove is not plugged into its box"
                       : frame.too_slow ? "the line is too slow for this rate of samples"
                                        : "";
            if (!frame.unplugged) tell(frame);
        });
        identity_.plugged = !unplugged;
        if (now - since_ < options_.silence) return {};
        trouble_ = "the glove gives nothing any more";
        return greet(now, State::silent);
    }
    if (state_ == State::refused) {
        if (now - since_ < options_.pause) return {};
        return greet(now, State::greeting);
    }
    auto said = greeting_.go_on(received, now);
    if (greeting_.done()) {
        identity_ = greeting_.identity();
        reader_.layout = {identity_.sensors, false, false};
        trouble_.clear();
        state_ = State::streaming;
        since_ = now;
        ++greetings_;
    } else if (greeting_.failed()) {
        trouble_ = greeting_.failed()->message();
        state_ = State::refused;
        since_ = now;
    }
    return said;
}

}  // namespace bolt::glove
