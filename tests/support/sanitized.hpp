// True in builds with sanitizers, which run about ten times as long. Long statistical runs are then shortened
// if shorter tests cover the same code.
#pragma once

namespace bolt::test {

#if defined(BOLT_SANITIZES_ADDRESS) || defined(BOLT_SANITIZES_THREAD)
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif

}  // namespace bolt::test
