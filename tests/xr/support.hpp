// A small program that uses a headset as the trainer does.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/xr/headset.hpp"
#include "tests/mock_openxr/mock_runtime.hpp"

namespace bolt::test {

// Has a headset and Vulkan objects of it, and draws a frame when it is told to. As in the trainer, the CPU
// never waits for the GPU in a frame. Any message of the validation layers fails the test.
class Program {
  public:
    explicit Program(xr::HeadsetOptions options = {});
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;
    ~Program();

    xr::Headset& headset() { return *headset_; }
    gpu::Device& device() { return *device_; }
    [[nodiscard]] const std::vector<std::string>& lines() const { return lines_; }  // that were logged

    // Looks for a headset, creates Vulkan's objects for it and begins its session.
    bool connect();
    // Begins, draws and ends a frame. Returns what begin_frame() did.
    std::optional<xr::HeadsetFrame> frame();
    // Draws frames until the session is focused. Returns the last frame.
    xr::HeadsetFrame focus();
    // The pictures that frame() submits; the default is a picture of the recommended size in one colour for
    // each eye.
    void set_pictures(std::vector<xr::EyePicture> pictures) { pictures_ = std::move(pictures); }
    void set_passthrough(bool shown) { passthrough_ = shown; }
    void set_depth_range(const xr::DepthRange& range) { depth_ = range; }
    // Is called in each frame between the recording of the pictures and their submission.
    std::function<void()> while_drawing;
    // Makes an image with these texels, a layer after the other, in gpu::ResourceUse::transfer_from. It lives
    // until disconnect() or the next connect().
    const gpu::Image& make_image(VkFormat format, VkExtent2D extent, std::uint32_t layers,
                                 const std::vector<std::uint8_t>& texels);
    // Ends the headset and destroys Vulkan's objects.
    void disconnect();

  private:
    void make_default_pictures();
    VkCommandBuffer begin_commands();

    std::vector<std::string> lines_;
    double now_ = 0.0;
    std::unique_ptr<xr::Headset> headset_;
    std::unique_ptr<gpu::Instance> instance_;
    std::unique_ptr<gpu::Device> device_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    std::deque<gpu::Image> images_;
    std::vector<xr::EyePicture> pictures_;
    xr::DepthRange depth_;
    bool passthrough_ = false;
};

}  // namespace bolt::test
