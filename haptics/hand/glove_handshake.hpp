// The handshake with a glove: reads its identity and configures the stream. Pure: bytes and time in, bytes
// out.
//
// The reply to a query ('?' and a letter) repeats both and adds the value; the reply to a setting is its
// letter. Each ends with a zero. The reply to an unknown command is "e?", a newline and a zero.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.hpp"
#include "haptics/hand/glove_frames.hpp"
#include "haptics/hand/skeleton.hpp"

namespace bolt::hand {

struct GloveIdentity {
    std::size_t sensors = 0;  // 18 or 22
    Side hand = Side::right;
    bool plugged = true;  // the glove is connected to its interface unit
    std::string version;  // of the firmware; empty for old ones that do not report it
};

struct GloveHandshakeOptions {
    double rate = 80.0;          // requested samples per second
    double quiet = 0.06;         // s without a byte: streaming has stopped
    double patience = 0.3;       // s until a reply times out
    int tries = 3;               // attempts per query
    double longest_quiet = 1.0;  // s until a line that keeps sending is rejected
};

class GloveHandshake {
  public:
    explicit GloveHandshake(const GloveHandshakeOptions& options = {}) : options_(options) {}

    // `received`: bytes since the last call; `now`: s on a monotonic clock. Returns the bytes to send,
    // possibly none. Call until done() or failed(): when bytes arrive, and at least every 20 ms.
    std::vector<std::uint8_t> update(std::span<const std::uint8_t> received, double now);

    [[nodiscard]] bool done() const { return step_ == Step::streaming; }
    [[nodiscard]] const std::optional<Error>& failed() const { return failed_; }
    [[nodiscard]] const GloveIdentity& identity() const { return identity_; }

  private:
    enum class Step : std::uint8_t {
        silencing,
        sensors,
        samples,
        set_samples,
        hand,
        plugged,
        version,
        no_status,
        no_time,
        rate,
        streaming
    };
    using Bytes = std::vector<std::uint8_t>;

    [[nodiscard]] Bytes question() const;
    bool take_answer();
    bool take_value(std::uint8_t value);
    Bytes ask(Step step, double now);
    void give_up(std::string what, std::string expected);

    GloveHandshakeOptions options_;
    GloveIdentity identity_;
    std::optional<Error> failed_;
    Bytes answer_;
    Step step_ = Step::silencing;
    bool started_ = false;
    double since_ = 0.0, last_byte_ = 0.0;
    int tries_ = 0;
    std::uint8_t samples_ = 0;  // sampling mode that the glove reports
};

}  // namespace bolt::hand
