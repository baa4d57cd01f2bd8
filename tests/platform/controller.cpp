#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <span>
#include <variant>
#include <vector>

#include "engine/platform/input.hpp"

using namespace bolt::platform;

namespace {

bool is_down(const ControllerState& state, ControllerButton button) {
    return state.down.at(static_cast<std::size_t>(button));
}

// Moves the stick to each position in turn and returns every event.
std::vector<ControllerEvent> events_of(std::span<const glm::vec2> positions) {
    std::vector<ControllerEvent> events;
    ControllerState before;
    for (const glm::vec2 position : positions) {
        ControllerState now;
        add_stick(now, before, position.x, position.y);
        for (const InputEvent& event : controller_events(before, now))
            events.push_back(std::get<ControllerEvent>(event));
        before = now;
    }
    return events;
}

}  // namespace

TEST_CASE("Controller: a stick presses the direction to which it points") {
    const struct {
        glm::vec2 position;
        ControllerButton button;
    } directions[] = {{{-1.0F, 0.1F}, ControllerButton::left},
                      {{0.6F, 0.0F}, ControllerButton::right},
                      {{0.2F, -0.9F}, ControllerButton::up},
                      {{0.0F, 1.0F}, ControllerButton::down}};
    for (const auto& direction : directions) {
        ControllerState now;
        add_stick(now, {}, direction.position.x, direction.position.y);
        for (std::size_t i = 0; i < controller_button_count; ++i)
            CHECK(now.down.at(i) == (i == static_cast<std::size_t>(direction.button)));
    }
}

TEST_CASE("Controller: a stick that trembles at the threshold presses once") {
    const glm::vec2 positions[] = {{0.0F, 0.0F},  {0.0F, 0.45F}, {0.0F, 0.52F}, {0.0F, 0.48F},
                                   {0.0F, 0.55F}, {0.0F, 0.35F}, {0.0F, 0.51F}, {0.0F, 0.2F}};
    const auto events = events_of(positions);
    REQUIRE(events.size() == 2);
    CHECK(events[0].button == ControllerButton::down);
    CHECK(events[0].down);
    CHECK(events[1].button == ControllerButton::down);
    CHECK_FALSE(events[1].down);
}

TEST_CASE(
    "Controller: a stick leaves the direction buttons that are down, and a stick without a position presses "
    "none") {
    ControllerState now;
    now.down.at(static_cast<std::size_t>(ControllerButton::up)) = true;
    add_stick(now, {}, 0.0F, 0.0F);
    CHECK(is_down(now, ControllerButton::up));
    ControllerState unknown;
    add_stick(unknown, {}, std::numeric_limits<float>::quiet_NaN(), std::nanf(""));
    CHECK(controller_events({}, unknown).empty());
}
