// An emulated Haply service on this computer, with one Inverse3 and a grip that a hand holds: mass, friction,
// and a spring to an intended position. SI units; the service's frame (x to the right, y forward, z up) with
// its origin in the middle of the reach. Messages: Haply's documentation of the service, 3.1 to 3.5.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "engine/base/math.hpp"
#include "engine/base/result.hpp"

namespace bolt::emulate {

enum class HaplyGrip : std::uint8_t { none, wired, wireless };

enum class HaplyFault : std::uint8_t {
    none,
    // Instead of the next answer:
    close,     // the connection ends
    silence,   // nothing, from now on
    nonsense,  // text that is not JSON
    array,     // JSON that is no object
    huge,      // 200 kB
    // In every answer from now on:
    null_position,
    text_position,
    no_position,
    overflow,     // a number beyond the range of double
    millimetres,  // positions in the wrong unit
    turn,         // an orientation that is no unit quaternion
    uncalibrated,
    missing,  // the arm is not among the devices
    // The arm renders no more force, and an event says so:
    disconnected,
    brake,
    stall,
};

struct EmulatedHaplyOptions {
    std::uint16_t port = 0;           // of the states; 0: any. Events are at port + 19.
    std::string version = "3.5.0.0";  // before 3.5 it answers /version at port - 1; empty: at no port
    HaplyGrip grip = HaplyGrip::wireless;
    bool arm = true;
    bool calibrated = true;
    bool centred = false;           // positions are from the middle of the reach, not from the base
    std::string type = "inverse3";  // empty: not reported
    std::string basis = "XYZ";
    double command_lifetime = 5e-3;  // s that one message keeps a force
    double answer_delay = 0.0;       // s from a message to its answer
    // The hand that holds the arm.
    double mass = 0.4;         // kg, of both
    double friction = 12.0;    // N·s/m
    double stiffness = 300.0;  // N/m, of the spring to the intended position
};

class EmulatedHaply {
  public:
    // Fails if the port is in use.
    static Result<std::unique_ptr<EmulatedHaply>> start(const EmulatedHaplyOptions& options = {});
    EmulatedHaply(const EmulatedHaply&) = delete;
    EmulatedHaply& operator=(const EmulatedHaply&) = delete;
    ~EmulatedHaply();  // closes all connections

    [[nodiscard]] std::uint16_t port() const;

    // From any thread.
    void intend(const Vec3& position);  // where the hand wants to be, m
    void turn(const Quat& orientation);
    void press(std::uint32_t buttons);  // bit 0: the wired grip's button or a, bit 1: b, bit 2: c
    void set_fault(HaplyFault fault);

    [[nodiscard]] Vec3 position() const;           // m
    [[nodiscard]] Vec3 force() const;              // N that acts on the hand now
    [[nodiscard]] std::uint64_t commands() const;  // messages with a force in the form of this version
    [[nodiscard]] std::uint64_t rejected() const;  // other messages
    // True once the fault has shown: in an answer, in its absence, or in an event that was sent.
    [[nodiscard]] bool fault_shown() const;
    // s from then until the last force on the hand ended; 0 if it had ended before.
    [[nodiscard]] double force_after_fault() const;

  private:
    struct Service;
    explicit EmulatedHaply(std::unique_ptr<Service> service);
    std::unique_ptr<Service> service_;
};

}  // namespace bolt::emulate
