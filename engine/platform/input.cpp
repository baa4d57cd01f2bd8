#include "engine/platform/input.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <array>

namespace bolt::platform {

namespace {

struct NamedKey {
    int glfw;
    Key key;
    std::string_view name;
};

constexpr NamedKey named_keys[] = {
    {GLFW_KEY_ESCAPE, Key::escape, "Escape"},
    {GLFW_KEY_ENTER, Key::enter, "Enter"},
    {GLFW_KEY_KP_ENTER, Key::enter, "Enter"},
    {GLFW_KEY_TAB, Key::tab, "Tab"},
    {GLFW_KEY_BACKSPACE, Key::backspace, "Back"},
    {GLFW_KEY_SPACE, Key::space, "Space"},
    {GLFW_KEY_INSERT, Key::insert, "Insert"},
    {GLFW_KEY_DELETE, Key::delete_key, "Delete"},
    {GLFW_KEY_HOME, Key::home, "Home"},
    {GLFW_KEY_END, Key::end, "End"},
    {GLFW_KEY_PAGE_UP, Key::page_up, "Page up"},
    {GLFW_KEY_PAGE_DOWN, Key::page_down, "Page down"},
    {GLFW_KEY_LEFT, Key::left, "Left"},
    {GLFW_KEY_RIGHT, Key::right, "Right"},
    {GLFW_KEY_UP, Key::up, "Up"},
    {GLFW_KEY_DOWN, Key::down, "Down"},
    {GLFW_KEY_KP_ADD, Key::plus, "+"},
    {GLFW_KEY_EQUAL, Key::plus, "+"},
    {GLFW_KEY_KP_SUBTRACT, Key::minus, "-"},
    {GLFW_KEY_MINUS, Key::minus, "-"},
    {GLFW_KEY_LEFT_SHIFT, Key::shift, "Shift"},
    {GLFW_KEY_RIGHT_SHIFT, Key::shift, "Shift"},
    {GLFW_KEY_LEFT_CONTROL, Key::control, "Ctrl"},
    {GLFW_KEY_RIGHT_CONTROL, Key::control, "Ctrl"},
    {GLFW_KEY_LEFT_ALT, Key::alt, "Alt"},
    {GLFW_KEY_RIGHT_ALT, Key::alt, "Alt"},
    {GLFW_KEY_LEFT_SUPER, Key::super, "Super"},
    {GLFW_KEY_RIGHT_SUPER, Key::super, "Super"},
};

constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZ", digits = "0123456789";
constexpr std::array<std::string_view, 12> functions{"F1", "F2", "F3", "F4",  "F5",  "F6",
                                                     "F7", "F8", "F9", "F10", "F11", "F12"};

// Returns the key `index` positions after `first`: GLFW's constants and Key have letters, digits and function
// keys in the same order.
Key after(Key first, int index) { return static_cast<Key>(static_cast<int>(first) + index); }

bool within(int value, int first, int last) { return value >= first && value <= last; }

}  // namespace

Key key_of(int glfw_key, const char* printed) {
    if (within(glfw_key, GLFW_KEY_0, GLFW_KEY_9)) return after(Key::digit_0, glfw_key - GLFW_KEY_0);
    if (within(glfw_key, GLFW_KEY_KP_0, GLFW_KEY_KP_9)) return after(Key::digit_0, glfw_key - GLFW_KEY_KP_0);
    if (within(glfw_key, GLFW_KEY_F1, GLFW_KEY_F12)) return after(Key::f1, glfw_key - GLFW_KEY_F1);
    // Use the printed letter if it is one ASCII letter; keys of other alphabets fall back to the position.
    if (printed != nullptr && printed[0] != 0 && printed[1] == 0) {
        if (within(printed[0], 'a', 'z')) return after(Key::a, printed[0] - 'a');
        if (within(printed[0], 'A', 'Z')) return after(Key::a, printed[0] - 'A');
        // If another character is printed here, such as a comma on M's key, the layout's M is another key.
        if (within(glfw_key, GLFW_KEY_A, GLFW_KEY_Z) && within(printed[0], '!', '~')) return Key::unknown;
    }
    for (const NamedKey& entry : named_keys)
        if (entry.glfw == glfw_key) return entry.key;
    if (within(glfw_key, GLFW_KEY_A, GLFW_KEY_Z)) return after(Key::a, glfw_key - GLFW_KEY_A);
    return Key::unknown;
}

std::string_view name(Key key) {
    const auto index = static_cast<std::size_t>(key);
    const auto offset = [&](Key first) { return index - static_cast<std::size_t>(first); };
    if (key >= Key::a && key <= Key::z) return letters.substr(offset(Key::a), 1);
    if (key >= Key::digit_0 && key <= Key::digit_9) return digits.substr(offset(Key::digit_0), 1);
    if (key >= Key::f1 && key <= Key::f12) return functions[offset(Key::f1)];
    for (const NamedKey& entry : named_keys)
        if (entry.key == key) return entry.name;
    return "?";
}

Key key_named(std::string_view wanted_name) {
    for (std::size_t i = 1; i < key_count; ++i)
        if (name(static_cast<Key>(i)) == wanted_name) return static_cast<Key>(i);
    return Key::unknown;
}

void add_stick(ControllerState& now, const ControllerState& before, float x, float y) {
    constexpr float press_at = 0.5F, release_at = 0.33F;
    const auto add = [&](ControllerButton button, float deflection) {
        const auto index = static_cast<std::size_t>(button);
        const float threshold = before.down.at(index) ? release_at : press_at;
        now.down.at(index) = now.down.at(index) || deflection > threshold;
    };
    add(ControllerButton::left, -x);
    add(ControllerButton::right, x);
    add(ControllerButton::up, -y);
    add(ControllerButton::down, y);
}

std::vector<InputEvent> controller_events(const ControllerState& before, const ControllerState& now) {
    std::vector<InputEvent> events;
    for (std::size_t i = 0; i < controller_button_count; ++i)
        if (before.down.at(i) != now.down.at(i))
            events.emplace_back(ControllerEvent{static_cast<ControllerButton>(i), now.down.at(i)});
    return events;
}

}  // namespace bolt::platform
