// A device that is not there: it goes a scripted way, gives way to the forces that it renders if a hand holds
// it, and fails in the ways that real ones do, when it is told to. On a clock of any kind; its thread's
// alone, but for tests in virtual time, which have no threads.
#pragma once

#include "haptics/device/device.hpp"
#include "haptics/device/timer.hpp"

namespace bolt::device {

enum class Mishap : std::uint8_t {
    unplugged,  // errors, and cannot be opened; the motors have no power
    silent,     // says nothing; hears, and keeps the force that it has
    stuck,      // neither reading nor writing comes back before it is over
    slow,       // each write takes 15 ms
    no_number,  // the hand's pose is no number
    jumped,     // the hand's pose is half a metre off
};
inline constexpr std::size_t mishaps = 6;
inline constexpr double slow_write = 0.015;  // s

struct Trouble {
    Mishap what = Mishap::silent;
    double from = 0.0, until = 0.0;  // s of the clock
};

// What holds it: a mass between the device's force and a spring to where the hand means to be. Chosen: a
// relaxed grip, as tests/support/simulated_arm.hpp has it in the middle of its ranges.
struct HoldingHand {
    double mass = 0.3, stiffness = 300.0, damping = 10.0;          // kg, N/m, N·s/m
    double inertia = 2e-3, torsion = 2.0, angular_damping = 0.05;  // kg·m², N·m/rad, N·m·s/rad
};

struct SimulatedDesign {
    Description description;
    std::function<Sample(double time)> script;  // what the hand means to do
    std::optional<HoldingHand> hand;            // none: it does so, whatever the force
    std::vector<Trouble> troubles;
};

// The thing itself, plugged in or not; what is opened is a line to it, which it must outlive.
class Simulated {
  public:
    Simulated(SimulatedDesign design, Timer timer);

    [[nodiscard]] Open open();
    void happen(const Trouble& trouble);

    // For those who look on: what is at the hand at this moment, and the hand.
    [[nodiscard]] force::OutputCommand rendered() const;
    [[nodiscard]] const Sample& hand() const { return now_; }
    [[nodiscard]] bool befallen(Mishap what) const;

  private:
    class Plug;
    void advance();
    bool cut();
    void step(const Sample& meant, double dt);
    [[nodiscard]] const Trouble* find(Mishap what) const;

    SimulatedDesign design_;
    Timer timer_;
    force::OutputCommand command_;
    Sample now_;
    Vec3 velocity_{0.0}, angular_velocity_{0.0};
    double turn_rate_ = 0.0;
    double time_ = 0.0;  // s, of `now_`
    bool begun_ = false;
};

}  // namespace bolt::device
