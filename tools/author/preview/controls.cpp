#include "tools/author/preview/controls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>

namespace bolt::author {

namespace {

using namespace platform;

constexpr std::size_t view_keys = 9;
constexpr double click_distance = 4.0;  // px; a longer movement between press and release is a drag

void press(Key key, PreviewCommands& commands) {
    switch (key) {
        case Key::escape:
            commands.close = true;
            break;
        case Key::f11:
            commands.full_screen = true;
            break;
        case Key::r:
            commands.reload = true;
            break;
        case Key::f:
            commands.show_all = true;
            break;
        case Key::l:
            commands.toggle_level = true;
            break;
        case Key::s:
            commands.toggle_sectors = true;
            break;
        case Key::n:
            commands.next_problem = true;
            break;
        case Key::v:
            commands.next_variant = true;
            break;
        case Key::p:
            commands.toggle_panel = true;
            break;
        default:
            if (key >= Key::digit_1 && key <= Key::digit_9)
                commands.select_view = static_cast<std::size_t>(key) - static_cast<std::size_t>(Key::digit_1);
    }
}

}  // namespace

std::optional<glm::dvec2> PreviewControls::find_click(const InputEvent& event) {
    if (const auto* button = std::get_if<ButtonEvent>(&event)) {
        const std::optional<glm::dvec2> pressed = std::exchange(pressed_, std::nullopt);
        if (button->button != Button::left) return std::nullopt;
        if (!button->down) return pressed;
        pressed_ = button->at;
    } else if (const auto* cursor = std::get_if<CursorEvent>(&event)) {
        if (pressed_ && glm::distance(cursor->at, *pressed_) > click_distance) pressed_.reset();
    } else if (const auto* focus = std::get_if<FocusEvent>(&event)) {
        if (!focus->focused) pressed_.reset();
    }
    return std::nullopt;
}

PreviewCommands PreviewControls::apply(std::span<const InputEvent> events, double height, double aspect,
                                       view::Orbit& camera, const render::BoundingBox& box) {
    PreviewCommands commands;
    (void)mouse_.apply(events, {height, aspect}, camera, box);
    for (const InputEvent& event : events) {
        if (const auto click = find_click(event)) commands.click = click;
        if (const auto* key = std::get_if<KeyEvent>(&event)) {
            const Modifiers& m = key->modifiers;
            if (key->down && !key->repeated && !m.control && !m.alt && !m.super) press(key->key, commands);
        } else if (std::holds_alternative<CloseEvent>(event)) {
            commands.close = true;
        } else if (std::holds_alternative<ResizeEvent>(event) ||
                   std::holds_alternative<RefreshEvent>(event)) {
            commands.redraw = true;
        }
    }
    return commands;
}

std::string help_line(const std::vector<view::Viewpoint>& views) {
    std::string text =
        "Left drag: turn. Click: select a joint. Right or middle drag: move. Wheel: zoom. F: all.";
    for (std::size_t i = 0; i < std::min(views.size(), view_keys); ++i)
        text += fmt::format(" {}: {}.", i + 1, views[i].name);
    return text +
           " S: swing of all joints. N: next problem. V: next variant. P: panel."
           " L: far level. R: reload. F11: full screen. Esc: close.\n";
}

}  // namespace bolt::author
