#include "tests/trainer_app/trainer_driver.hpp"

#include <doctest/doctest.h>

namespace bolt::test {

void TrainerDriver::press_button(words::TextKey label, float off) {
    for (int i = 0; i < 2; ++i) frame();  // until new panels have their final size
    for (const trainer::DrawnWidget& button : app().drawn_widgets()) {
        if (button.label != label) continue;
        const glm::dvec2 at(button.middle + glm::vec2(0.5F * off * button.width, 0.0F));
        press(at);
        release(at);
        frame();
        return;
    }
    FAIL("no button with the label " << label.row().name);
}

}  // namespace bolt::test
