// The time on the steady clock.
#pragma once

#include <chrono>

namespace bolt {

// s since an arbitrary origin; it never goes back.
inline double steady_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace bolt
