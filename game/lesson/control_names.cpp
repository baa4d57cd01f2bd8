// The names of the controls that hints mention, for each way of moving the hand.
#include "game/lesson/hints.hpp"

namespace bolt::lesson {

using words::TextKey;

namespace {

struct ControlRow {
    HintMotion motion;
    TextKey mouse, drag, device;
};
constexpr ControlRow control_rows[] = {
    {HintMotion::take, "control.mouse.take", "control.drag.take", "control.device.take"},
    {HintMotion::put_away, "control.mouse.put_away", "control.mouse.put_away", "control.device.put_away"},
    {HintMotion::approach, "control.mouse.go", "control.drag.move", "control.device.move"},
    {HintMotion::reach, "control.mouse.go", "control.drag.move", "control.device.move"},
    {HintMotion::set_on, "control.mouse.go", "control.drag.move", "control.device.move"},
    {HintMotion::grip_nut, "control.mouse.go", "control.drag.grip", "control.device.grip"},
    {HintMotion::spin, "control.mouse.spin", "control.drag.spin", "control.device.turn"},
    {HintMotion::twist_back, "control.mouse.again", "control.mouse.again", "control.device.twist_back"},
    {HintMotion::let_go, "control.mouse.let_go", "control.mouse.let_go", "control.device.release"},
    {HintMotion::pull_on, "control.mouse.pull", "control.mouse.pull", "control.device.turn"},
    {HintMotion::pull_off, "control.mouse.pull", "control.mouse.pull", "control.device.turn"},
    {HintMotion::lift, "control.mouse.let_go", "control.drag.lift", "control.device.move"},
    {HintMotion::set_back, "control.mouse.again", "control.drag.set_back", "control.device.move"},
};
static_assert(std::size(control_rows) == motion_count - 2);  // all but `none` and `counter_hold`

std::string& at(ControlNames& controls, HintMotion motion) {
    return controls.at(static_cast<std::size_t>(motion));
}

ControlNames controls(const words::Words& words, TextKey ControlRow::*column, const std::string& key) {
    ControlNames names;
    at(names, HintMotion::counter_hold) = words::format_text(words, "control.room.hold", {});
    for (const ControlRow& row : control_rows)
        at(names, row.motion) = words::format_text(words, row.*column, {{"key", key}});
    return names;
}

}  // namespace

ControlNames with_second_wrench(const words::Words& words, ControlNames controls, const std::string& key) {
    at(controls, HintMotion::counter_hold) = words::format_text(words, "control.key.hold", {{"key", key}});
    return controls;
}

ControlNames mouse_controls(const words::Words& words, const std::string& tool_key) {
    return controls(words, &ControlRow::mouse, tool_key);
}

ControlNames drag_controls(const words::Words& words, const std::string& tool_key) {
    return controls(words, &ControlRow::drag, tool_key);
}

ControlNames device_controls(const words::Words& words, const std::string& button,
                             const std::string& tool_key) {
    ControlNames names = controls(words, &ControlRow::device, button);
    at(names, HintMotion::put_away) =
        words::format_text(words, "control.device.put_away", {{"key", tool_key}});
    return names;
}

namespace {

ControlNames button_controls(const words::Words& words, const std::string& button,
                             const std::string& tool_key, TextKey move, TextKey turn) {
    ControlNames names = device_controls(words, button, tool_key);
    for (const HintMotion motion : {HintMotion::approach, HintMotion::reach, HintMotion::set_on})
        at(names, motion) = words::format_text(words, move, {{"key", button}});
    for (const HintMotion motion : {HintMotion::spin, HintMotion::pull_on, HintMotion::pull_off})
        at(names, motion) = words::format_text(words, turn, {});
    return names;
}

}  // namespace

ControlNames puck_controls(const words::Words& words, const std::string& button,
                           const std::string& tool_key) {
    return button_controls(words, button, tool_key, "control.puck.move", "control.device.turn");
}

ControlNames keyboard_controls(const words::Words& words, const std::string& button,
                               const std::string& tool_key) {
    return button_controls(words, button, tool_key, "control.keys.move", "control.keys.turn");
}

namespace {

struct FingerRow {
    HintMotion motion;
    TextKey text;
};
constexpr FingerRow finger_controls[] = {{HintMotion::take, "control.glove.take"},
                                         {HintMotion::put_away, "control.glove.put_away"},
                                         {HintMotion::grip_nut, "control.glove.grip"},
                                         {HintMotion::twist_back, "control.glove.twist_back"},
                                         {HintMotion::let_go, "control.glove.release"}};

}  // namespace

ControlNames glove_controls(const words::Words& words, ControlNames controls) {
    for (const FingerRow& row : finger_controls)
        at(controls, row.motion) = words::format_text(words, row.text, {});
    return controls;
}

ControlNames tracked_controls(const words::Words& words) {
    ControlNames names = glove_controls(words, {});
    at(names, HintMotion::counter_hold) = words::format_text(words, "control.room.hold", {});
    for (const HintMotion motion : {HintMotion::approach, HintMotion::reach, HintMotion::set_on,
                                    HintMotion::lift, HintMotion::set_back})
        at(names, motion) = words::format_text(words, "control.hand.move", {});
    for (const HintMotion motion : {HintMotion::spin, HintMotion::pull_on, HintMotion::pull_off})
        at(names, motion) = words::format_text(words, "control.hand.turn", {});
    return names;
}

}  // namespace bolt::lesson
