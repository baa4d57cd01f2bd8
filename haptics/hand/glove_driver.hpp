// The driver of a glove on a serial port: the thread that reads it.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "engine/base/serial_port.hpp"
#include "haptics/hand/glove_protocol.hpp"

namespace bolt::hand {

struct GloveSample {
    GloveFrame frame;
    std::uint64_t number = 0;  // 0: none yet
    double time = 0.0;         // s on the steady clock, when its last byte was read
};

struct GloveReport {
    bool open = false;                         // the port is open
    GloveState state = GloveState::handshake;  // `silent` while the port is not open
    GloveIdentity identity;
    std::array<char, 200> fault_message{};  // zero-terminated text; empty: none
    // Totals since the start: frames, bytes outside valid frames, successful handshakes, and successful
    // openings of the port.
    std::uint64_t frames = 0, lost_bytes = 0, handshakes = 0, openings = 0;
    // s: time of the latest frame on the steady clock, and the longest gap between frames up to now.
    double newest = 0.0, longest_silence = 0.0;
};

// Reads a glove on its own thread. Readers get the latest sample and report without waiting.
class GloveDriver {
  public:
    // Returns immediately. If the port cannot be opened, the thread retries and the report has the reason.
    static GloveDriver start(std::filesystem::path port, const GloveSessionOptions& options = {});

    GloveDriver(GloveDriver&&) noexcept;
    GloveDriver& operator=(GloveDriver&&) noexcept;
    ~GloveDriver();  // stops the thread

    // Call each of these from one thread only.
    const GloveSample& sample();
    const GloveReport& report();

  private:
    struct Shared;
    explicit GloveDriver(std::unique_ptr<Shared> shared);
    std::unique_ptr<Shared> shared_;
};

}  // namespace bolt::hand
