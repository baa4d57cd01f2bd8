// A GPU with all that drawing on it takes.
#pragma once

#include "engine/gpu/frames.hpp"
#include "engine/render/renderer.hpp"

namespace bolt::view {

// In the order in which they stand on each other.
struct Painter {
    std::unique_ptr<gpu::Device> device;
    std::unique_ptr<gpu::Frames> frames;
    std::unique_ptr<render::Renderer> renderer;
};

// Where compiled pipelines are kept between starts: boltwright/pipelines in $XDG_CACHE_HOME or ~/.cache;
// empty without either.
std::filesystem::path pipeline_file();

// With the pipelines of the last start, unless the options name another file.
Result<Painter> make_painter(const gpu::Instance& instance, const gpu::DeviceOptions& on,
                             const render::RendererOptions& options = {});

}  // namespace bolt::view
