#include "game/hints/controls.hpp"

namespace bolt::hints {

namespace {

using words::Key;

struct Row {
    Motion motion;
    Key mouse, device, glove;
};
constexpr Row rows[] = {
    {Motion::take, "control.mouse.take", "control.device.take", "control.glove.take"},
    {Motion::put_away, "control.mouse.put_away", "control.device.put_away", "control.glove.put_away"},
    {Motion::approach, "control.mouse.go", "control.device.move", "control.device.move"},
    {Motion::reach, "control.mouse.go", "control.device.move", "control.device.move"},
    {Motion::set_on, "control.mouse.go", "control.device.move", "control.device.move"},
    {Motion::grip_nut, "control.mouse.go", "control.device.grip", "control.glove.grip"},
    {Motion::spin, "control.mouse.spin", "control.device.turn", "control.device.turn"},
    {Motion::twist_back, "control.mouse.again", "control.device.twist_back", "control.glove.twist_back"},
    {Motion::let_go, "control.mouse.let_go", "control.device.release", "control.glove.release"},
    {Motion::pull_on, "control.mouse.pull", "control.device.turn", "control.device.turn"},
    {Motion::pull_off, "control.mouse.pull", "control.device.turn", "control.device.turn"},
    {Motion::lift, "control.mouse.let_go", "control.device.move", "control.device.move"},
    {Motion::set_back, "control.mouse.again", "control.device.move", "control.device.move"},
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

Controls glove_controls(const words::Words& words) { return controls(words, &Row::glove, {}); }

}  // namespace bolt::hints
