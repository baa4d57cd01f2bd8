// Somebody who sees the picture and does what is due, by pointing, pressing and dragging alone.
#pragma once

#include "tests/trainer_app/seat.hpp"

namespace bolt::test {

class Person {
  public:
    explicit Person(Seat& seat) : seat_(seat) {}

    // Until the lesson is over, has lasted so long (s) or has come so far.
    void play(double longest, std::size_t steps = SIZE_MAX);
    // Looks on.
    void wait(double seconds);

    int presses = 0, looks = 0;
    double sought = 1.0;  // of the torque that is due

  private:
    [[nodiscard]] const trainer::ActiveLesson& p() const { return seat_.playing(); }
    [[nodiscard]] const lesson::Step* due() const { return p().course->lesson().due(); }
    [[nodiscard]] bool going() const { return seat_.app().shows() == trainer::Shows::lesson; }
    [[nodiscard]] double now() const { return p().course->time(); }

    void do_step();
    // Where the due nut is, if a press there would mean it.
    std::optional<glm::dvec2> nut_on_screen();
    // Both drag on, and say whether it is enough.
    bool spin(const glm::dvec2& from, glm::dvec2& pointer);
    bool pull(std::size_t joint, glm::dvec2& pointer);

    Seat& seat_;
    double dragged_ = 0.0;  // s, when the handle was last dragged
};

}  // namespace bolt::test
