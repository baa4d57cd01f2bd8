// The GPU objects of the preview: context, light, model and swapchain.
#pragma once

#include <memory>

#include "engine/gpu/device.hpp"
#include "engine/gpu/swapchain.hpp"
#include "engine/render/renderer.hpp"
#include "game/view/camera.hpp"
#include "game/view/gpu_context.hpp"
#include "tools/author/preview/preview.hpp"

namespace bolt::author {

inline constexpr float level_error = 0.5F;  // px, largest visible error of a coarser level of detail

// Each member depends on those above it. The destructor waits until the GPU is idle before it releases them.
struct GpuState {
    view::GpuContext gpu_context;
    std::unique_ptr<render::EnvironmentLight> light;
    std::unique_ptr<view::ShownModel> shown_model;
    std::unique_ptr<gpu::Swapchain> swapchain;  // null without a window

    GpuState() = default;
    GpuState(GpuState&&) = default;
    GpuState& operator=(GpuState&&) = delete;
    ~GpuState() {
        if (gpu_context.device) (void)gpu_context.device->idle();
    }
};

// Width / height; 1 for a window without an area.
float aspect_of(VkExtent2D size);

// Creates all but the swapchain. `surface`: of the window; null without one.
Result<GpuState> upload(const PreviewOptions& options, const PreviewSources& sources,
                        const gpu::Instance& instance, const render::ShaderCode& shaders,
                        VkSurfaceKHR surface);

// The camera of the first picture: the named view, or one that shows the whole model.
view::Orbit initial_camera(const PreviewOptions& options, const PreviewSources& sources,
                           const view::ShownModel& shown_model, VkExtent2D size);

// Fails if the validation layers reported a message.
Status check_messages(const gpu::Instance& instance);

}  // namespace bolt::author
