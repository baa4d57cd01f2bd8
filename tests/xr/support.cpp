#include "tests/xr/support.hpp"

#include <doctest/doctest.h>

#include "tests/support/need.hpp"

namespace bolt::test {

Program::Program(xr::HeadsetOptions options) {
    options.log = [this](const std::string& line) { lines_.push_back(line); };
    headset_ = std::make_unique<xr::Headset>(std::move(options));
}

Program::~Program() { disconnect(); }

void Program::disconnect() {
    headset_->end();
    pictures_.clear();
    if (device_ != nullptr) {
        need(device_->idle());
        images_.clear();
        vkDestroyCommandPool(device_->get(), pool_, nullptr);
    }
    device_.reset();
    if (instance_ != nullptr)
        for (const std::string& message : instance_->log().messages) CHECK_MESSAGE(false, message);
    instance_.reset();
}

bool Program::connect() {
    now_ += 100.0;  // after a session that did not start, it searches less often
    if (!headset_->find(now_)) return false;
    if (device_ != nullptr) {
        need(device_->idle());
        images_.clear();
        pictures_.clear();
        vkDestroyCommandPool(device_->get(), pool_, nullptr);
        device_.reset();
        for (const std::string& message : instance_->log().messages) CHECK_MESSAGE(false, message);
        instance_.reset();
    }
    gpu::InstanceOptions instance;
    instance.validation = true;
    instance.creator = headset_->creator();
    instance_ = std::make_unique<gpu::Instance>(need(gpu::Instance::create(instance)));
    gpu::DeviceOptions device;
    device.creator = headset_->creator();
    device_ = need(gpu::Device::create(*instance_, device));
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool.queueFamilyIndex = device_->queue_family();
    REQUIRE(vkCreateCommandPool(device_->get(), &pool, nullptr, &pool_) == VK_SUCCESS);
    headset_->begin(*device_);
    if (!headset_->connected()) return false;
    make_default_pictures();
    return true;
}

const gpu::Image& Program::make_image(VkFormat format, VkExtent2D extent, std::uint32_t layers,
                                      const std::vector<std::uint8_t>& texels) {
    gpu::ImageInfo info;
    info.format = format;
    info.extent = extent;
    info.layers = layers;
    info.usage =
        VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    images_.push_back(need(gpu::Image::create(*device_, info)));
    const gpu::Image& image = images_.back();
    gpu::Buffer buffer = need(gpu::Buffer::create(*device_, texels.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                                  gpu::MemoryUse::upload));
    std::copy(texels.begin(), texels.end(), reinterpret_cast<std::uint8_t*>(buffer.bytes().data()));
    gpu::ImageRange range;
    range.aspect = info.aspect();
    need(gpu::submit_and_wait(*device_, [&](VkCommandBuffer commands) {
        gpu::image_barrier(commands, image.get(), gpu::ResourceUse::undefined, gpu::ResourceUse::transfer_to,
                           range);
        VkBufferImageCopy region{};
        region.imageSubresource = {range.aspect, 0, 0, layers};
        region.imageExtent = {extent.width, extent.height, 1};
        vkCmdCopyBufferToImage(commands, buffer.get(), image.get(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                               &region);
        gpu::image_barrier(commands, image.get(), gpu::ResourceUse::transfer_to,
                           gpu::ResourceUse::transfer_from, range);
    }));
    return image;
}

void Program::make_default_pictures() {
    const VkExtent2D extent = headset_->session().extent();
    const std::size_t texels = std::size_t{extent.width} * extent.height;
    for (std::size_t eye = 0; eye < headset_->runtime().views().size(); ++eye) {
        const std::vector<std::uint8_t> gray(4 * texels, eye == 0 ? 90 : 180);
        pictures_.push_back({&make_image(VK_FORMAT_R8G8B8A8_SRGB, extent, 1, gray), 0, nullptr, 0, extent});
    }
}

VkCommandBuffer Program::begin_commands() {
    VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    info.commandPool = pool_;
    info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    info.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    REQUIRE(vkAllocateCommandBuffers(device_->get(), &info, &commands) == VK_SUCCESS);
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    REQUIRE(vkBeginCommandBuffer(commands, &begin) == VK_SUCCESS);
    return commands;
}

std::optional<xr::HeadsetFrame> Program::frame() {
    std::optional<xr::HeadsetFrame> frame = headset_->begin_frame(1.0);
    if (!frame) return frame;
    bool drawn = false;
    headset_->locate(*frame);
    if (frame->timing.should_render && !frame->view.eyes.empty()) {
        VkCommandBuffer commands = begin_commands();
        headset_->record(commands, pictures_);
        if (while_drawing) while_drawing();
        REQUIRE(vkEndCommandBuffer(commands) == VK_SUCCESS);
        VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
        submit.commandBufferCount = 1;
        submit.pCommandBuffers = &commands;
        REQUIRE(vkQueueSubmit(device_->queue(), 1, &submit, VK_NULL_HANDLE) == VK_SUCCESS);
        drawn = true;
    }
    frame->passthrough = passthrough_;
    headset_->end_frame(*frame, drawn, depth_);
    return frame;
}

xr::HeadsetFrame Program::focus() {
    for (int i = 0; i < 20; ++i) {
        const std::optional<xr::HeadsetFrame> drawn = frame();
        if (drawn && drawn->focused) return *drawn;
    }
    FAIL("the session is not focused after 20 frames");
    return {};
}

}  // namespace bolt::test
