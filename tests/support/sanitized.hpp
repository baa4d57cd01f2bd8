// True in builds with sanitizers, which run about ten times as long. Long statistical runs are then shortened
// if shorter tests cover the same code.
#pragma once

namespace bolt::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif

}  // namespace bolt::test
