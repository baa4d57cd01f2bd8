#include "tests/kernel/guest.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <thread>

namespace bolt::test {

bool holds_within(const std::function<bool()>& condition, double seconds) {
    for (const double deadline = steady_seconds() + seconds; !condition();) {
        if (steady_seconds() > deadline) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return true;
}

emulate::Uhid attach(std::unique_ptr<emulate::HidDevice> device) {
    auto plug = emulate::Uhid::plug_in(std::move(device));
    REQUIRE_MESSAGE(plug, (plug ? "" : plug.error().message()));
    return std::move(*plug);
}

device::ListedDevice wait_for_device(const std::string& id) {
    device::ListedDevice found;
    const auto appears = [&] {
        for (const device::ListedDevice& l : device::list_devices())
            if (l.id == id) {
                found = l;
                return true;
            }
        return false;
    };
    REQUIRE_MESSAGE(holds_within(appears), id << " does not appear");
    return found;
}

bool holds_unprivileged(const std::function<bool()>& check) {
    const pid_t child = fork();
    if (child == 0) {
        if (setgid(65534) != 0 || setuid(65534) != 0) _exit(2);
        _exit(check() ? 0 : 1);
    }
    int status = 0;
    return waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace bolt::test
