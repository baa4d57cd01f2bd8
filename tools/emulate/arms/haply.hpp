// An emulated Haply service on this computer, with one Inverse3 and a grip (haply_model.hpp), in real time.
#pragma once

#include <memory>

#include "engine/base/result.hpp"
#include "tools/emulate/arms/haply_model.hpp"

namespace bolt::emulate {

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
    [[nodiscard]] std::uint64_t commands() const;  // messages with a force in the format of this version
    [[nodiscard]] std::uint64_t rejected() const;  // other messages
    // True once the fault has taken effect: in an answer, as a missing answer, or as an event that was sent.
    [[nodiscard]] bool fault_shown() const;
    // s from when the fault took effect until the force on the hand ended; 0 if the force had ended before.
    [[nodiscard]] double force_after_fault() const;

  private:
    struct Service;
    explicit EmulatedHaply(std::unique_ptr<Service> service);
    std::unique_ptr<Service> service_;
};

}  // namespace bolt::emulate
