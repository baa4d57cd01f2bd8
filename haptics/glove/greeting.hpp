// The talk with a glove before it streams: what it is, and that it sends what we read. Pure: bytes and time
// in, bytes out.
//
// A query '?' and a letter is answered by both and the value, a setting by its letter, all with a zero at the
// end; what a glove does not know it answers by "e?", a line's end and a zero.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.hpp"
#include "haptics/glove/frames.hpp"

namespace bolt::glove {

enum class Hand : std::uint8_t { left, right };

struct Identity {
    std::size_t sensors = 0;  // 18 or 22
    Hand hand = Hand::right;
    bool plugged = true;  // the glove into its box
    std::string version;  // of the firmware; may be empty: old ones do not tell
};

struct GreetingOptions {
    double rate = 80.0;          // 1/s, of samples
    double quiet = 0.06;         // s without a byte: it has stopped streaming
    double patience = 0.3;       // s for an answer
    int tries = 3;               // of each question
    double longest_quiet = 1.0;  // s: a line that is not quiet by then is no glove's
};

class Greeting {
  public:
    explicit Greeting(const GreetingOptions& options = {}) : options_(options) {}

    // What came in since the last call, and the time now (s, of any clock that goes on). What to send; may be
    // empty. To be called until done() or failed(), when something came and at least every 20 ms.
    std::vector<std::uint8_t> go_on(std::span<const std::uint8_t> received, double now);

    [[nodiscard]] bool done() const { return step_ == Step::streaming; }
    [[nodiscard]] const std::optional<Error>& failed() const { return failed_; }
    [[nodiscard]] const Identity& identity() const { return identity_; }

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

    GreetingOptions options_;
    Identity identity_;
    std::optional<Error> failed_;
    Bytes answer_;
    Step step_ = Step::silencing;
    bool started_ = false;
    double since_ = 0.0, last_byte_ = 0.0;
    int tries_ = 0;
    std::uint8_t samples_ = 0;  // that it sends now
};

}  // namespace bolt::glove
