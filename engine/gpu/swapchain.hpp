// Presents pictures in a window: the swapchain, and the choice of its properties.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/gpu/device.hpp"
#include "engine/gpu/frames.hpp"
#include "engine/gpu/vk.hpp"

namespace bolt::gpu {

// The capabilities of a surface, as Vulkan reports them.
struct SurfaceSupport {
    VkSurfaceCapabilitiesKHR capabilities{};
    std::vector<VkSurfaceFormatKHR> formats;
    std::vector<VkPresentModeKHR> modes;
};

// Fills `support`; returns the result of the first Vulkan call that fails.
VkResult query_surface(VkPhysicalDevice gpu, VkSurfaceKHR surface, SurfaceSupport& support);

struct SwapchainRequest {
    VkExtent2D window{};          // pixels; used if the surface does not determine the size
    std::uint32_t in_flight = 2;  // number of frames in flight
};

struct SwapchainPlan {
    VkSurfaceFormatKHR format{};
    VkPresentModeKHR mode = VK_PRESENT_MODE_FIFO_KHR;
    VkExtent2D extent{};  // a zero width or height: nothing can be presented now (minimised window)
    std::uint32_t images = 0;
    VkSurfaceTransformFlagBitsKHR transform = VK_SURFACE_TRANSFORM_IDENTITY_BIT_KHR;
    VkCompositeAlphaFlagBitsKHR alpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    std::vector<std::string> reasons;  // one line per decision
};

// Chooses format, present mode, size and image count. The error names what the surface lacks. A pure function
// over the surface's capabilities, so that tests need no window.
Result<SwapchainPlan> plan_swapchain(const SurfaceSupport& support, const SwapchainRequest& request);

// Creates a surface of the window. Swapchain calls it after the loss of its surface.
using MakeSurface = std::function<Result<Surface>()>;

// A picture for a window, or for a part of it.
struct ShownPicture {
    const Image* picture = nullptr;  // in ResourceUse::transfer_from, of any size
    std::uint32_t layer = 0;
    std::optional<VkRect2D> part;   // of the picture; none: all of it
    std::optional<VkRect2D> place;  // in the window, px; none: all of it
};

class Swapchain;

// The pictures of one window in a frame. The window is black where no picture covers it.
struct WindowPictures {
    Swapchain* swapchain = nullptr;
    std::vector<ShownPicture> pictures;
    // false: if the window is not ready, present nothing; true: wait at most 0.2 s for it.
    bool waits = true;
};

// Copies the pictures to their windows, ends the frame, submits it, and presents all windows together, so
// that they change in the same refresh of synchronised displays. Returns how many windows were presented;
// the pictures of the others were drawn but dropped. `before_presenting` is called between submitting and
// presenting, for example to wait for other processes; it may be empty.
Result<std::uint32_t> present(Frames& frames, FrameContext& frame, std::span<const WindowPictures> windows,
                              const std::function<Status()>& before_presenting = {});

// Handles the window's changes: a new size, no area (minimised), a lost surface. A picture that cannot be
// presented is dropped, and the swapchain is recreated for the next one. After a lost device the caller must
// recreate everything created from the device. The device must have been created for a surface of the same
// window, and must outlive the swapchain.
class Swapchain {
  public:
    static Result<std::unique_ptr<Swapchain>> create(Device& device, Surface surface,
                                                     MakeSurface make_surface);
    Swapchain(const Swapchain&) = delete;
    Swapchain& operator=(const Swapchain&) = delete;
    ~Swapchain();

    // Recreates the swapchain if necessary. Returns the size for the next picture; a zero width or height
    // means that nothing can be presented now. `window`: the window's size in pixels. Call it between frames.
    Result<VkExtent2D> prepare(VkExtent2D window);

    // Presents one picture in this window: copies it, submits the frame, presents. Returns false if the
    // picture was drawn but dropped. See gpu::present() above.
    Result<bool> present(Frames& frames, FrameContext& frame, const ShownPicture& picture, bool waits = true);

    // The choices for the current window, with reasons.
    [[nodiscard]] const SwapchainPlan& plan() const { return plan_; }
    // Number of times that the swapchain was created: at the start, for every new size, after a loss.
    [[nodiscard]] std::uint32_t creations() const { return creations_; }

  private:
    friend Result<std::uint32_t> present(Frames& frames, FrameContext& frame,
                                         std::span<const WindowPictures> windows,
                                         const std::function<Status()>& before_presenting);
    // An image of the swapchain that was acquired, and its semaphores.
    struct Acquired {
        std::uint32_t index = 0;
        VkSemaphore acquired = VK_NULL_HANDLE, presentable = VK_NULL_HANDLE;
    };
    Swapchain() = default;

    Status replace_surface();
    Result<bool> recreate(VkExtent2D window);
    Result<std::optional<Acquired>> acquire(bool waits);
    void copy(VkCommandBuffer commands, VkImage to, std::span<const ShownPicture> pictures) const;
    Result<bool> handle(VkResult result, std::string_view what);

    Device* device_ = nullptr;
    MakeSurface make_surface_;
    Surface surface_;
    SwapchainHandle swapchain_;
    SwapchainPlan plan_;
    std::vector<VkImage> images_;
    // Acquire semaphores belong to frames, present semaphores to images. When a frame's fence is signalled,
    // its acquire semaphore is free, but the presentation may still wait for the present semaphore.
    std::array<Semaphore, frames_in_flight> acquire_semaphores_;
    std::vector<Semaphore> present_semaphores_;
    std::uint32_t next_acquire_ = 0;
    VkExtent2D window_{};
    bool stale_ = true, lost_ = false;
    bool suboptimal_ = false, ignore_suboptimal_ = false;  // ignored while the size is right
    std::uint32_t losses_ = 0;                             // of the surface, since the last presentation
    std::uint32_t creations_ = 0;
};

}  // namespace bolt::gpu
