// A lesson on a station with an emulated arm, which a simulated trainee plays: through the driver, the
// thread's supervisor, and the station's tick, in virtual time.
#pragma once

#include <optional>

#include "game/session/lesson_session.hpp"
#include "game/trainees/trainee.hpp"
#include "haptics/device/device_thread.hpp"
#include "haptics/station/station_tick.hpp"
#include "tests/arm_lesson/held_arm.hpp"

namespace bolt::test {

// The largest values of a lesson, on the hand.
struct FeltForces {
    double force = 0.0, torque = 0.0;  // N, N·m
    double force_step = 0.0;           // N from one tick to the next
    double force_on_bolt = 0.0;        // N while the wrench is on a nut
    double torque_on_bolt = 0.0;       // N·m, likewise
    std::uint64_t clutched = 0;        // times that the clutch was pressed
    double largest_tool_jump = 0.0;    // m in one tick
};

class PlayedLesson {
  public:
    PlayedLesson(HeldArm& arm, const content::Assembly& assembly, session::LessonOptions options,
                 const std::filesystem::path& file);

    // One tick of 1 ms.
    void tick();

    [[nodiscard]] bool finished() const { return session_->finished(); }
    [[nodiscard]] const session::LessonSession& session() const { return *session_; }
    [[nodiscard]] const FeltForces& felt() const { return felt_; }
    [[nodiscard]] const device::DeviceStatus& status() const { return supervisor_->status(); }
    [[nodiscard]] const station::DeviceLayout& layout() const { return layout_; }
    [[nodiscard]] const station::StationTick& latest() const { return latest_; }
    session::LessonOutcome finish();

    // The emulated hand lets the arm be; the trainee waits.
    bool hand_rests = false;

  private:
    struct Clutching {
        double elapsed = 0.0, duration = 0.0;  // s
        Vec3 from{0.0}, to{0.0};               // m, device frame
    };
    void serve();
    void move_hand(const trainees::IntendedPose& intention);
    [[nodiscard]] Pose device_pose(const Pose& tool) const;
    void measure(const station::StationTick& before);

    HeldArm& arm_;
    std::unique_ptr<device::DeviceSupervisor> supervisor_;
    device::DeviceMailboxes mailboxes_;
    device::DeviceSnapshot snapshot_;
    station::DeviceLayout layout_;
    session::SessionSetup station_;  // the station's own servo
    station::StationState state_;
    station::StationControls controls_;
    std::unique_ptr<session::LessonSession> session_;
    world::World world_;
    std::optional<trainees::SimulatedTrainee> trainee_;
    trainees::IntendedPose intention_;
    station::StationTick latest_;
    FeltForces felt_;
    Vec3 last_force_{0.0};
    Pose hand_;       // that the hand intends, device frame
    Vec3 push_{0.0};  // m, by which it leads to hold a steady force
    std::optional<Clutching> clutching_;
    double settling_ = 0.0;  // s until the trainee goes on after the clutch
    double now_ = 0.0;       // s
    std::uint64_t number_ = 0, command_number_ = 0;
    std::uint32_t checkpoints_sent_ = 0;
};

}  // namespace bolt::test
