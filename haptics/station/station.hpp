// A station at work: devices on their lines, a glove on its own, and the servo's thread between them. Others
// look on and wish; nobody who does either holds up a tick.
#pragma once

#include <filesystem>

#include "haptics/glove/driver.hpp"
#include "haptics/servo/thread.hpp"
#include "haptics/station/hand.hpp"
#include "haptics/station/traffic.hpp"

namespace bolt::station {

struct Plan {
    device::Open mover, wheel;  // empty: none
    Buttons mover_buttons, wheel_buttons;
    force::Workspace workspace;
    Pose home;
    std::filesystem::path glove;       // its port; empty: none
    std::optional<HandPlan> hand;      // that wears it; none: nobody does, and what is gripped is wished
    double patience = 3.0;             // s for the devices to open
    device::LineOptions line{{}, 70};  // below the servo's priority
    Wishes wishes;                     // until somebody wishes otherwise
    servo::ThreadOptions servo;
    // What is worked on, for what the devices render and the servo's dt; and how it stands at the beginning.
    std::function<servo::Setup(const force::OutputLimits& limits, double dt)> setup;
    std::function<Result<servo::State>(const servo::Setup& setup)> state;  // empty: as servo::initial_state
};

// A tick, for who records all of them.
struct Ticked {
    std::uint64_t number = 0;  // deadlines that had no tick are counted
    servo::Input input;
    servo::Output output;
    Pose tool;                 // where the hand has it
    std::optional<Pose> lies;  // where the wrench lies that is in no hand (Wishes::rest)
    bool pressed = false;      // the button that closes a hand, of a device
};

class Station {
  public:
    // Waits for the devices; an error says which one does not come and what to do. Those that are lost later
    // are waited for at work.
    static Result<Station> start(Plan plan);

    Station(Station&&) noexcept;
    Station& operator=(Station&&) noexcept;
    ~Station();  // stops; the devices are left without force

    // For one caller each; newest() and troubles() for the same one.
    void wish(const Wishes& wishes);
    const Ticked& newest();
    bool next(Ticked& tick);                   // every one in turn; false: no more for now
    [[nodiscard]] std::uint64_t lost() const;  // ticks that nobody took in time

    // The gloved hand as it is now; null: none. For one caller.
    const ShownHand* hand();

    // What is wrong, in words, worst first; empty: nothing. As it was at most a tenth of a second ago.
    std::vector<std::string> troubles();

    // How it goes with each device and with the glove, gloved hand or not; null: there is none. Of the
    // traffic the newest tick's. For the caller of troubles().
    const device::Report* mover();
    const device::Report* wheel();
    const glove::Report* gloved();
    const Passed& passed();

    [[nodiscard]] const Layout& layout() const;
    [[nodiscard]] const servo::Setup& setup() const;
    [[nodiscard]] glove::Driver* glove();  // null: none, or a hand is in it
    [[nodiscard]] servo::Thread& servo();
    void stop();

  private:
    struct Shared;
    explicit Station(std::unique_ptr<Shared> shared);
    std::unique_ptr<Shared> shared_;
};

}  // namespace bolt::station
