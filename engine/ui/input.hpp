// User input as plain values. The owner of the window, the headset or the test fills it in once per frame.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <string>

namespace bolt::ui {

// Keys that the interface itself handles. Typed text is passed separately (UiInput::text).
enum class UiKey : std::uint8_t {
    tab,
    left,
    right,
    up,
    down,
    page_up,
    page_down,
    home,
    end,
    insert,
    delete_key,
    backspace,
    space,
    enter,
    escape,
    a,
    c,
    v,
    x,
    y,
    z,
};
inline constexpr std::size_t key_count = 21;

// A mouse button or a key.
struct UiButton {
    bool down = false;
    bool pressed = false;  // went down since the last frame, even if it has been released

    void set(bool is_down) {
        down = is_down;
        pressed = pressed || is_down;
    }
};

struct UiInput {
    glm::vec2 size{0.0F};               // of the picture, pixels
    float scale = 1.0F;                 // of the display: pixels per point
    double seconds = 0.0;               // since the last frame
    bool pointer_inside = false;        // the pointer is over the picture
    glm::vec2 pointer{0.0F};            // pixels from the upper left corner
    std::array<UiButton, 3> buttons{};  // left, right, middle
    glm::vec2 wheel{0.0F};              // notches since the last frame; y: away from the user
    std::array<UiButton, key_count> keys{};
    bool ctrl = false, shift = false, alt = false;
    std::string text;  // UTF-8, typed since the last frame

    UiButton& key(UiKey k) { return keys.at(static_cast<std::size_t>(k)); }
};

}  // namespace bolt::ui
