#include "game/view/gpu_context.hpp"

#include <cstdlib>

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

Result<Painter> make_painter(const gpu::Instance& instance, const gpu::DeviceOptions& on,
                             const render::RendererOptions& options) {
    Painter painter;
    BOLT_TRY_ASSIGN(auto device, gpu::Device::create(instance, on));
    painter.device = std::move(device);
    BOLT_TRY_ASSIGN(auto frames, gpu::Frames::create(*painter.device));
    painter.frames = std::move(frames);
    render::RendererOptions with_cache = options;
    if (with_cache.pipeline_cache.empty()) with_cache.pipeline_cache = pipeline_file();
    BOLT_TRY_ASSIGN(auto renderer, render::Renderer::create(*painter.device, with_cache));
    painter.renderer = std::move(renderer);
    return painter;
}

}  // namespace bolt::view
