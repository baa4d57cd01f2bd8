// An emulated Inverse3 and a grip that a hand holds: mass, friction, and a spring to an intended position.
// Speaks the messages of Haply's service (its documentation, 3.1 to 3.5). SI units; the service's frame (x to
// the right, y forward, z up) with its origin in the middle of the reach.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/math.hpp"

namespace bolt::emulate {

enum class HaplyGrip : std::uint8_t { none, wired, wireless };

enum class HaplyFault : std::uint8_t {
    none,
    // Instead of every answer from now on:
    close,     // the connection ends
    silence,   // nothing
    nonsense,  // text that is not JSON
    array,     // JSON that is no object
    huge,      // 200 kB of blanks after the answer
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
    std::uint16_t port = 0;  // of the states; 0: any. Events are at port + 19.
    // The version that the service reports at /version: at `port`, before 3.5 at port − 1. Empty: /version is
    // not served.
    std::string version = "3.5.0.0";
    HaplyGrip grip = HaplyGrip::wireless;
    bool arm = true;  // an arm is connected
    bool calibrated = true;
    bool centred = false;            // positions are from the middle of the reach, not from the base
    std::string type = "inverse3";   // empty: not reported
    std::string basis = "XYZ";       // the permutation of the axes that the service reports
    double command_lifetime = 5e-3;  // s that one message keeps a force
    double answer_delay = 0.0;       // s from a message to its answer
    // The hand that holds the arm.
    double mass = 0.4;               // kg, of both
    double viscous_friction = 12.0;  // N·s/m
    double stiffness = 300.0;        // N/m, of the spring to the intended position
};

// The arm, the hand, and the service's messages about them. Not thread-safe.
class HaplyArmModel {
  public:
    explicit HaplyArmModel(const EmulatedHaplyOptions& options) : options_(options) {}

    Vec3 intention{0.0};  // m, where the hand wants to be
    Quat orientation{1.0, 0.0, 0.0, 0.0};
    std::uint32_t buttons = 0;  // as in EmulatedHaply::press
    std::uint64_t commands = 0, rejected = 0;
    std::vector<std::string> events;  // that the service has sent

    void advance(double seconds);
    void set_fault(HaplyFault fault);

    [[nodiscard]] std::string inventory() const;  // the first message of a connection
    // nullopt: close the connection. Empty: no answer.
    std::optional<std::string> answer(const std::string& message);

    [[nodiscard]] Vec3 position() const { return position_; }
    [[nodiscard]] Vec3 force() const { return time_ < force_until_ ? force_ : Vec3(0.0); }
    [[nodiscard]] bool fault_shown() const { return fault_time_.has_value(); }
    [[nodiscard]] double force_after_fault() const {
        return fault_time_ ? std::max(force_until_ - *fault_time_, 0.0) : 0.0;
    }

  private:
    void step();
    void add_event(const char* name, const char* safety_type);
    [[nodiscard]] bool is_before_3_5() const;
    // Applies the force of a message; false if it has none in the format of this version.
    bool command(const std::string& message);
    [[nodiscard]] nlohmann::json position_json() const;
    [[nodiscard]] nlohmann::json arm_json(bool with_config) const;
    [[nodiscard]] nlohmann::json grip_json() const;
    [[nodiscard]] nlohmann::json devices(bool with_config) const;

    EmulatedHaplyOptions options_;
    Vec3 position_{0.0}, velocity_{0.0}, force_{0.0};
    double time_ = 0.0, force_until_ = 0.0;
    HaplyFault fault_ = HaplyFault::none;
    std::optional<double> fault_time_;
    bool renders_ = true;
};

}  // namespace bolt::emulate
