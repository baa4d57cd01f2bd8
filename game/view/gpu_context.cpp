#include "game/view/gpu_context.hpp"

#include <cstdlib>

#include "engine/base/result.hpp"

namespace bolt::view {

std::filesystem::path pipeline_file() {
    const auto folder = [](const char* variable) {
        const char* value = std::getenv(variable);
        return std::filesystem::path(value != nullptr ? value : "");
    };
    if (const auto cache = folder("XDG_CACHE_HOME"); cache.is_absolute())
        return cache / "boltwright" / "pipelines";
    if (const auto home = folder("HOME"); home.is_absolute())
        return home / ".cache" / "boltwright" / "pipelines";
    return {};
}

Result<GpuContext> make_gpu_context(const gpu::Instance& instance, const gpu::DeviceOptions& device_options,
                                    const render::RendererOptions& options) {
    GpuContext gpu_context;
    BOLT_TRY_ASSIGN(auto device, gpu::Device::create(instance, device_options));
    gpu_context.device = std::move(device);
    BOLT_TRY_ASSIGN(auto frames, gpu::Frames::create(*gpu_context.device));
    gpu_context.frames = std::move(frames);
    render::RendererOptions with_cache = options;
    if (with_cache.pipeline_cache.empty()) with_cache.pipeline_cache = pipeline_file();
    BOLT_TRY_ASSIGN(auto renderer, render::Renderer::create(*gpu_context.device, with_cache));
    gpu_context.renderer = std::move(renderer);
    return gpu_context;
}

}  // namespace bolt::view
