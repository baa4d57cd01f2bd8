#include "game/hints/controls.hpp"

namespace bolt::hints {

namespace {

using words::Key;

struct Row {
    Motion motion;
    Key mouse, device;
};
constexpr Row rows[] = {
    {Motion::take, "control.mouse.take", "control.device.press"},
    {Motion::put_away, "control.mouse.put_away", "control.device.press"},
    {Motion::approach, "control.mouse.go", "control.device.move"},
    {Motion::reach, "control.mouse.go", "control.device.move"},
    {Motion::set_on, "control.mouse.go", "control.device.move"},
    {Motion::grip_nut, "control.mouse.go", "control.device.grip"},
    {Motion::spin, "control.mouse.spin", "control.device.turn"},
    {Motion::twist_back, "control.mouse.again", "control.device.turn"},
    {Motion::let_go, "control.mouse.let_go", "control.device.release"},
    {Motion::pull_on, "control.mouse.pull", "control.device.turn"},
    {Motion::pull_off, "control.mouse.pull", "control.device.turn"},
    {Motion::lift, "control.mouse.let_go", "control.device.move"},
    {Motion::set_back, "control.mouse.again", "control.device.move"},
};
static_assert(std::size(rows) == motion_count - 1);  // all but none

Controls controls(const words::Words& words, Key Row::*of, const std::string& key) {
    Controls said;
    for (const Row& row : rows)
        said[static_cast<std::size_t>(row.motion)] = words::say(words, row.*of, {{"key", key}});
    return said;
}

}  // namespace

Controls mouse_controls(const words::Words& words, const std::string& tool_key) {
    return controls(words, &Row::mouse, tool_key);
}

Controls device_controls(const words::Words& words, const std::string& button) {
    return controls(words, &Row::device, button);
}

}  // namespace bolt::hints
