#include <atomic>
#include <cstdlib>
#include <new>

#include "tests/god_object/support.hpp"

namespace {
std::atomic<bool> watching{false};
std::atomic<int> allocations{0};
}  // namespace

void* operator new(std::size_t size) {
    if (watching) ++allocations;
    if (void* memory = std::malloc(size)) return memory;
    throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace bolt::test {

void start_counting() {
    allocations = 0;
    watching = true;
}

int stop_counting() {
    watching = false;
    return allocations;
}

}  // namespace bolt::test
