// bolt-bench: measures each part and a named baseline in the same run. Ratios are comparable between
// machines, nanoseconds are not. No benchmark is a test.
//   bolt-bench --machine FILE.glb    writes the benchmark model, for other renderers (peer/)

#include <benchmark/benchmark.h>

#include <string_view>

#include "engine/assets/gltf.hpp"
#include "engine/base/result.hpp"
#include "tools/bench/machine.hpp"

int main(int argc, char** argv) {
    if (argc == 3 && std::string_view(argv[1]) == "--machine") {
        const bolt::Status written = bolt::assets::write_glb(argv[2], bolt::bench::make_machine());
        return written ? 0 : bolt::print_error(written.error());
    }
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}
