#include "haptics/device/timer.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

namespace bolt::device {

Timer steady_timer() {
    return {
        [] {
            return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
        },
        [](double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }};
}

Timer virtual_timer(VirtualTime& time) {
    return {[&time] { return time.now; }, [&time](double seconds) { time.now += std::max(0.0, seconds); }};
}

}  // namespace bolt::device
