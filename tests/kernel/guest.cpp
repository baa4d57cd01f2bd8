#include "tests/kernel/guest.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <thread>

namespace bolt::test {

bool becomes(const std::function<bool()>& so, double seconds) {
    for (const double until = device::steady_seconds() + seconds; !so();) {
        if (device::steady_seconds() > until) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return true;
}

emulate::Uhid plugged(std::unique_ptr<emulate::HidDevice> device) {
    auto plug = emulate::Uhid::plug_in(std::move(device));
    REQUIRE_MESSAGE(plug, (plug ? "" : plug.error().message()));
    return std::move(*plug);
}

device::ListedDevice listed(const std::string& id) {
    device::ListedDevice found;
    const auto is_there = [&] {
        for (const device::ListedDevice& l : device::list_devices())
            if (l.id == id) {
                found = l;
                return true;
            }
        return false;
    };
    REQUIRE_MESSAGE(becomes(is_there), id << " does not appear");
    return found;
}

bool holds_for_nobody(const std::function<bool()>& check) {
    const pid_t child = fork();
    if (child == 0) {
        if (setgid(65534) != 0 || setuid(65534) != 0) _exit(2);
        _exit(check() ? 0 : 1);
    }
    int status = 0;
    return waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace bolt::test
