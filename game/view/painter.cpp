#include "game/view/painter.hpp"

namespace bolt::view {

Result<Painter> make_painter(const gpu::Instance& instance, const gpu::DeviceOptions& on,
                             const render::RendererOptions& options) {
    Painter painter;
    Result<std::unique_ptr<gpu::Device>> device = gpu::Device::create(instance, on);
    if (!device) return fail(device.error());
    painter.device = std::move(*device);
    Result<std::unique_ptr<gpu::Frames>> frames = gpu::Frames::create(*painter.device);
    if (!frames) return fail(frames.error());
    painter.frames = std::move(*frames);
    Result<std::unique_ptr<render::Renderer>> renderer = render::Renderer::create(*painter.device, options);
    if (!renderer) return fail(renderer.error());
    painter.renderer = std::move(*renderer);
    return painter;
}

}  // namespace bolt::view
