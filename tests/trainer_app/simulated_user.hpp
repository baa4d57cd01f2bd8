// A simulated user who completes the due steps with the mouse only, and presses only what the picture shows.
#pragma once

#include "tests/trainer_app/trainer_driver.hpp"

namespace bolt::test {

class SimulatedUser {
  public:
    explicit SimulatedUser(TrainerDriver& driver) : driver_(driver) {}

    // Until the lesson is over, has lasted `longest` s, or has reached step `steps`.
    void play(double longest, std::size_t steps = SIZE_MAX);
    // Lets `seconds` of the lesson pass.
    void wait(double seconds);

    int presses = 0, view_searches = 0;
    double torque_share = 1.0;  // of the due torque

  private:
    [[nodiscard]] const trainer::ActiveLesson& lesson() const { return driver_.lesson(); }
    [[nodiscard]] const lesson::LessonStep* due() const { return lesson().session->lesson().due(); }
    [[nodiscard]] bool going() const { return driver_.app().screen() == trainer::ShownScreen::lesson; }
    [[nodiscard]] double now() const { return lesson().session->time(); }

    void do_step();
    // Position of the due nut in px; none if a press there would not select it.
    std::optional<glm::dvec2> nut_on_screen();
    // Continue the drag by a frame. Return true when the goal is reached or the room used up.
    bool spin(const glm::dvec2& from, glm::dvec2& pointer);
    bool pull(std::size_t joint, glm::dvec2& pointer);

    TrainerDriver& driver_;
    double dragged_ = 0.0;  // s, time of the last drag
};

}  // namespace bolt::test
