#include "engine/platform/window.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>

#include "engine/platform/input.hpp"

namespace bolt::platform {

namespace {

// Signatures of functions of Xlib and GLFW that are looked up at run time.
using GetDisplay = void* (*)();
using ExitHandler = void (*)(void* display, void* data);
using Handler = int (*)(void* display);
using SetHandler = Handler (*)(Handler handler);
using SetExitHandler = void (*)(void* display, ExitHandler handler, void* data);

int ignore_error(void*) { return 0; }  // replaces Xlib's handler, which exits the program

void set_lost(void*, void* lost) { *static_cast<bool*>(lost) = true; }

// When the X display server ends while a window is open, Xlib exits the program. Sets `lost` instead, so that
// the owner of the windows can shut down. Call it after initialising GLFW; `lost` must stay valid until GLFW
// has terminated. GLFW loads Xlib itself, and some builds of GLFW have no X support, so the functions of both
// are looked up at run time. Does nothing without X or with an Xlib without exit handlers (before 1.7).
void watch_display_loss(bool& lost) {
    void* xlib = dlopen("libX11.so.6", RTLD_LAZY | RTLD_NOLOAD);
    if (xlib == nullptr) return;
    // NOLINTBEGIN(cppcoreguidelines-pro-type-reinterpret-cast): dlsym returns functions
    const auto set_exit_handler = reinterpret_cast<SetExitHandler>(dlsym(xlib, "XSetIOErrorExitHandler"));
    const auto set_error_handler = reinterpret_cast<SetHandler>(dlsym(xlib, "XSetIOErrorHandler"));
    const auto get_display = reinterpret_cast<GetDisplay>(dlsym(RTLD_DEFAULT, "glfwGetX11Display"));
    // NOLINTEND(cppcoreguidelines-pro-type-reinterpret-cast)
    void* display = get_display != nullptr ? get_display() : nullptr;
    if (set_exit_handler != nullptr && set_error_handler != nullptr && display != nullptr) {
        set_exit_handler(display, set_lost, &lost);
        (void)set_error_handler(ignore_error);
    }
    dlclose(xlib);  // GLFW keeps it loaded
}

tl::unexpected<Error> desktop_error(const char* what, const char* expected) {
    const char* reason = nullptr;
    glfwGetError(&reason);
    return fail(ErrorCode::no_device,
                reason != nullptr ? fmt::format("{}: {}", what, reason) : std::string(what), expected);
}

Button button_of(int glfw_button) {
    switch (glfw_button) {
        case GLFW_MOUSE_BUTTON_LEFT:
            return Button::left;
        case GLFW_MOUSE_BUTTON_MIDDLE:
            return Button::middle;
        case GLFW_MOUSE_BUTTON_RIGHT:
            return Button::right;
        default:
            return Button::other;
    }
}

DesktopArea area(GLFWwindow* window) {
    DesktopArea r;
    glfwGetWindowPos(window, &r.x, &r.y);
    glfwGetWindowSize(window, &r.width, &r.height);
    return r;
}

// Returns the display that shows most of the window.
GLFWmonitor* monitor_of(GLFWwindow* window) {
    if (GLFWmonitor* full_screen = glfwGetWindowMonitor(window)) return full_screen;
    const DesktopArea w = area(window);
    int count = 0;
    GLFWmonitor** monitors = glfwGetMonitors(&count);
    GLFWmonitor* best = glfwGetPrimaryMonitor();
    int largest_overlap = 0;
    for (int i = 0; i < count; ++i) {
        int x = 0, y = 0;
        glfwGetMonitorPos(monitors[i], &x, &y);
        const GLFWvidmode* mode = glfwGetVideoMode(monitors[i]);
        if (mode == nullptr) continue;
        const int across = std::min(w.x + w.width, x + mode->width) - std::max(w.x, x);
        const int down = std::min(w.y + w.height, y + mode->height) - std::max(w.y, y);
        const int overlap = std::max(across, 0) * std::max(down, 0);
        if (overlap > largest_overlap) {
            largest_overlap = overlap;
            best = monitors[i];
        }
    }
    return best;
}

}  // namespace

struct Window::State {
    GLFWwindow* window = nullptr;
    std::vector<InputEvent> events;
    DesktopArea before_full_screen;
    std::shared_ptr<const bool> lost;
    // The cursor position at the time of the event: glfwGetCursorPos would return the current one.
    glm::dvec2 cursor{0.0};
    ControllerState controllers;

    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() {
        if (window != nullptr && !(lost && *lost)) glfwDestroyWindow(window);
    }

    void register_callbacks();
    void add_controller_events();
    // Converts a position from GLFW's desktop units, which are several pixels on some displays.
    [[nodiscard]] glm::dvec2 pixel(double x, double y) const {
        int width = 0, height = 0, across = 0, down = 0;
        glfwGetWindowSize(window, &width, &height);
        glfwGetFramebufferSize(window, &across, &down);
        return {width > 0 ? x * across / width : x, height > 0 ? y * down / height : y};
    }
};

namespace {

Modifiers modifiers_of(int mods) {
    return {(mods & GLFW_MOD_SHIFT) != 0, (mods & GLFW_MOD_CONTROL) != 0, (mods & GLFW_MOD_ALT) != 0,
            (mods & GLFW_MOD_SUPER) != 0};
}

// The buttons of all connected controllers that GLFW has a mapping for.
ControllerState read_controllers(const ControllerState& before) {
    constexpr std::pair<int, ControllerButton> buttons[] = {
        {GLFW_GAMEPAD_BUTTON_DPAD_UP, ControllerButton::up},
        {GLFW_GAMEPAD_BUTTON_DPAD_DOWN, ControllerButton::down},
        {GLFW_GAMEPAD_BUTTON_DPAD_LEFT, ControllerButton::left},
        {GLFW_GAMEPAD_BUTTON_DPAD_RIGHT, ControllerButton::right},
        {GLFW_GAMEPAD_BUTTON_A, ControllerButton::confirm},
        {GLFW_GAMEPAD_BUTTON_B, ControllerButton::cancel},
        {GLFW_GAMEPAD_BUTTON_START, ControllerButton::start}};
    ControllerState now;
    for (int joystick = GLFW_JOYSTICK_1; joystick <= GLFW_JOYSTICK_LAST; ++joystick) {
        GLFWgamepadstate state;
        if (glfwGetGamepadState(joystick, &state) != GLFW_TRUE) continue;
        for (const auto& [glfw, button] : buttons) {
            bool& down = now.down.at(static_cast<std::size_t>(button));
            down = down || state.buttons[glfw] == GLFW_PRESS;
        }
        add_stick(now, before, state.axes[GLFW_GAMEPAD_AXIS_LEFT_X], state.axes[GLFW_GAMEPAD_AXIS_LEFT_Y]);
    }
    return now;
}

}  // namespace

// GLFW reports controllers to every program; only the window with the focus takes their input.
void Window::State::add_controller_events() {
    const bool focused = glfwGetWindowAttrib(window, GLFW_FOCUSED) == GLFW_TRUE;
    const ControllerState now = focused ? read_controllers(controllers) : ControllerState{};
    const std::vector<InputEvent> changes = controller_events(controllers, now);
    events.insert(events.end(), changes.begin(), changes.end());
    controllers = now;
}

void Window::State::register_callbacks() {
    // GLFW accepts plain function pointers; they find their State through the window's user pointer.
    static constexpr auto state_of = [](GLFWwindow* w) -> State& {
        return *static_cast<State*>(glfwGetWindowUserPointer(w));
    };
    glfwSetWindowUserPointer(window, this);
    double at_x = 0.0, at_y = 0.0;
    glfwGetCursorPos(window, &at_x, &at_y);
    cursor = pixel(at_x, at_y);
    glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int scancode, int action, int mods) {
        state_of(w).events.emplace_back(KeyEvent{key_of(key, glfwGetKeyName(key, scancode)),
                                                 action != GLFW_RELEASE, action == GLFW_REPEAT,
                                                 modifiers_of(mods)});
    });
    glfwSetCharCallback(window, [](GLFWwindow* w, unsigned int character) {
        state_of(w).events.emplace_back(TextEvent{static_cast<char32_t>(character)});
    });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int) {
        state_of(w).events.emplace_back(
            ButtonEvent{button_of(button), action == GLFW_PRESS, state_of(w).cursor});
    });
    glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
        state_of(w).cursor = state_of(w).pixel(x, y);
        state_of(w).events.emplace_back(CursorEvent{state_of(w).cursor});
    });
    glfwSetScrollCallback(window, [](GLFWwindow* w, double x, double y) {
        state_of(w).events.emplace_back(WheelEvent{{x, y}, state_of(w).cursor});
    });
    glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int width, int height) {
        state_of(w).events.emplace_back(
            ResizeEvent{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)});
    });
    glfwSetWindowFocusCallback(window, [](GLFWwindow* w, int focused) {
        state_of(w).events.emplace_back(FocusEvent{focused != 0});
    });
    glfwSetWindowRefreshCallback(window,
                                 [](GLFWwindow* w) { state_of(w).events.emplace_back(RefreshEvent{}); });
    glfwSetWindowCloseCallback(window, [](GLFWwindow* w) {
        glfwSetWindowShouldClose(w, GLFW_FALSE);  // the reader of the events decides what to do
        state_of(w).events.emplace_back(CloseEvent{});
    });
}

Result<Desktop> Desktop::open() {
    if (glfwInit() != GLFW_TRUE)
        return desktop_error("a window cannot be opened: there is no display",
                             "a display named by DISPLAY; xvfb-run provides a virtual one");
    Desktop desktop(true);
    watch_display_loss(*desktop.lost_);
    return desktop;
}

Desktop::~Desktop() {
    if (open_ && !*lost_) glfwTerminate();  // a lost display has released its resources already
}

Result<std::vector<const char*>> Desktop::vulkan_extensions() const {
    std::uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    if (names == nullptr)
        return desktop_error("Vulkan cannot present to this display",
                             "a Vulkan loader and driver (mesa-vulkan-drivers renders without a GPU)");
    return std::vector<const char*>(names, names + count);
}

Window::Window(std::unique_ptr<State> state) : state_(std::move(state)) {}
Window::Window(Window&&) noexcept = default;
Window& Window::operator=(Window&&) noexcept = default;
Window::~Window() = default;

namespace {

// Limits the window to the primary monitor's area without the panels of the desktop. The window may be
// larger, because GLFW multiplies its size by the monitor's scale.
void fit_into_work_area(GLFWwindow* window) {
    GLFWmonitor* monitor = glfwGetPrimaryMonitor();
    if (monitor == nullptr) return;
    int x = 0, y = 0, room_x = 0, room_y = 0, width = 0, height = 0;
    glfwGetMonitorWorkarea(monitor, &x, &y, &room_x, &room_y);
    glfwGetWindowSize(window, &width, &height);
    const int fitting_x = std::min(width, room_x), fitting_y = std::min(height, room_y);
    if (room_x > 0 && room_y > 0 && (fitting_x != width || fitting_y != height))
        glfwSetWindowSize(window, fitting_x, fitting_y);
}

}  // namespace

std::vector<Monitor> monitors(const Desktop&) {
    std::vector<Monitor> all;
    int count = 0;
    GLFWmonitor** connected = glfwGetMonitors(&count);
    for (int i = 0; i < count; ++i) {
        Monitor monitor;
        if (const char* name = glfwGetMonitorName(connected[i])) monitor.name = name;
        glfwGetMonitorPos(connected[i], &monitor.area.x, &monitor.area.y);
        if (const GLFWvidmode* mode = glfwGetVideoMode(connected[i])) {
            monitor.area.width = mode->width;
            monitor.area.height = mode->height;
            monitor.refresh_rate = mode->refreshRate;
        }
        all.push_back(std::move(monitor));
    }
    return all;
}

Result<Window> Window::open(const Desktop& desktop, const WindowOptions& options) {
    const bool covers = options.covers.has_value();
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, covers ? GLFW_FALSE : GLFW_TRUE);
    // A window that covers an area is shown only after it was moved there.
    glfwWindowHint(GLFW_VISIBLE, options.hidden || covers ? GLFW_FALSE : GLFW_TRUE);
    glfwWindowHint(GLFW_DECORATED, covers ? GLFW_FALSE : GLFW_TRUE);
    glfwWindowHint(GLFW_RESIZABLE, covers ? GLFW_FALSE : GLFW_TRUE);
    glfwWindowHint(GLFW_FOCUS_ON_SHOW, covers ? GLFW_FALSE : GLFW_TRUE);
    glfwWindowHint(GLFW_AUTO_ICONIFY, covers ? GLFW_FALSE : GLFW_TRUE);
    const int width = covers ? options.covers->width : static_cast<int>(options.width),
              height = covers ? options.covers->height : static_cast<int>(options.height);
    auto state = std::make_unique<State>();
    state->window = glfwCreateWindow(width, height, options.title.c_str(), nullptr, nullptr);
    if (state->window == nullptr) return desktop_error("the window cannot be opened", "");
    if (covers) {
        glfwSetWindowPos(state->window, options.covers->x, options.covers->y);
        if (!options.hidden) glfwShowWindow(state->window);
        glfwSetWindowPos(state->window, options.covers->x, options.covers->y);  // window managers may move it
    } else {
        fit_into_work_area(state->window);
    }
    state->lost = desktop.lost_;
    state->register_callbacks();
    Window window(std::move(state));
    if (options.full_screen && !covers) window.set_full_screen(true);
    return window;
}

Result<gpu::Surface> Window::make_surface(const gpu::Instance& instance) const {
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    const VkResult created = glfwCreateWindowSurface(instance.get(), state_->window, nullptr, &surface);
    BOLT_TRY(gpu::check(created, "creating the window surface"));
    return gpu::Surface(instance.get(), surface);
}

std::vector<InputEvent> Window::poll_events() {
    glfwPollEvents();
    if (!*state_->lost) state_->add_controller_events();
    return std::exchange(state_->events, {});
}

std::vector<InputEvent> Window::wait_for_events(double seconds) {
    glfwWaitEventsTimeout(std::max(seconds, 1e-4));
    return std::exchange(state_->events, {});
}

Status Window::display_status() const {
    if (!*state_->lost) return {};
    return fail(ErrorCode::failed, "the display has ended and closed the window", "");
}

Size Window::pixels() const {
    if (*state_->lost) return {};
    int width = 0, height = 0;
    glfwGetFramebufferSize(state_->window, &width, &height);
    return {static_cast<std::uint32_t>(std::max(width, 0)), static_cast<std::uint32_t>(std::max(height, 0))};
}

float Window::content_scale() const {
    float x = 1.0F, y = 1.0F;
    glfwGetWindowContentScale(state_->window, &x, &y);
    return std::max(x, y);
}

double Window::refresh_rate() const {
    GLFWmonitor* monitor = monitor_of(state_->window);
    const GLFWvidmode* mode = monitor != nullptr ? glfwGetVideoMode(monitor) : nullptr;
    return mode != nullptr ? mode->refreshRate : 0.0;
}

void Window::set_title(const std::string& title) { glfwSetWindowTitle(state_->window, title.c_str()); }

void Window::resize(Size size) {
    glfwSetWindowSize(state_->window, static_cast<int>(size.width), static_cast<int>(size.height));
}

void Window::set_full_screen(bool on) {
    if (on == full_screen()) return;
    if (!on) {
        const DesktopArea& r = state_->before_full_screen;
        glfwSetWindowMonitor(state_->window, nullptr, r.x, r.y, r.width, r.height, GLFW_DONT_CARE);
        return;
    }
    GLFWmonitor* monitor = monitor_of(state_->window);
    const GLFWvidmode* mode = monitor != nullptr ? glfwGetVideoMode(monitor) : nullptr;
    if (mode == nullptr) return;
    state_->before_full_screen = area(state_->window);
    glfwSetWindowMonitor(state_->window, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

bool Window::full_screen() const { return glfwGetWindowMonitor(state_->window) != nullptr; }

}  // namespace bolt::platform
