// bolt-bench: what the parts cost, each beside a named baseline in the same run. Ratios carry over between
// machines; nanoseconds do not. Nothing here is a test.

#include <benchmark/benchmark.h>

BENCHMARK_MAIN();
