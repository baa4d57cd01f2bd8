// A simulated user who plays with the free hand: sees hand, nut and obstacles, and corrects by dragging what
// is still wrong. It presses both mouse buttons, the wheel and the keys that show the nut and take the
// wrench.
//
// A search replaces the eye: the side of the nut on which the handle has room and the way there are those
// that the helped hand would choose. The mouse alone moves the wrench along that way.
#pragma once

#include <functional>

#include "game/motion/path_planning.hpp"
#include "tests/trainer_app/trainer_driver.hpp"

namespace bolt::test {

class FreeHandUser {
  public:
    explicit FreeHandUser(TrainerDriver& driver) : driver_(driver) {}

    // Until the lesson is over, has lasted `longest` s, or has reached step `steps`.
    void play(double longest, std::size_t steps = SIZE_MAX);

    double torque_share = 1.0;  // of the due torque
    std::function<void()> on_frame = [] {};
    int presses = 0;     // of the left button
    int new_starts = 0;  // approaches that did not get the jaw onto the nut

  private:
    [[nodiscard]] const trainer::ActiveLesson& lesson() const { return driver_.lesson(); }
    [[nodiscard]] const servo::Setup& setup() const { return lesson().session->setup(); }
    [[nodiscard]] const servo::State& state() const { return lesson().session->state(); }
    [[nodiscard]] const lesson::LessonStep* due() const { return lesson().session->lesson().due(); }
    [[nodiscard]] bool going() const { return driver_.app().screen() == trainer::ShownScreen::lesson; }
    [[nodiscard]] bool going_on(std::size_t joint) const;
    [[nodiscard]] double now() const { return lesson().session->time(); }
    [[nodiscard]] int engaged() const { return state().engagement.joint; }
    [[nodiscard]] Vec3 nut() const;   // centre of the due nut, m
    [[nodiscard]] Vec3 axis() const;  // of the due nut
    [[nodiscard]] Pose hand() const;
    [[nodiscard]] Vec3 handle_end(const Pose& pose) const;  // the point that a drag moves, m
    [[nodiscard]] bool beside_bolt() const;

    // Presses or releases the left button at a place that leaves room to drag towards `direction`; with `at`
    // (m, assembly) there.
    void hold(bool left, const std::optional<Vec3>& at = {}, const glm::dvec2& direction = glm::dvec2(0.0));
    void turn(bool right);  // holds the right button too, or releases it
    [[nodiscard]] glm::dvec2 free_place(const glm::dvec2& direction) const;
    // Moves the pointer by a drag of `px` and the wheel by `notches` in a frame.
    void frame(const glm::dvec2& px = glm::dvec2(0.0), double notches = 0.0);
    void wait(double seconds);

    // One frame towards `target`: a part of the way that remains.
    void drag_by(const Vec3& error);
    void turn_by(double angle, const Vec3& about);
    // Leads the hand to `target` to within `near` m. Returns false if it does not get there in `longest` s or
    // the jaw engages a nut. `turned`: turns the wrench too.
    bool lead_to(const Pose& target, double near, double longest, bool turned = true);
    [[nodiscard]] bool sees(const Vec3& point) const;
    void look(const Vec3& goal);
    void run_down();
    void take_wrench();
    [[nodiscard]] motion::HandleAngle choose_side() const;
    [[nodiscard]] std::vector<Pose> way_to(const Pose& over) const;
    bool approach();
    bool lower(const Pose& seated);
    void push_down();
    void tighten();
    void pull();
    void lift();

    TrainerDriver& driver_;
    glm::dvec2 pointer_{80.0, 45.0};
    double notches_ = 0.0;    // of the wheel, too few for a whole one yet
    double seconds_ = 0.05;   // of the last frame
    double room_ = 0.0;       // rad, of the present grip
    std::size_t misses_ = 0;  // at the due nut
    bool left_ = false, right_ = false;
};

}  // namespace bolt::test
