// Benchmark of loading a model of a million triangles from its file to the GPU. Baseline: reading the file's
// bytes; the two alternate, and `x_bytes` is the ratio. Peer: tinygltf alone, which leaves the data unchecked
// in the file's buffers.
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
using bench::milliseconds_since;
using bench::run_or_skip;
using bench::unwrap;
using bench::WallClock;

constexpr bench::MachineSize million_triangles{115, 1'000'000};

// Returns the model with unshared vertices and without normals, as simple exporters write it. The renderer
// then computes the normals.
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

// A temporary file with the benchmark model.
struct TemporaryModelFile {
    std::filesystem::path path = std::filesystem::temp_directory_path() / "bolt-bench-million.glb";
    explicit TemporaryModelFile(bool shared) {
        const assets::Model model = bench::make_machine(million_triangles);
        unwrap(assets::write_glb(path, shared ? model : unshared(model)));
    }
    ~TemporaryModelFile() {
        std::error_code ignored;
        std::filesystem::remove(path, ignored);
    }
    TemporaryModelFile(const TemporaryModelFile&) = delete;
    TemporaryModelFile& operator=(const TemporaryModelFile&) = delete;
};

double read_bytes(const std::filesystem::path& path) {
    const WallClock::time_point start = WallClock::now();
    const std::string bytes = unwrap(read_file(path, std::size_t{1} << 30U, ErrorCode::failed));
    benchmark::DoNotOptimize(bytes.data());
    return milliseconds_since(start);
}

// Alternates `load` with the baseline.
template <class Load>
void load_file(benchmark::State& state, const Load& load, bool shared = true) {
    const TemporaryModelFile file(shared);
    double baseline = 0.0, sum = 0.0;
    for (auto _ : state) {
        baseline += read_bytes(file.path);
        const WallClock::time_point start = WallClock::now();
        load(file.path);
        const double now = milliseconds_since(start);
        state.SetIterationTime(1e-3 * now);
        sum += now;
    }
    state.counters["x_bytes"] = sum / baseline;
    state.counters["file_MB"] = static_cast<double>(std::filesystem::file_size(file.path)) / 1e6;
}

void load_million_tinygltf_alone(benchmark::State& state) {
    run_or_skip(state, [&] {
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
    run_or_skip(state, [&] {
        load_file(state, [](const std::filesystem::path& path) {
            const assets::Model model = unwrap(assets::read_gltf(path));
            benchmark::DoNotOptimize(model.meshes.data());
        });
    });
}
BENCHMARK(load_million_read)->UseManualTime()->Unit(benchmark::kMillisecond);

void load_million_read_and_upload(benchmark::State& state, bool shared) {
    run_or_skip(state, [&] {
        const gpu::Instance instance = unwrap(gpu::Instance::create({}));
        const std::unique_ptr<gpu::Device> device = unwrap(gpu::Device::create(instance, {}));
        double read = 0.0, upload = 0.0;
        load_file(
            state,
            [&](const std::filesystem::path& path) {
                WallClock::time_point start = WallClock::now();
                const assets::Model model = unwrap(assets::read_gltf(path));
                read += milliseconds_since(start);
                start = WallClock::now();
                const render::GpuModel gpu_model = unwrap(render::upload_model(*device, model));
                upload += milliseconds_since(start);
                state.counters["triangles"] = static_cast<double>(gpu_model.triangles);
            },
            shared);
        state.counters["read_ms"] = read / static_cast<double>(state.iterations());
        state.counters["upload_ms"] = upload / static_cast<double>(state.iterations());
    });
}
BENCHMARK_CAPTURE(load_million_read_and_upload, shared, true)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(load_million_read_and_upload, unshared, false)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
