// Windows: input events, size, full screen and keys.
#include "engine/platform/window.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <deque>
#include <optional>

#include "engine/platform/input.hpp"
#include "tests/platform/window_user.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/screen_picture.hpp"

using namespace bolt;
using namespace bolt::platform;

namespace {

struct Open {
    std::optional<Desktop> desktop;
    std::optional<Window> window;
    std::deque<InputEvent> waiting;

    explicit Open(const std::string& title) {
        Result<Desktop> there = Desktop::open();
        if (!there) FAIL(there.error().message());
        desktop = std::move(*there);
        Result<Window> opened = Window::open(*desktop, {title, 300, 200});
        if (!opened) FAIL(opened.error().message());
        window = std::move(*opened);
        (void)window->poll_events();
    }
    // Returns the next event of a type.
    template <class E>
    E next() {
        for (int i = 0; i < 1000; ++i) {
            for (InputEvent& event : window->wait_for_events(0.1)) waiting.push_back(event);
            while (!waiting.empty()) {
                const InputEvent event = waiting.front();
                waiting.pop_front();
                if (const E* wanted = std::get_if<E>(&event)) return *wanted;
            }
        }
        FAIL("the event does not come");
        return {};
    }
    // Handles events until the condition holds.
    template <class Test>
    bool until(const Test& test) {
        return test::eventually([&] {
            (void)window->poll_events();
            return test();
        });
    }
};

}  // namespace

TEST_CASE("Window: keys, buttons, cursor, wheel and close requests arrive in order with their positions") {
    Open open("events");
    test::WindowUser hand("events");
    hand.key("r");
    const auto down = open.next<KeyEvent>();
    CHECK(down.key == Key::r);
    CHECK(down.down);
    CHECK_FALSE(down.modifiers.shift);
    hand.key("F11");
    hand.key("5");
    hand.key("Escape");
    std::vector<Key> keys;
    while (keys.size() < 3) {
        const auto event = open.next<KeyEvent>();
        if (event.down) keys.push_back(event.key);
    }
    CHECK(keys == std::vector{Key::f11, Key::digit_5, Key::escape});

    hand.move(40, 50);
    hand.press(40, 50);
    hand.move(60, 45);
    hand.release(60, 45);
    hand.move(10, 20);
    hand.press(10, 20, 3);
    hand.press(60, 45, 4);
    hand.press(60, 45, 5);
    hand.close();
    std::vector<InputEvent> events;
    for (int i = 0; i < 1000 && (events.empty() || !std::holds_alternative<CloseEvent>(events.back())); ++i)
        for (InputEvent& event : open.window->wait_for_events(0.1))
            if (!std::holds_alternative<KeyEvent>(event)) events.push_back(event);
    REQUIRE(events.size() == 9);
    CHECK(std::get<CursorEvent>(events[0]).at == glm::dvec2(40, 50));
    CHECK(std::get<ButtonEvent>(events[1]).button == Button::left);
    CHECK(std::get<ButtonEvent>(events[1]).down);
    CHECK(std::get<ButtonEvent>(events[1]).at ==
          glm::dvec2(40, 50));  // the position at the time of the event
    CHECK(std::get<CursorEvent>(events[2]).at == glm::dvec2(60, 45));
    CHECK_FALSE(std::get<ButtonEvent>(events[3]).down);
    CHECK(std::get<ButtonEvent>(events[3]).at == glm::dvec2(60, 45));
    CHECK(std::get<ButtonEvent>(events[5]).button == Button::right);
    CHECK(std::get<ButtonEvent>(events[5]).at == glm::dvec2(10, 20));
    CHECK(std::get<WheelEvent>(events[6]).notches.y == 1.0);
    CHECK(std::get<WheelEvent>(events[7]).notches.y == -1.0);
    CHECK(std::get<WheelEvent>(events[7]).at == glm::dvec2(10, 20));
}

TEST_CASE("Window: has the requested size, and reports a new size and its scale") {
    Open open("size");
    CHECK(open.window->pixels().width == 300);
    CHECK(open.window->pixels().height == 200);
    CHECK(open.window->content_scale() == doctest::Approx(1.0));
    open.window->resize({410, 220});
    const auto resized = open.next<ResizeEvent>();
    CHECK(resized.width == 410);
    CHECK(resized.height == 220);
    CHECK(open.window->pixels().width == 410);
    Window moved = std::move(*open.window);  // callbacks follow the move
    moved.set_title("renamed");
    test::WindowUser("renamed").key("a");
    CHECK(test::eventually([&] {
        const std::vector<InputEvent> events = moved.poll_events();
        return std::any_of(events.begin(), events.end(),
                           [](const InputEvent& event) { return std::holds_alternative<KeyEvent>(event); });
    }));
}

TEST_CASE("Window: full screen fills the display, and leaving it restores the window's place") {
    Open open("whole");
    const test::WindowUser hand("whole");
    const test::WindowUser::WindowRectangle before = hand.rectangle();
    const auto seen = test::read_screen();
    REQUIRE(seen.has_value());
    const test::ScreenPicture& screen = *seen;
    for (int round = 0; round < 2; ++round) {
        open.window->set_full_screen(true);
        CHECK(open.window->full_screen());
        CHECK(open.until([&] { return open.window->pixels().width == screen.width; }));
        CHECK(open.window->pixels().height == screen.height);
        open.window->set_full_screen(true);  // already in full screen
        open.window->set_full_screen(false);
        CHECK_FALSE(open.window->full_screen());
        CHECK(open.until([&] { return open.window->pixels().width == 300; }));
        const test::WindowUser::WindowRectangle after = hand.rectangle();
        CHECK(after.x == before.x);
        CHECK(after.y == before.y);
        CHECK(after.width == 300);
        CHECK(after.height == 200);
    }
}

TEST_CASE("Window: can start in full screen or hidden") {
    Open open("asks");
    const auto screen = test::read_screen();
    REQUIRE(screen.has_value());
    WindowOptions options;
    options.full_screen = true;
    const Result<Window> whole = Window::open(*open.desktop, options);
    REQUIRE(whole.has_value());
    CHECK(whole->full_screen());
    CHECK(open.until([&] { return whole->pixels().width == screen->width; }));
    CHECK(whole->refresh_rate() >= 0.0);
    options = {};
    options.hidden = true;
    CHECK(Window::open(*open.desktop, options).has_value());
}

TEST_CASE("Window: has twice the pixels on a display with doubled text size, but no more than the screen") {
    const test::DesktopScale doubled(2);
    Open open("doubled");
    CHECK(open.window->content_scale() == 2.0F);
    CHECK(open.until([&] { return open.window->pixels().width == 600; }));
    CHECK(open.window->pixels().height == 400);
    const auto screen = test::read_screen();
    REQUIRE(screen.has_value());
    const Result<Window> large = Window::open(*open.desktop, {});
    REQUIRE(large.has_value());
    CHECK(open.until([&] { return large->pixels().width == screen->width; }));
    CHECK(large->pixels().height == screen->height);
}

TEST_CASE("Desktop: without a display the error names DISPLAY") {
    const std::string display = std::getenv("DISPLAY");
    unsetenv("DISPLAY");
    const Result<Desktop> none = Desktop::open();
    setenv("DISPLAY", display.c_str(), 1);
    REQUIRE_FALSE(none.has_value());
    CHECK(none.error().code == ErrorCode::no_device);
    CHECK(none.error().expected.find("a display named by DISPLAY") != std::string::npos);
    CHECK(Desktop::open().has_value());  // with a display it opens again
}

TEST_CASE("Keys: letters follow the layout, and other keys follow their position") {
    // GLFW's numbers: A is 65, Q is 81, 1 is 49, keypad 1 is 321, F1 is 290, Escape is 256.
    CHECK(key_of(65, "q") == Key::q);  // a French keyboard
    CHECK(key_of(65, "Q") == Key::q);
    CHECK(key_of(65, nullptr) == Key::a);
    CHECK(key_of(65, "ф") == Key::a);  // a Russian keyboard
    CHECK(key_of(49, "&") == Key::digit_1);
    CHECK(key_of(321, "1") == Key::digit_1);
    CHECK(key_of(300, nullptr) == Key::f11);
    CHECK(key_of(256, nullptr) == Key::escape);
    CHECK(key_of(59, "ö") == Key::unknown);
    CHECK(key_of(59, "m") == Key::m);
    CHECK(key_of(77, ",") == Key::unknown);  // a French keyboard has M elsewhere
    CHECK(key_of(-1, nullptr) == Key::unknown);
    CHECK(name(Key::f11) == "F11");
    CHECK(name(Key::z) == "Z");
    CHECK(name(Key::digit_9) == "9");
    CHECK(name(Key::escape) == "Escape");
    CHECK(name(Key::unknown) == "?");
}
