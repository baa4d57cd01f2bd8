// Pictures on a window. What windows do to a program is handled here: they change their size, have no area
// for a while (minimised), and lose their surface. A picture that cannot be shown is dropped; the next one
// finds everything made anew. Only a lost device is the caller's: everything made from it has to be made
// again.
#pragma once

#include <functional>
#include <memory>

#include "engine/gpu/frames.hpp"
#include "engine/gpu/surface.hpp"
#include "engine/gpu/swapchain_choice.hpp"

namespace bolt::gpu {

// Makes the window's surface: at the start, and after it was lost.
using MakeSurface = std::function<Result<Surface>()>;

struct SwapchainOptions {
    bool may_tear = false;
};

// Goes before the device, which has to be made for a surface of the same window.
class Swapchain {
  public:
    static Result<std::unique_ptr<Swapchain>> create(Device& device, Surface surface,
                                                     MakeSurface make_surface,
                                                     const SwapchainOptions& options = {});
    Swapchain(const Swapchain&) = delete;
    Swapchain& operator=(const Swapchain&) = delete;
    ~Swapchain();

    // How large the next picture should be; nothing in one direction: there is nothing to show it on.
    // `window` is the window's size in pixels. Called between frames.
    Result<VkExtent2D> ready(VkExtent2D window);

    // Ends the frame with a copy of a layer of `picture` (in use `transfer_from`, of any size) on the window,
    // and hands it to the GPU. False: it was drawn but not shown.
    Result<bool> show(Frames& frames, Frame& frame, const Image& picture, std::uint32_t layer = 0);

    // What was decided for the window as it is, and why.
    [[nodiscard]] const SwapchainPlan& plan() const { return plan_; }
    // How often it was made: at the start, for every new size, after a loss.
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
    // An image is waited for with the semaphore of a frame, and shown with one of its own: when a frame's
    // fence is through, nobody waits for the first any more, but the screen may still wait for the second.
    std::array<Semaphore, frames_in_flight> acquired_;
    std::vector<Semaphore> drawn_;
    std::uint32_t next_acquired_ = 0;
    VkExtent2D window_{};
    bool stale_ = true, lost_ = false;
    bool suboptimal_ = false, suboptimal_is_normal_ = false;  // normal: making it anew did not help
    std::uint32_t losses_ = 0;                                // of the surface, since something was shown
    std::uint32_t made_ = 0;
};

}  // namespace bolt::gpu
