// A simulated trainee in a room: it looks at the workpiece, and its hand, which a headset tracks, reaches,
// closes, turns and opens. It sees what a person sees: the nuts, the wrench and how they move.
#pragma once

#include <functional>

#include "game/motion/path_planning.hpp"
#include "game/trainer/app.hpp"

namespace bolt::test {

// Two eyes at `head`, 63 mm apart, for pictures of this size.
view::EyeGroup two_eyes(const Pose& head, VkExtent2D size);

// The head of a user who stands at the room's origin, eyes 1.65 m above the floor, and looks a little down.
Pose standing_head();

// A room whose user stands at its origin, eyes 1.65 m above the floor.
view::ImmersiveFrame standing_user(VkExtent2D size);

// A running trainer and the display whose poses it gets. The trainee decides the poses; a driver delivers
// them: into the next immersive frame, or through a headset's runtime.
class RoomDriver {
  public:
    RoomDriver() = default;
    RoomDriver(const RoomDriver&) = delete;
    RoomDriver& operator=(const RoomDriver&) = delete;
    virtual ~RoomDriver() = default;

    // Moves head and hands there, poses in the room's frame, and runs the next frame.
    virtual void frame(const Pose& head, const xr::Hands& hands) = 0;
    [[nodiscard]] virtual const trainer::App& app() const = 0;
    [[nodiscard]] virtual double step() const = 0;  // s of the lesson per frame
};

class TraineeInRoom {
  public:
    explicit TraineeInRoom(RoomDriver& driver, xr::Side side = xr::Side::right)
        : driver_(driver), side_(side) {}

    // Until the lesson is over, has lasted `longest` s, or has reached step `steps`.
    void play(double longest, std::size_t steps = SIZE_MAX);

    Pose head = standing_head();  // in the room; turns to what the hand does
    double torque_share = 1.0;    // of the due torque
    std::function<void()> on_frame = [] {};
    int approaches = 0;  // of the wrench to a nut

    // One frame with the palm at this pose of the assembly's frame; `closed`: 0 … 1.
    void frame(const Pose& palm, double closed);
    void hold_still(double seconds, double closed);
    // Leads the fingertips, or the wrench in the hand, to `target` to within `near` m, for `longest` s at
    // most. Returns false if it does not get there or the tool engages a nut.
    bool lead_to(const Pose& target, double near, double longest, double closed);
    [[nodiscard]] const Pose& palm() const { return palm_; }

  private:
    [[nodiscard]] const trainer::ActiveLesson& lesson() const { return *driver_.app().lesson(); }
    [[nodiscard]] const servo::Setup& setup() const { return lesson().session->setup(); }
    [[nodiscard]] const servo::State& state() const { return lesson().session->state(); }
    [[nodiscard]] bool going() const { return driver_.app().screen() == trainer::ShownScreen::lesson; }
    [[nodiscard]] bool going_on(std::size_t joint) const;
    [[nodiscard]] int engaged() const { return state().engagement.joint; }
    [[nodiscard]] const lesson::LessonStep* due() const { return lesson().session->lesson().due(); }
    [[nodiscard]] double now() const { return lesson().session->time(); }
    [[nodiscard]] Vec3 nut(std::size_t joint) const;  // its centre, m
    [[nodiscard]] Pose tool() const;                  // or the fingertips, as shown
    [[nodiscard]] bool wrench() const { return trainer::hand_of(lesson()).wrench; }
    // The palm, moved and turned so that the tool's reference point moves by `along` and it turns by `about`.
    [[nodiscard]] Pose moved_palm(const Vec3& along, const Vec3& about) const;
    void look_at(const Vec3& target);
    void run_down(std::size_t joint);
    void twist(double angle, const Vec3& axis, double closed);
    void take_wrench();
    void tighten(std::size_t joint);
    bool lower(std::size_t joint, const Pose& seated);
    void pull(std::size_t joint, double room);
    void lift(const Vec3& up);

    RoomDriver& driver_;
    xr::Side side_;
    Pose palm_{{0.25, 0.35, 0.45}, {1.0, 0.0, 0.0, 0.0}};  // assembly frame
};

}  // namespace bolt::test
