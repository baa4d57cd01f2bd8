// Whether a sanitizer slows everything down tenfold here: long runs that are about figures, and whose code
// shorter ones walk too, are shorter then.
#pragma once

namespace bolt::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif

}  // namespace bolt::test
