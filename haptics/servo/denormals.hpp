// Flushes denormal numbers to zero in the calling thread for the lifetime of the object, as Embree
// recommends. On many processors arithmetic with denormals is a hundred times slower, which would delay a
// tick while a force fades out. The tick creates one itself, so that the same inputs give the same bits on
// every thread.
#pragma once

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif
#include <cstdint>

namespace bolt::servo {

class FlushDenormals {
  public:
    FlushDenormals() : before_(read()) { write(before_ | bits); }
    ~FlushDenormals() { write(before_); }
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;

    // Returns false on processors other than x86 and 64-bit ARM; the object then does nothing.
    static constexpr bool supported() { return bits != 0; }

  private:
#if defined(__SSE2__)
    using Word = std::uint32_t;
    static constexpr Word bits = 0x8040;  // flush to zero (results), denormals are zero (operands)
    static Word read() { return _mm_getcsr(); }
    static void write(Word word) { _mm_setcsr(word); }
#elif defined(__aarch64__)
    using Word = std::uint64_t;
    static constexpr Word bits = 1U << 24;  // FZ
    static Word read() {
        Word word = 0;
        asm volatile("mrs %0, fpcr" : "=r"(word));
        return word;
    }
    static void write(Word word) { asm volatile("msr fpcr, %0" : : "r"(word)); }
#else
    using Word = std::uint32_t;
    static constexpr Word bits = 0;
    static Word read() { return 0; }
    static void write(Word) {}
#endif

    Word before_;
};

}  // namespace bolt::servo
