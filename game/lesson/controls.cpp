#include "game/lesson/controls.hpp"

namespace bolt::lesson {

namespace {

using words::Key;

struct Row {
    Motion motion;
    Key mouse, device;
};
constexpr Row rows[] = {
    {Motion::take, "control.mouse.take", "control.device.take"},
    {Motion::put_away, "control.mouse.put_away", "control.device.put_away"},
    {Motion::approach, "control.mouse.go", "control.device.move"},
    {Motion::reach, "control.mouse.go", "control.device.move"},
    {Motion::set_on, "control.mouse.go", "control.device.move"},
    {Motion::grip_nut, "control.mouse.go", "control.device.grip"},
    {Motion::spin, "control.mouse.spin", "control.device.turn"},
    {Motion::twist_back, "control.mouse.again", "control.device.twist_back"},
    {Motion::let_go, "control.mouse.let_go", "control.device.release"},
    {Motion::pull_on, "control.mouse.pull", "control.device.turn"},
    {Motion::pull_off, "control.mouse.pull", "control.device.turn"},
    {Motion::lift, "control.mouse.let_go", "control.device.move"},
    {Motion::set_back, "control.mouse.again", "control.device.move"},
};
static_assert(std::size(rows) == motion_count - 1);  // all but none

std::string& at(Controls& controls, Motion motion) { return controls.at(static_cast<std::size_t>(motion)); }

Controls controls(const words::Words& words, Key Row::*of, const std::string& key) {
    Controls said;
    for (const Row& row : rows) at(said, row.motion) = words::say(words, row.*of, {{"key", key}});
    return said;
}

}  // namespace

Controls mouse_controls(const words::Words& words, const std::string& tool_key) {
    return controls(words, &Row::mouse, tool_key);
}

Controls device_controls(const words::Words& words, const std::string& button, const std::string& tool_key) {
    Controls said = controls(words, &Row::device, button);
    at(said, Motion::put_away) = words::say(words, "control.device.put_away", {{"key", tool_key}});
    return said;
}

namespace {

Controls pushed(const words::Words& words, const std::string& button, const std::string& tool_key, Key move,
                Key turn) {
    Controls said = device_controls(words, button, tool_key);
    for (const Motion motion : {Motion::approach, Motion::reach, Motion::set_on})
        at(said, motion) = words::say(words, move, {{"key", button}});
    for (const Motion motion : {Motion::spin, Motion::pull_on, Motion::pull_off})
        at(said, motion) = words::say(words, turn, {});
    return said;
}

}  // namespace

Controls puck_controls(const words::Words& words, const std::string& button, const std::string& tool_key) {
    return pushed(words, button, tool_key, "control.puck.move", "control.device.turn");
}

Controls keyboard_controls(const words::Words& words, const std::string& button,
                           const std::string& tool_key) {
    return pushed(words, button, tool_key, "control.keys.move", "control.keys.turn");
}

namespace {

struct ByFingers {
    Motion motion;
    Key said;
};
constexpr ByFingers finger_controls[] = {{Motion::take, "control.glove.take"},
                                         {Motion::put_away, "control.glove.put_away"},
                                         {Motion::grip_nut, "control.glove.grip"},
                                         {Motion::twist_back, "control.glove.twist_back"},
                                         {Motion::let_go, "control.glove.release"}};

}  // namespace

Controls glove_controls(const words::Words& words, Controls moved_by) {
    for (const ByFingers& row : finger_controls) at(moved_by, row.motion) = words::say(words, row.said, {});
    return moved_by;
}

}  // namespace bolt::lesson
