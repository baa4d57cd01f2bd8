// Presents pictures in a window and handles the window's changes: a new size, no area (minimised), a lost
// surface. A picture that cannot be presented is dropped, and the swapchain is recreated for the next one.
// Only a lost device is left to the caller, who must recreate everything made from it.
#pragma once

#include <functional>
#include <memory>

#include "engine/gpu/frames.hpp"
#include "engine/gpu/surface.hpp"
#include "engine/gpu/swapchain_choice.hpp"

namespace bolt::gpu {

// Creates the window's surface: at the start, and after a loss.
using MakeSurface = std::function<Result<Surface>()>;

struct SwapchainOptions {
    bool may_tear = false;
};

// Must be destroyed before the device, and the device must have been created for a surface of the same
// window.
class Swapchain {
  public:
    static Result<std::unique_ptr<Swapchain>> create(Device& device, Surface surface,
                                                     MakeSurface make_surface,
                                                     const SwapchainOptions& options = {});
    Swapchain(const Swapchain&) = delete;
    Swapchain& operator=(const Swapchain&) = delete;
    ~Swapchain();

    // Returns the size for the next picture; a zero width or height means that nothing can be shown now.
    // `window` is the window's size in pixels. Call it between frames.
    Result<VkExtent2D> ready(VkExtent2D window);

    // Copies a layer of `picture` (in use `transfer_from`, of any size) to the window, ends the frame and
    // submits it. Returns false if the picture was drawn but not presented.
    Result<bool> show(Frames& frames, FrameContext& frame, const Image& picture, std::uint32_t layer = 0);

    // The decisions for the current window, with reasons.
    [[nodiscard]] const SwapchainPlan& plan() const { return plan_; }
    // How often the swapchain was created: at the start, for every new size, after a loss.
    [[nodiscard]] std::uint32_t made() const { return made_; }

  private:
    Swapchain() = default;

    Status replace_surface();
    Result<bool> remake(VkExtent2D window);
    void copy(VkCommandBuffer commands, VkImage to, const Image& picture, std::uint32_t layer) const;
    Result<bool> judge(VkResult result, std::string_view what);

    Device* device_ = nullptr;
    SwapchainOptions options_;
    MakeSurface make_surface_;
    Surface surface_;
    SwapchainHandle swapchain_;
    SwapchainPlan plan_;
    std::vector<VkImage> images_;
    // Acquire semaphores belong to frames, present semaphores to images. When a frame's fence is signalled,
    // its acquire semaphore is free, but the presentation may still wait for the present semaphore.
    std::array<Semaphore, frames_in_flight> acquired_;
    std::vector<Semaphore> drawn_;
    std::uint32_t next_acquired_ = 0;
    VkExtent2D window_{};
    bool stale_ = true, lost_ = false;
    bool suboptimal_ = false, suboptimal_is_normal_ = false;  // normal: recreation did not help
    std::uint32_t losses_ = 0;  // losses of the surface since the last presentation
    std::uint32_t made_ = 0;
};

}  // namespace bolt::gpu
