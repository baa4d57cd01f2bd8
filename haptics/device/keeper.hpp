// Keeps one device usable: opens it, again whenever it is lost or has fallen mute, ever less often while it
// is not there; says in words what is wrong; and leaves no force on it that nobody wants any more. Pure but
// for its device and its clock; line.hpp gives it a thread.
#pragma once

#include <cstdint>

#include "engine/base/function_ref.hpp"
#include "haptics/device/device.hpp"
#include "haptics/device/timer.hpp"

namespace bolt::device {

struct KeeperOptions {
    double first_pause = 0.05, longest_pause = 1.0;  // s between two tries to open; doubled each time
    // s without a new order, then the device gets no force: with a turn and a write it has none after 20 ms.
    double stale = 0.015;
    double silence = 0.25;  // s without a sound sample: it is said
    double mute = 1.0;      // s of that: it is closed and opened anew
};

// What is wanted of a device. Nothing that was wanted before it was opened is ever rendered.
struct Order {
    force::OutputCommand command;
    bool enabled = false;
    std::uint64_t number = 0;  // another one is a new order
};

enum class State : std::uint8_t {
    absent,  // not open
    silent,  // open, and says nothing, or nothing of sense
    usable,
};

struct Report {
    State state = State::absent;
    std::string trouble;                             // in words, and what would help; empty: none
    std::shared_ptr<const Description> description;  // as it was when it was opened last; none: never
    std::uint64_t openings = 0, refusals = 0;        // tries to open it, by how they ended
    std::uint64_t losses = 0;                        // by an error of its own
    std::uint64_t silences = 0;                      // closed because it had fallen mute
    std::uint64_t samples = 0, malformed = 0;
    std::uint64_t writes = 0;
    std::uint64_t lapses = 0;  // how often orders stayed away while there was a force
};

class Keeper {
  public:
    Keeper(Open open, Timer timer, const KeeperOptions& options = {});
    Keeper(const Keeper&) = delete;
    Keeper& operator=(const Keeper&) = delete;
    ~Keeper();  // closes

    // One turn: waits for a sample, or for the next try to open, at most some milliseconds; then writes what
    // `order` gives. None: nothing new, or no sample of sense.
    std::optional<Sample> turn(FunctionRef<Order()> order);

    // Without force, if it can still be told.
    void close();

    [[nodiscard]] const Report& report() const { return report_; }

  private:
    bool try_open(std::uint64_t number);
    Status write(const Order& order, double now);
    void lose(const Error& error);
    void listen(bool heard, double now);
    [[nodiscard]] bool sound(const Sample& sample) const;
    [[nodiscard]] bool must_speak() const;

    Open open_;
    Timer timer_;
    KeeperOptions options_;
    Report report_;
    std::unique_ptr<Device> device_;
    double patience_ = 0.0;
    double pause_ = 0.0, next_try_ = 0.0;  // s
    double heard_ = 0.0;                   // when it last gave a sound sample
    std::uint64_t order_ = 0;              // number of the newest order
    double ordered_ = 0.0;                 // when it was first seen
    bool rendering_ = false;               // the last write was no zero
    bool forced_ = false;                  // nor is it known to be without force otherwise
};

}  // namespace bolt::device
