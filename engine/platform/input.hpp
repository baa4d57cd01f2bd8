// Input of a window as plain values, in the order in which it happened; the mapping of GLFW's keys to Key;
// events of game controllers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <string_view>
#include <variant>
#include <vector>

namespace bolt::platform {

// Letter keys are identified by the letter that the keyboard layout prints on them. Other keys are identified
// by position, so that digits also work on layouts that type them with shift only.
enum class Key : std::uint8_t {
    // clang-format off
    unknown,
    a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x, y, z,
    digit_0, digit_1, digit_2, digit_3, digit_4, digit_5, digit_6, digit_7, digit_8, digit_9,
    f1, f2, f3, f4, f5, f6, f7, f8, f9, f10, f11, f12,
    escape, enter, tab, backspace, space, insert, delete_key, home, end, page_up, page_down,
    left, right, up, down, plus, minus, shift, control, alt, super,
    // clang-format on
};

inline constexpr std::size_t key_count = static_cast<std::size_t>(Key::super) + 1;

// Key names for messages, help and files: "F11", "Escape", "R". Each key has a unique name.
std::string_view name(Key key);
Key key_named(std::string_view name);  // unknown if no key has this name

struct Modifiers {
    bool shift = false, control = false, alt = false, super = false;
};

enum class Button : std::uint8_t { left, middle, right, other };

struct KeyEvent {
    Key key = Key::unknown;
    bool down = false, repeated = false;
    Modifiers modifiers;
};
struct TextEvent {
    char32_t character = 0;  // as composed by the keyboard layout and input methods
};
struct ButtonEvent {
    Button button = Button::other;
    bool down = false;
    glm::dvec2 at{0.0};  // pixels from the upper left corner
};
struct CursorEvent {
    glm::dvec2 at{0.0};  // pixels from the upper left corner
};
struct WheelEvent {
    glm::dvec2 notches{0.0};  // y: away from the user
    glm::dvec2 at{0.0};       // pixels from the upper left corner
};
struct ResizeEvent {
    std::uint32_t width = 0, height = 0;  // pixels
};
struct FocusEvent {
    bool focused = false;
};
// The buttons of a game controller that a program with menus needs. The left stick counts as the direction
// buttons.
enum class ControllerButton : std::uint8_t {
    up,
    down,
    left,
    right,
    confirm,  // the lower one of the four at the right, A on many controllers
    cancel,   // the right one of these, B on many controllers
    start,
};
inline constexpr std::size_t controller_button_count = 7;
struct ControllerEvent {
    ControllerButton button = ControllerButton::start;
    bool down = false;
};
struct RefreshEvent {};  // the contents were lost and must be drawn again
struct CloseEvent {};    // the user wants to close the window

using InputEvent = std::variant<KeyEvent, TextEvent, ButtonEvent, CursorEvent, WheelEvent, ControllerEvent,
                                ResizeEvent, FocusEvent, RefreshEvent, CloseEvent>;

// The state of all controllers together.
struct ControllerState {
    std::array<bool, controller_button_count> down{};
};
// Sets the direction buttons from the left stick. `x`, `y`: its deflection, -1 … 1, y towards the user. A
// button goes down at half the deflection and up again at a third, so that it does not chatter.
void add_stick(ControllerState& now, const ControllerState& before, float x, float y);
// Returns an event for each button whose state differs.
std::vector<InputEvent> controller_events(const ControllerState& before, const ControllerState& now);

// Maps a GLFW key code. `printed`: the layout's name of the key from glfwGetKeyName; may be null.
Key key_of(int glfw_key, const char* printed);

}  // namespace bolt::platform
