// A simulated user who plays with the free hand: sees the hand and the nut in the picture, and corrects by
// dragging what is still wrong. It presses only the left button, Shift and the wheel.
#pragma once

#include <functional>

#include "tests/trainer_app/trainer_driver.hpp"

namespace bolt::test {

class FreeHandUser {
  public:
    explicit FreeHandUser(TrainerDriver& driver) : driver_(driver) {}

    // Until the lesson is over, has lasted `longest` s, or has reached step `steps`.
    void play(double longest, std::size_t steps = SIZE_MAX);

    double torque_share = 1.0;  // of the due torque
    std::function<void()> on_frame = [] {};
    int presses = 0;  // of the left button

  private:
    [[nodiscard]] const trainer::ActiveLesson& lesson() const { return driver_.lesson(); }
    [[nodiscard]] const lesson::LessonStep* due() const { return lesson().session->lesson().due(); }
    [[nodiscard]] bool going() const { return driver_.app().screen() == trainer::ShownScreen::lesson; }
    [[nodiscard]] double now() const { return lesson().session->time(); }
    [[nodiscard]] int engaged() const { return lesson().session->state().engagement.joint; }
    [[nodiscard]] Vec3 nut() const;
    [[nodiscard]] Vec3 axis() const;
    [[nodiscard]] Pose hand() const;

    // Presses or releases the left button; presses at `at` (m, assembly) if given, else where nothing is.
    void hold(bool left, const std::optional<Vec3>& at = {});
    // Moves the pointer by a drag of `px` and the wheel by `notches` in a frame.
    void frame(const glm::dvec2& px = glm::dvec2(0.0), double notches = 0.0);
    // Drags `at` by a part of `error` (m).
    void drag_by(const Vec3& at, const Vec3& error);
    // Leads the jaw or the fingers to a point above the nut, with the handle at `angle` (rad) from where it
    // fits.
    bool reach(double height, double longest);
    void run_down();
    void tighten();
    void lift();

    TrainerDriver& driver_;
    glm::dvec2 pointer_{80.0, 45.0};
    double notches_ = 0.0;  // of the wheel, too few for a whole one yet
    bool left_ = false;
};

}  // namespace bolt::test
