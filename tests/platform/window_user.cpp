#include "tests/platform/window_user.hpp"

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>
// Xlib's macros collide with our names.
#undef None
#undef Status
#undef Success

#include <doctest/doctest.h>

namespace bolt::test {

struct WindowUser::X {
    Display* display = XOpenDisplay(nullptr);
    Window window = 0;
    Time time = 1000;

    X() = default;
    X(const X&) = delete;
    X& operator=(const X&) = delete;
    ~X() {
        if (display != nullptr) XCloseDisplay(display);
    }
    void send(XEvent& event, long mask) {
        event.xany.display = display;
        event.xany.window = window;
        XSendEvent(display, window, False, mask, &event);
        XSync(display, False);
    }
    void button(int type, int x, int y, unsigned which) {
        XEvent event{};
        event.xbutton.type = type;
        event.xbutton.button = which;
        event.xbutton.x = x;
        event.xbutton.y = y;
        event.xbutton.time = time += 10;
        event.xbutton.same_screen = True;
        send(event, type == ButtonPress ? ButtonPressMask : ButtonReleaseMask);
    }
};

WindowUser::WindowUser(const std::string& title) : x_(std::make_unique<X>()) {
    REQUIRE(x_->display != nullptr);
    Window root = 0, parent = 0, *children = nullptr;
    unsigned count = 0;
    XQueryTree(x_->display, DefaultRootWindow(x_->display), &root, &parent, &children, &count);
    for (unsigned i = 0; i < count; ++i) {
        char* name = nullptr;
        if (XFetchName(x_->display, children[i], &name) == 0) continue;
        if (std::string(name).find(title) != std::string::npos) x_->window = children[i];
        XFree(name);
    }
    XFree(children);
    REQUIRE_MESSAGE(x_->window != 0, "there is no window with this title: " << title);
}

WindowUser::~WindowUser() = default;

void WindowUser::key(const char* keysym) {
    for (const int type : {KeyPress, KeyRelease}) {
        XEvent event{};
        event.xkey.type = type;
        event.xkey.keycode = XKeysymToKeycode(x_->display, XStringToKeysym(keysym));
        event.xkey.time = x_->time += 10;
        event.xkey.same_screen = True;
        x_->send(event, type == KeyPress ? KeyPressMask : KeyReleaseMask);
    }
}

void WindowUser::move(int x, int y) {
    XEvent event{};
    event.xmotion.type = MotionNotify;
    event.xmotion.x = x;
    event.xmotion.y = y;
    event.xmotion.time = x_->time += 10;
    event.xmotion.same_screen = True;
    x_->send(event, PointerMotionMask);
}

void WindowUser::point(int x, int y) {
    XWarpPointer(x_->display, 0, x_->window, 0, 0, 0, 0, x, y);
    XSync(x_->display, False);
}

void WindowUser::press(int x, int y, unsigned button) { x_->button(ButtonPress, x, y, button); }
void WindowUser::release(int x, int y, unsigned button) { x_->button(ButtonRelease, x, y, button); }

void WindowUser::close() {
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.message_type = XInternAtom(x_->display, "WM_PROTOCOLS", False);
    event.xclient.format = 32;
    event.xclient.data.l[0] = static_cast<long>(XInternAtom(x_->display, "WM_DELETE_WINDOW", False));
    x_->send(event, NoEventMask);
}

WindowUser::WindowRectangle WindowUser::rectangle() const {
    XWindowAttributes about{};
    XGetWindowAttributes(x_->display, x_->window, &about);
    WindowRectangle place{0, 0, about.width, about.height};
    Window child = 0;
    XTranslateCoordinates(x_->display, x_->window, about.root, 0, 0, &place.x, &place.y, &child);
    return place;
}

namespace {

void announce_resources(const std::string& resources) {
    Display* display = XOpenDisplay(nullptr);
    REQUIRE(display != nullptr);
    XChangeProperty(display, DefaultRootWindow(display), XA_RESOURCE_MANAGER, XA_STRING, 8, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(resources.data()),
                    static_cast<int>(resources.size()));
    XCloseDisplay(display);
}

}  // namespace

DesktopScale::DesktopScale(int scale) { announce_resources("Xft.dpi: " + std::to_string(96 * scale) + "\n"); }
DesktopScale::~DesktopScale() { announce_resources(""); }

}  // namespace bolt::test
