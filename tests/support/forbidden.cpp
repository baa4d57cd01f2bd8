#include "tests/support/forbidden.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <pthread.h>
#include <sched.h>
#include <semaphore.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <iterator>
#include <new>

namespace {

thread_local bool counting = false;
thread_local bolt::test::Forbidden seen;

void count_forbidden(int bolt::test::Forbidden::*kind) {
    if (counting) ++(seen.*kind);
}

}  // namespace

namespace bolt::test {

void begin_counting() {
    seen = {};
    counting = true;
}

Forbidden end_counting() {
    counting = false;
    return seen;
}

bool makes_no_system_call(void (*work)(void*), void* with) {
    const pid_t child = fork();
    if (child < 0) return false;
    if (child == 0) {
        sock_filter program[] = {
            BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
            BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_exit_group, 0, 1),
            BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
            BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS),
        };
        const sock_fprog filter{static_cast<unsigned short>(std::size(program)), program};
        if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) _exit(2);
        if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) != 0) _exit(2);
        work(with);
        _exit(0);
    }
    int status = 0;
    return waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace bolt::test

// Not in a test's own file: if inlined there, gcc reports the pair as mismatched.
void* operator new(std::size_t size) {
    count_forbidden(&bolt::test::Forbidden::allocations);
    if (void* memory = std::malloc(size)) return memory;
    throw std::bad_alloc();
}
// Used by the standard library's sorts.
void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
    count_forbidden(&bolt::test::Forbidden::allocations);
    return std::malloc(size);
}
void operator delete(void* memory) noexcept {
    count_forbidden(&bolt::test::Forbidden::allocations);
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept { operator delete(memory); }

#if !defined(BOLT_SANITIZES_ADDRESS) && !defined(BOLT_SANITIZES_THREAD)

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);
}

namespace {

// Looks up the replaced function once. The lookup may allocate, which is not counted.
template <class Function>
Function* next(const char* name, Function*& found) {
    if (found == nullptr) {
        const bool was = std::exchange(counting, false);
        found = reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
        counting = was;
    }
    return found;
}

}  // namespace

// NOLINTBEGIN: these are the C library's names and signatures.
#define PASS_ON(kind, result, name, parameters, ...)   \
    extern "C" result name parameters {                \
        static result(*found) parameters = nullptr;    \
        count_forbidden(&bolt::test::Forbidden::kind); \
        return next(#name, found)(__VA_ARGS__);        \
    }

extern "C" {
void* malloc(std::size_t size) {
    count_forbidden(&bolt::test::Forbidden::allocations);
    return __libc_malloc(size);
}
void* calloc(std::size_t n, std::size_t size) {
    count_forbidden(&bolt::test::Forbidden::allocations);
    return __libc_calloc(n, size);
}
void* realloc(void* memory, std::size_t size) {
    count_forbidden(&bolt::test::Forbidden::allocations);
    return __libc_realloc(memory, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
    count_forbidden(&bolt::test::Forbidden::allocations);
    return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
    count_forbidden(&bolt::test::Forbidden::allocations);
    return __libc_memalign(alignment, size);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
    count_forbidden(&bolt::test::Forbidden::allocations);
    *memory = __libc_memalign(alignment, size);
    return *memory == nullptr ? 12 : 0;  // ENOMEM
}
void free(void* memory) {
    count_forbidden(&bolt::test::Forbidden::allocations);
    __libc_free(memory);
}
}

PASS_ON(locks, int, pthread_mutex_lock, (pthread_mutex_t * m), m)
PASS_ON(locks, int, pthread_mutex_trylock, (pthread_mutex_t * m), m)
PASS_ON(locks, int, pthread_rwlock_rdlock, (pthread_rwlock_t * m), m)
PASS_ON(locks, int, pthread_rwlock_wrlock, (pthread_rwlock_t * m), m)
PASS_ON(locks, int, pthread_cond_wait, (pthread_cond_t * c, pthread_mutex_t* m), c, m)
PASS_ON(locks, int, pthread_cond_broadcast, (pthread_cond_t * c), c)
PASS_ON(locks, int, pthread_cond_signal, (pthread_cond_t * c), c)
PASS_ON(locks, int, sem_wait, (sem_t * s), s)
PASS_ON(locks, int, sem_post, (sem_t * s), s)

PASS_ON(io, ssize_t, read, (int f, void* data, std::size_t n), f, data, n)
PASS_ON(io, ssize_t, write, (int f, const void* data, std::size_t n), f, data, n)
PASS_ON(io, std::size_t, fwrite, (const void* data, std::size_t size, std::size_t n, FILE* f), data, size, n,
        f)
PASS_ON(io, int, fflush, (FILE * f), f)
PASS_ON(io, int, fputs, (const char* text, FILE* f), text, f)
PASS_ON(io, int, puts, (const char* text), text)
PASS_ON(io, FILE*, fopen, (const char* path, const char* mode), path, mode)

PASS_ON(clocks, int, clock_gettime, (clockid_t id, timespec* t) noexcept, id, t)
PASS_ON(clocks, int, nanosleep, (const timespec* t, timespec* left), t, left)
PASS_ON(clocks, int, clock_nanosleep, (clockid_t id, int flags, const timespec* t, timespec* left), id, flags,
        t, left)
PASS_ON(clocks, int, usleep, (useconds_t us), us)
PASS_ON(clocks, std::time_t, time, (std::time_t * t) noexcept, t)
PASS_ON(clocks, int, sched_yield, () noexcept)
// NOLINTEND

#endif
