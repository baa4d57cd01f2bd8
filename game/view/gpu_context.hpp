// The objects that every drawing needs: a GPU, its frames in flight and a renderer.
#pragma once

#include <filesystem>
#include <memory>

#include "engine/gpu/device.hpp"
#include "engine/gpu/frames.hpp"
#include "engine/render/renderer.hpp"

namespace bolt::view {

// A GPU with its frames and renderer. The order of the members is that of their dependencies.
struct GpuContext {
    std::unique_ptr<gpu::Device> device;
    std::unique_ptr<gpu::Frames> frames;
    std::unique_ptr<render::Renderer> renderer;
};

// The cache file of compiled pipelines: boltwright/pipelines in $XDG_CACHE_HOME or ~/.cache; empty if neither
// is set.
std::filesystem::path pipeline_file();

// Loads the pipelines from pipeline_file() unless the options name another file.
Result<GpuContext> make_gpu_context(const gpu::Instance& instance, const gpu::DeviceOptions& device_options,
                                    const render::RendererOptions& options = {});

}  // namespace bolt::view
