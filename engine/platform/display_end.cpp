#include "engine/platform/display_end.hpp"

#include <dlfcn.h>

namespace bolt::platform {

namespace {

// GLFW loads Xlib itself, and some builds of GLFW know none: both are asked for what they have. Without X, or
// with an Xlib that is too old to be told (before 1.7), all stays as it was.
using GetDisplay = void* (*)();
using ExitHandler = void (*)(void* display, void* data);
using Handler = int (*)(void* display);
using SetHandler = Handler (*)(Handler handler);
using SetExitHandler = void (*)(void* display, ExitHandler handler, void* data);

int say_nothing(void*) { return 0; }  // Xlib's own ends the program

void note(void*, void* gone) { *static_cast<bool*>(gone) = true; }

}  // namespace

void note_display_end(bool& gone) {
    void* xlib = dlopen("libX11.so.6", RTLD_LAZY | RTLD_NOLOAD);
    if (xlib == nullptr) return;
    // NOLINTBEGIN(cppcoreguidelines-pro-type-reinterpret-cast): what dlsym gives is a function
    const auto set = reinterpret_cast<SetExitHandler>(dlsym(xlib, "XSetIOErrorExitHandler"));
    const auto speak = reinterpret_cast<SetHandler>(dlsym(xlib, "XSetIOErrorHandler"));
    const auto get = reinterpret_cast<GetDisplay>(dlsym(RTLD_DEFAULT, "glfwGetX11Display"));
    // NOLINTEND(cppcoreguidelines-pro-type-reinterpret-cast)
    void* display = get != nullptr ? get() : nullptr;
    if (set != nullptr && speak != nullptr && display != nullptr) {
        set(display, note, &gone);
        (void)speak(say_nothing);
    }
    dlclose(xlib);  // GLFW keeps it
}

}  // namespace bolt::platform
