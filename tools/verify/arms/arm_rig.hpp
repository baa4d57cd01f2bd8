// One arm with its hand at a station on a real assembly, in virtual time: the whole chain from the encoders
// to the force on the hand (station::step), with the workspace's scale, the length of the wrench, the delay
// and the resolution of the arm.
#pragma once

#include <cstdint>
#include <string>

#include "content/format/assembly.hpp"
#include "haptics/station/station_tick.hpp"
#include "tools/verify/arms/arm_facts.hpp"

namespace bolt::arm_validation {

// An assembly with its contact models and tightened joints. A rig borrows the contact models, so each thread
// needs an assembly of its own.
struct TightenedAssembly {
    content::Assembly assembly;
    servo::State state;  // all joints tightened
};

// Fails if the assembly is invalid or has no contact models.
Result<TightenedAssembly> load_tightened_assembly(const std::string& assembly);

// Effects of the arm on the hand. Forces are those of the device.
struct Record {
    double energy = 0.0, greatest_energy = 0.0;  // J out of the device: the last value and the maximum
    double greatest_force = 0.0, greatest_torque = 0.0;  // N, N·m
    double step = 0.0, torque_step = 0.0;                // N and N·m, the largest change in a millisecond
};

struct RigOptions {
    const ArmFacts* arm = nullptr;
    NamedHandImpedance hand;
    Pose tool;                     // of the wrench at the beginning, in the assembly's frame
    bool controller = true;        // the passivity controller
    double coupling_factor = 1.0;  // on the stiffness of the coupling (contact)
    double wrench_factor = 1.0;    // on the stiffness of the wrench (seated nut)
    int guided_joint = -1;         // −1: no guiding force
};

struct ArmRig {
    ArmRig(TightenedAssembly& tightened_assembly, const RigOptions& options);
    ArmRig(const ArmRig&) = delete;
    ArmRig& operator=(const ArmRig&) = delete;
    ~ArmRig();  // gives the contact models back

    // One millisecond.
    void tick();
    // The pose of the device that commands the pose `tool`, by the present mapping of the workspace.
    [[nodiscard]] Pose device_pose(const Pose& tool) const;
    [[nodiscard]] const servo::Output& output() const { return station.output; }
    // N, that contacts exert on the tool through the coupling.
    [[nodiscard]] double contact_force() const;
    // N/m, of the coupling as the device feels it.
    [[nodiscard]] double coupling_stiffness() const;
    // N·m/rad, or N/m at the handle, of the wrench on a nut that does not turn, as the device feels it.
    [[nodiscard]] double nut_stiffness() const;

    TightenedAssembly& tightened;
    const ArmFacts& facts;
    bool unheld;
    station::DeviceLayout layout;
    servo::Setup setup;
    servo::State servo;
    station::StationState station;
    station::StationInputs inputs;
    device::ArmModel arm;
    Record record;
    force::OutputCommand command;  // of the last tick
    double time = 0.0;             // s
    std::uint64_t ticks = 0;
};

}  // namespace bolt::arm_validation
