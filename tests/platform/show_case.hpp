// A window with a validated GPU and a plain picture to present.
#pragma once

#include <doctest/doctest.h>

#include <optional>

#include "engine/gpu/swapchain.hpp"
#include "engine/platform/window.hpp"
#include "tests/support/need.hpp"
#include "tests/support/screen_picture.hpp"

namespace bolt::test {

class ShowCase {
  public:
    explicit ShowCase(const std::string& title);
    ~ShowCase();

    // Creates the device and everything that depends on it, for the same window: at the start, and after a
    // loss.
    void make_gpu();

    // Presents one frame of this colour (sRGB values). `drawn` receives the size that was drawn.
    Result<bool> show(std::array<int, 3> color);
    // Draws frames until one is presented.
    void show_surely(std::array<int, 3> color);

    platform::Window& window() { return *window_; }
    gpu::Swapchain& swapchain() { return *swapchain_; }
    [[nodiscard]] const gpu::ValidationLog& log() const { return instance_->log(); }
    VkExtent2D drawn{};
    std::optional<VkExtent2D> picture_size;  // if it differs from the window's

  private:
    Status prepare_picture(VkExtent2D extent);

    std::optional<platform::Desktop> desktop_;
    std::optional<platform::Window> window_;
    std::optional<gpu::Instance> instance_;
    std::unique_ptr<gpu::Device> device_;
    std::unique_ptr<gpu::Frames> frames_;
    gpu::Image picture_;
    std::unique_ptr<gpu::Swapchain> swapchain_;
};

}  // namespace bolt::test
