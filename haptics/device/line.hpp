// A device on a thread of its own, and the mailboxes between that and the servo: the newest order goes in,
// the newest sample comes out, and whoever asks never waits, whatever the device does.
#pragma once

#include <atomic>

#include "engine/base/triple_buffer.hpp"
#include "haptics/device/keeper.hpp"

namespace bolt::device {

// What the servo sees of a device.
struct Told {
    Sample sample;              // the newest of sense
    std::uint64_t number = 0;   // of samples; 0: none yet
    std::uint64_t opening = 0;  // in which it came; another one: the hand may be anywhere
    bool usable = false;        // false: what the sample says is over
};

struct Mailboxes {
    TripleBuffer<Order> orders;
    TripleBuffer<Told> told;
    TripleBuffer<Report> reports;
};

// One turn of a keeper between mailboxes: what the thread does over and over, and a test in virtual time.
// `told` is the last that was told.
void serve(Keeper& keeper, Mailboxes& boxes, Told& told);

struct LineOptions {
    KeeperOptions keeper;
    int priority = 0;  // of SCHED_FIFO, 1 … 99, where that is allowed; 0: it is not asked for
};

class Line {
  public:
    // Returns at once; the thread opens the device, and again whenever it has to.
    static Result<Line> start(Open open, const LineOptions& options = {});

    Line(Line&&) noexcept;
    Line& operator=(Line&&) noexcept;
    ~Line();  // stops: the device is left without force and closed

    // For one caller each, and never waiting: the servo.
    void order(const force::OutputCommand& command, bool enabled);
    const Told& told();

    // For one caller, another one if need be. As it was at most a tenth of a second ago.
    const Report& report();

    // s since its thread came back from the device last: a driver may hang, and its report with it.
    [[nodiscard]] double away() const;

    // What the device is, once it is open; after `patience` s the reason why it is not. May wait; takes from
    // report().
    Result<std::shared_ptr<const Description>> await(double patience);

  private:
    struct Shared;
    explicit Line(std::unique_ptr<Shared> shared);
    std::unique_ptr<Shared> shared_;
};

}  // namespace bolt::device
