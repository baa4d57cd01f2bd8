// What a servo tick must not do, counted: allocate, lock, talk to the world, look at a clock. The program
// that links forbidden.cpp has the C library's functions for these replaced by ones that count and pass on,
// so calls from shared libraries (Embree, the C++ library) are seen too.
#pragma once

#include <utility>

namespace bolt::test {

struct Forbidden {
    int allocations = 0;  // and frees
    int locks = 0;        // and waits
    int io = 0;
    int clocks = 0;  // and sleeps
    [[nodiscard]] int all() const { return allocations + locks + io + clocks; }
};

// Sanitizers replace the C library's functions themselves: under them only operator new and delete are seen.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool sees_the_c_library = false;
#else
inline constexpr bool sees_the_c_library = true;
#endif

void begin_counting();  // of the calling thread
Forbidden end_counting();

template <class Work>
Forbidden forbidden_in(Work&& work) {
    begin_counting();
    std::forward<Work>(work)();
    return end_counting();
}

// Runs the work in a process of its own that the kernel ends at its first system call of any kind. True:
// there was none. (A mutex nobody else holds and a clock need no call: that is why the functions are counted
// as well.)
bool makes_no_system_call(void (*work)(void*), void* with);

template <class Work>
bool makes_no_system_call(Work& work) {
    return makes_no_system_call([](void* w) { (*static_cast<Work*>(w))(); }, &work);
}

}  // namespace bolt::test
