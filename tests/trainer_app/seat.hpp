// Somebody's place at the trainer, in a window or without one: pictures come, and there are keys and a mouse.
#pragma once

#include "game/trainer/app.hpp"
#include "game/trainer/pointing.hpp"

namespace bolt::test {

class Seat {
  public:
    virtual ~Seat() = default;

    // The next picture. So do the others below when they have done what they say.
    virtual void frame() = 0;
    virtual void key(platform::Key key) = 0;       // pressed and let go
    virtual void move(const glm::dvec2& to) = 0;   // px
    virtual void press(const glm::dvec2& at) = 0;  // px, goes there first
    virtual void release(const glm::dvec2& at) = 0;

    [[nodiscard]] virtual const trainer::App& app() const = 0;
    [[nodiscard]] virtual glm::dvec2 size() const = 0;  // px

    // Presses on what has that label, so far from its middle (of half its width). It has to be there.
    void push(words::Key label, float off = 0.0F);
    [[nodiscard]] const trainer::ActiveLesson& playing() const { return *app().playing(); }
    [[nodiscard]] trainer::Screen screen() const { return trainer::screen_of(playing(), size()); }

  protected:
    Seat() = default;
    Seat(const Seat&) = default;
    Seat& operator=(const Seat&) = default;
};

}  // namespace bolt::test
