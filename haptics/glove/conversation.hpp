// A glove from the line's first byte on: greeted, read, greeted anew when it falls silent. Pure: bytes and
// time in, bytes and samples out; driver.hpp gives it a line and a thread.
#pragma once

#include <string>

#include "haptics/glove/greeting.hpp"

namespace bolt::glove {

enum class State : std::uint8_t {
    greeting,  // being asked what it is
    streaming,
    silent,   // streamed, and gives nothing now
    refused,  // what is on the line is no glove that we know; asked again after a while
};

struct ConversationOptions {
    GreetingOptions greeting;
    double silence = 0.25;  // s without a frame while streaming: it is silent, and greeted anew
    double pause = 1.0;     // s before what was refused is greeted again
};

class Conversation {
  public:
    explicit Conversation(const ConversationOptions& options = {});

    // What came in since the last call, and the time now (s). What to send. `tell` gets every frame.
    std::vector<std::uint8_t> go_on(std::span<const std::uint8_t> received, double now,
                                    FunctionRef<void(const Frame&)> tell);

    [[nodiscard]] State state() const { return state_; }
    [[nodiscard]] const Identity& identity() const {
        return identity_;
    }  // of the last glove that was greeted
    [[nodiscard]] const std::string& trouble() const { return trouble_; }  // empty: none
    [[nodiscard]] std::uint64_t frames() const { return frames_; }
    [[nodiscard]] std::uint64_t lost_bytes() const { return lost_ + reader_.lost; }
    [[nodiscard]] std::uint64_t greetings() const { return greetings_; }  // that ended with a stream

  private:
    std::vector<std::uint8_t> greet(double now, State meanwhile);

    ConversationOptions options_;
    State state_ = State::greeting;
    Greeting greeting_;
    FrameReader reader_;
    Identity identity_;
    std::string trouble_;
    double since_ = 0.0;
    bool started_ = false;
    std::uint64_t frames_ = 0, lost_ = 0, greetings_ = 0;
};

}  // namespace bolt::glove
