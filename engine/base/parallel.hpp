// Divides independent work among the processors.
#pragma once

#include <cstddef>

#include "engine/base/function_ref.hpp"

namespace bolt {

// Calls work(i) once for each i in 0…count − 1, from `threads` threads and in any order, and returns when all
// calls have returned. 0 threads: as many as there are processors. `work` must not throw. Where the system
// refuses a thread, there are fewer: the calling one always takes part.
void for_each_in_parallel(std::size_t count, FunctionRef<void(std::size_t)> work, std::size_t threads = 0);

}  // namespace bolt
