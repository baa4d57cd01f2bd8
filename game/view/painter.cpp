#include "game/view/painter.hpp"

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
    Result<std::unique_ptr<gpu::Device>> device = gpu::Device::create(instance, on);
    if (!device) return fail(device.error());
    painter.device = std::move(*device);
    Result<std::unique_ptr<gpu::Frames>> frames = gpu::Frames::create(*painter.device);
    if (!frames) return fail(frames.error());
    painter.frames = std::move(*frames);
    render::RendererOptions with_cache = options;
    if (with_cache.pipeline_cache.empty()) with_cache.pipeline_cache = pipeline_file();
    Result<std::unique_ptr<render::Renderer>> renderer =
        render::Renderer::create(*painter.device, with_cache);
    if (!renderer) return fail(renderer.error());
    painter.renderer = std::move(*renderer);
    return painter;
}

}  // namespace bolt::view
