// Counts what a servo tick must not do: allocate, lock, perform I/O, read a clock. In programs that link
// forbidden.cpp, the C library's functions are replaced by counting wrappers, so that calls from shared
// libraries (Embree, the C++ library) are counted too.
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

// Sanitizers replace the C library's functions themselves; then only operator new and delete are counted.
#if defined(BOLT_SANITIZES_ADDRESS) || defined(BOLT_SANITIZES_THREAD)
inline constexpr bool sees_the_c_library = false;
#else
inline constexpr bool sees_the_c_library = true;
#endif

void begin_counting();  // on the calling thread
Forbidden end_counting();

template <class Work>
Forbidden forbidden_in(Work&& work) {
    begin_counting();
    std::forward<Work>(work)();
    return end_counting();
}

// Runs the work in a child process that the kernel kills at its first system call. Returns true if there was
// none. (An uncontended mutex and a clock need no system call, so the functions are counted as well.)
bool makes_no_system_call(void (*work)(void*), void* with);

template <class Work>
bool makes_no_system_call(Work& work) {
    return makes_no_system_call([](void* w) { (*static_cast<Work*>(w))(); }, &work);
}

}  // namespace bolt::test
