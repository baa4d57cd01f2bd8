#include "tests/trainer_app/seat.hpp"

#include <doctest/doctest.h>

namespace bolt::test {

void Seat::push(words::Key label, float off) {
    for (int i = 0; i < 2; ++i) frame();  // new panels have found their size
    for (const trainer::ButtonPlace& button : app().buttons()) {
        if (button.label != label) continue;
        const glm::dvec2 at(button.middle + glm::vec2(0.5F * off * button.width, 0.0F));
        press(at);
        release(at);
        frame();
        return;
    }
    FAIL("nothing is called " << label.row().name);
}

}  // namespace bolt::test
