// Loads a model of a million triangles from its file to the GPU. Baseline: reading the file's bytes; the two
// alternate, and `x_bytes` is the ratio. Peer: tinygltf alone, which leaves the numbers unchecked in the
// file's buffers.
#include <benchmark/benchmark.h>

#include <filesystem>

#include "engine/assets/gltf.hpp"
#include "engine/assets/read/tinygltf.hpp"
#include "engine/base/file.hpp"
#include "engine/render/gpu_model.hpp"
#include "tools/bench/harness.hpp"
#include "tools/bench/machine.hpp"

namespace {

using namespace bolt;
using bench::Clock;
using bench::guarded;
using bench::milliseconds_since;
using bench::need;

constexpr bench::MachineSize million{115, 1'000'000};

// Triangles that share nothing and have no normals, as plain exporters write them: the renderer makes the
// normals.
assets::Model unshared(assets::Model model) {
    for (assets::Mesh& mesh : model.meshes) {
        assets::Primitive& part = mesh.primitives[0];
        std::vector<glm::vec3> corners;
        for (const std::uint32_t index : part.indices) corners.push_back(part.positions[index]);
        part.positions = std::move(corners);
        part.normals.clear();
        part.indices.clear();
    }
    return model;
}

// The machine in a temporary file.
struct File {
    std::filesystem::path path = std::filesystem::temp_directory_path() / "bolt-bench-million.glb";
    explicit File(bool shares) {
        const assets::Model model = bench::make_machine(million);
        need(assets::write_glb(path, shares ? model : unshared(model)));
    }
    ~File() {
        std::error_code ignored;
        std::filesystem::remove(path, ignored);
    }
    File(const File&) = delete;
    File& operator=(const File&) = delete;
};

double read_bytes(const std::filesystem::path& path) {
    const Clock::time_point start = Clock::now();
    const std::string bytes = need(read_file(path, std::size_t{1} << 30U, ErrorCode::failed));
    benchmark::DoNotOptimize(bytes.data());
    return milliseconds_since(start);
}

// Alternates `load` with the baseline.
template <class Load>
void load_file(benchmark::State& state, const Load& load, bool shares = true) {
    const File file(shares);
    double baseline = 0.0, sum = 0.0;
    for (auto _ : state) {
        baseline += read_bytes(file.path);
        const Clock::time_point start = Clock::now();
        load(file.path);
        const double now = milliseconds_since(start);
        state.SetIterationTime(1e-3 * now);
        sum += now;
    }
    state.counters["x_bytes"] = sum / baseline;
    state.counters["file_MB"] = static_cast<double>(std::filesystem::file_size(file.path)) / 1e6;
}

void load_million_tinygltf_alone(benchmark::State& state) {
    guarded(state, [&] {
        load_file(state, [](const std::filesystem::path& path) {
            tinygltf::TinyGLTF parser;
            tinygltf::Model model;
            std::string errors, warnings;
            if (!parser.LoadBinaryFromFile(&model, &errors, &warnings, path.string()))
                throw std::runtime_error(errors);
            benchmark::DoNotOptimize(model.buffers.data());
        });
    });
}
BENCHMARK(load_million_tinygltf_alone)->UseManualTime()->Unit(benchmark::kMillisecond);

void load_million_read(benchmark::State& state) {
    guarded(state, [&] {
        load_file(state, [](const std::filesystem::path& path) {
            const assets::Model model = need(assets::read_gltf(path));
            benchmark::DoNotOptimize(model.meshes.data());
        });
    });
}
BENCHMARK(load_million_read)->UseManualTime()->Unit(benchmark::kMillisecond);

void load_million_read_and_upload(benchmark::State& state, bool shares) {
    guarded(state, [&] {
        const gpu::Instance instance = need(gpu::Instance::create({}));
        const std::unique_ptr<gpu::Device> device = need(gpu::Device::create(instance, {}));
        double read = 0.0, upload = 0.0;
        load_file(
            state,
            [&](const std::filesystem::path& path) {
                Clock::time_point start = Clock::now();
                const assets::Model model = need(assets::read_gltf(path));
                read += milliseconds_since(start);
                start = Clock::now();
                const render::GpuModel gpu_model = need(render::upload_model(*device, model));
                upload += milliseconds_since(start);
                state.counters["triangles"] = static_cast<double>(gpu_model.triangles);
            },
            shares);
        state.counters["read_ms"] = read / static_cast<double>(state.iterations());
        state.counters["upload_ms"] = upload / static_cast<double>(state.iterations());
    });
}
BENCHMARK_CAPTURE(load_million_read_and_upload, shared, true)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(load_million_read_and_upload, unshared, false)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
