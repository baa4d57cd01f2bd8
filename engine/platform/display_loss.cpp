#include "engine/platform/display_loss.hpp"

#include <dlfcn.h>

namespace bolt::platform {

namespace {

// GLFW loads Xlib itself, and some builds of GLFW have no X support, so the functions of both are looked up
// at run time. Without X, or with an Xlib without exit handlers (before 1.7), nothing changes.
using GetDisplay = void* (*)();
using ExitHandler = void (*)(void* display, void* data);
using Handler = int (*)(void* display);
using SetHandler = Handler (*)(Handler handler);
using SetExitHandler = void (*)(void* display, ExitHandler handler, void* data);

int ignore_error(void*) { return 0; }  // Xlib's own ends the program

void set_lost(void*, void* lost) { *static_cast<bool*>(lost) = true; }

}  // namespace

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

}  // namespace bolt::platform
