#include "game/trainer/pushing.hpp"

#include <variant>

namespace bolt::trainer {

namespace {

using platform::Key;

struct Way {
    Key key;
    Vec3 along, about;
};
const Way ways[] = {
    {Key::d, Vec3(1, 0, 0), Vec3(0.0)},       {Key::a, Vec3(-1, 0, 0), Vec3(0.0)},
    {Key::e, Vec3(0, 1, 0), Vec3(0.0)},       {Key::q, Vec3(0, -1, 0), Vec3(0.0)},
    {Key::s, Vec3(0, 0, 1), Vec3(0.0)},       {Key::w, Vec3(0, 0, -1), Vec3(0.0)},
    {Key::left, Vec3(0.0), Vec3(0, 1, 0)},    {Key::right, Vec3(0.0), Vec3(0, -1, 0)},
    {Key::up, Vec3(0.0), Vec3(-1, 0, 0)},     {Key::down, Vec3(0.0), Vec3(1, 0, 0)},
    {Key::page_up, Vec3(0.0), Vec3(0, 0, 1)}, {Key::page_down, Vec3(0.0), Vec3(0, 0, -1)},
};
// A key is pressed or it is not. Faster than a tool is drawn to a nut, or it would never come off.
constexpr double share = 0.75;

}  // namespace

void Pushing::take(std::span<const platform::Event> events) {
    for (const platform::Event& event : events) {
        if (const auto* key = std::get_if<platform::KeyEvent>(&event))
            down_.set(static_cast<std::size_t>(key->key), key->down);
        else if (const auto* focus = std::get_if<platform::FocusEvent>(&event);
                 focus != nullptr && !focus->here)
            down_.reset();
    }
}

device::PuckInput Pushing::push() const {
    device::PuckInput push;
    for (const Way& way : ways) {
        if (!down_.test(static_cast<std::size_t>(way.key))) continue;
        push.along += share * way.along;
        push.about += share * way.about;
    }
    push.buttons = closes() ? 1 : 0;
    return push;
}

bool Pushing::closes() const { return down_.test(static_cast<std::size_t>(Key::space)); }

}  // namespace bolt::trainer
