// Interface to a running trainer for tests, with or without a window: input by keys and mouse, frame by
// frame.
#pragma once

#include "game/trainer/app.hpp"
#include "game/trainer/pointing.hpp"

namespace bolt::test {

class TrainerDriver {
  public:
    virtual ~TrainerDriver() = default;

    // Runs the next frame. The inputs below run one or more frames too.
    virtual void frame() = 0;
    virtual void key(platform::Key key) = 0;       // press and release
    virtual void move(const glm::dvec2& to) = 0;   // px
    virtual void press(const glm::dvec2& at) = 0;  // px, moves there first
    virtual void release(const glm::dvec2& at) = 0;
    // Presses or releases the right button while the left is held: a free hand then turns the tool.
    virtual void turn_button(const glm::dvec2& at, bool down) = 0;
    // Moves the pointer, px, and turns the wheel by whole notches, positive upwards, in one frame.
    virtual void drag(const glm::dvec2& to, int notches) = 0;

    [[nodiscard]] virtual const trainer::App& app() const = 0;
    [[nodiscard]] virtual glm::dvec2 size() const = 0;  // px

    // Clicks the button with this label, at `off` half widths from its middle. Fails the test if there is
    // none.
    void press_button(words::TextKey label, float off = 0.0F);
    [[nodiscard]] const trainer::ActiveLesson& lesson() const { return *app().lesson(); }
    [[nodiscard]] trainer::Projection projection() const { return trainer::projection_of(lesson(), size()); }

  protected:
    TrainerDriver() = default;
    TrainerDriver(const TrainerDriver&) = default;
    TrainerDriver& operator=(const TrainerDriver&) = default;
};

}  // namespace bolt::test
