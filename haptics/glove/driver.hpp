// A glove on a serial port, read by a thread of its own: the latest sample and how the glove is, for whoever
// looks. Nothing that reads here ever waits.
#pragma once

#include <filesystem>
#include <memory>

#include "haptics/glove/conversation.hpp"

namespace bolt::glove {

struct Sample {
    Frame frame;
    std::uint64_t number = 0;  // 0: none yet
    double time = 0.0;         // s of the steady clock, when its last byte was read
};

struct Report {
    bool open = false;  // the port
    State state = State::greeting;
    Identity identity;
    std::array<char, 200> trouble{};  // words, ended by a zero; empty: none
    std::uint64_t frames = 0, lost_bytes = 0, greetings = 0, openings = 0;
    // s of the steady clock at which the newest frame came, and the longest that none did, up to now.
    double newest = 0.0, longest_silence = 0.0;
};

class Driver {
  public:
    // Returns at once; a port that cannot be opened (yet) is tried again, and the report says so.
    static Driver start(std::filesystem::path port, const ConversationOptions& options = {});

    Driver(Driver&&) noexcept;
    Driver& operator=(Driver&&) noexcept;
    ~Driver();  // stops

    // For one reader at a time each.
    const Sample& sample();
    const Report& report();

  private:
    struct Shared;
    explicit Driver(std::unique_ptr<Shared> shared);
    std::unique_ptr<Shared> shared_;
};

}  // namespace bolt::glove
