// What somebody who plays a lesson at a station needs of it. The station of a plan keeps its own time; tests
// have one whose time stands until they want the next tick.
#pragma once

#include "haptics/device/puck.hpp"
#include "haptics/station/station.hpp"

namespace bolt::station {

class Bench {
  public:
    Bench() = default;
    Bench(const Bench&) = delete;
    Bench& operator=(const Bench&) = delete;
    virtual ~Bench() = default;

    virtual void wish(const Wishes& wishes) = 0;
    // What mouse and keyboard push, where no device moves the tool; with every picture.
    virtual void push(const device::Push& push) = 0;
    virtual bool next(Ticked& tick) = 0;  // every one in turn; false: no more for now
    // As they are now: where the tool is, and what is pressed, also while nobody works.
    virtual const Ticked& newest() = 0;
    [[nodiscard]] virtual std::uint64_t lost() const = 0;
    virtual const ShownHand* hand() = 0;  // null: no glove is worn
    virtual std::vector<std::string> troubles() = 0;

    [[nodiscard]] virtual const Layout& layout() const = 0;
    [[nodiscard]] virtual const servo::Setup& setup() const = 0;

    // Ends it, without force; how its thread has kept its time, null without one.
    virtual const servo::Timing* stop() = 0;
};

// The plan's station, at work. `puck`: what moves the tool where no device does.
Result<std::unique_ptr<Bench>> start_bench(Plan plan, std::optional<device::Puck> puck);

}  // namespace bolt::station
