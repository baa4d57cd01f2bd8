// Buffers and images with their memory: move-only, released by their owner.
#pragma once

#include <optional>
#include <span>

#include "engine/gpu/device.hpp"
#include "engine/gpu/handle.hpp"

namespace bolt::gpu {

class Buffer {
  public:
    Buffer() = default;
    static Result<Buffer> create(Device& device, VkDeviceSize size, VkBufferUsageFlags usage, MemoryUse use);
    Buffer(Buffer&& other) noexcept { swap(other); }
    Buffer& operator=(Buffer&& other) noexcept {
        swap(other);
        return *this;
    }
    ~Buffer();

    [[nodiscard]] VkBuffer get() const { return buffer_; }
    [[nodiscard]] VkDeviceSize size() const { return size_; }
    // The mapped memory; empty for MemoryUse::device.
    [[nodiscard]] std::span<std::byte> bytes() const {
        return {allocation_.mapped, allocation_.mapped != nullptr ? static_cast<std::size_t>(size_) : 0};
    }

  private:
    void swap(Buffer& other) noexcept;

    Device* device_ = nullptr;
    VkBuffer buffer_ = VK_NULL_HANDLE;
    VkDeviceSize size_ = 0;
    Allocation allocation_;
};

struct ImageInfo {
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkExtent2D extent{1, 1};
    std::uint32_t mips = 1, layers = 1;
    bool cube = false;  // six layers per cube
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
    VkImageUsageFlags usage = 0;
    bool array = false;  // viewed as an array even with one layer

    [[nodiscard]] VkImageAspectFlags aspect() const;
};

class Image {
  public:
    Image() = default;
    static Result<Image> create(Device& device, const ImageInfo& info);
    Image(Image&& other) noexcept { swap(other); }
    Image& operator=(Image&& other) noexcept {
        swap(other);
        return *this;
    }
    ~Image();

    [[nodiscard]] VkImage get() const { return image_; }
    [[nodiscard]] const ImageInfo& info() const { return info_; }
    // A view of the whole image: 2D, 2D array or cube, as the info says.
    [[nodiscard]] VkImageView view() const { return view_.get(); }
    // Creates a view of a part of the image.
    [[nodiscard]] Result<ImageView> view(VkImageViewType type, std::uint32_t first_mip, std::uint32_t mips,
                                         std::uint32_t first_layer, std::uint32_t layers) const;

  private:
    void swap(Image& other) noexcept;

    Device* device_ = nullptr;
    VkImage image_ = VK_NULL_HANDLE;
    ImageInfo info_;
    Allocation allocation_;
    ImageView view_;
};

struct SamplerInfo {
    VkFilter filter = VK_FILTER_LINEAR;
    VkSamplerAddressMode address = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    // Override the values above.
    std::optional<VkFilter> min_filter;
    std::optional<VkSamplerMipmapMode> mips;
    std::optional<VkSamplerAddressMode> address_v;
    bool compares = false;    // shadow maps: reference ≤ depth
    float anisotropy = 1.0F;  // a value above 1 is used if the GPU supports it
};
Result<Sampler> make_sampler(const Device& device, const SamplerInfo& info);

}  // namespace bolt::gpu
