// Buffers and images with their memory, samplers, barriers between their uses, and transfers to and from the
// CPU.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "engine/gpu/device.hpp"
#include "engine/gpu/vk.hpp"

namespace bolt::gpu {

// Move-only; releases its memory.
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
    // Returns the mapped memory; empty for MemoryUse::device.
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
    // Format of storage_view(), with the texel size of `format`. Set it if `format` is not allowed for
    // storage images (sRGB). Undefined: `format`. Used only with VK_IMAGE_USAGE_STORAGE_BIT.
    VkFormat storage_format = VK_FORMAT_UNDEFINED;

    [[nodiscard]] VkImageAspectFlags aspect() const;
};

// Move-only; releases its memory.
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
    // Returns a view of the whole image: 2D, 2D array or cube, according to its ImageInfo.
    [[nodiscard]] VkImageView view() const { return view_.get(); }
    // Returns the view of mip 0 through which compute shaders write; null without
    // VK_IMAGE_USAGE_STORAGE_BIT.
    [[nodiscard]] VkImageView storage_view() const { return storage_view_.get(); }
    // Creates a view of a part of the image.
    [[nodiscard]] Result<ImageView> view(VkImageViewType type, std::uint32_t first_mip, std::uint32_t mips,
                                         std::uint32_t first_layer, std::uint32_t layers) const;

  private:
    void swap(Image& other) noexcept;
    Result<ImageView> make_view(VkImageViewCreateInfo info, VkImageUsageFlags usage) const;
    Status make_whole_views();

    Device* device_ = nullptr;
    VkImage image_ = VK_NULL_HANDLE;
    ImageInfo info_;
    Allocation allocation_;
    ImageView view_, storage_view_;
};

struct SamplerInfo {
    VkFilter filter = VK_FILTER_LINEAR;
    VkSamplerAddressMode address = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    std::optional<VkFilter> min_filter;             // for minification; none: `filter`
    std::optional<VkSamplerMipmapMode> mips;        // filter between mips; none: according to `filter`
    std::optional<VkSamplerAddressMode> address_v;  // for v; none: `address`
    bool compares = false;                          // for shadow maps: returns whether reference ≤ depth
    float anisotropy = 1.0F;  // a value above 1 is used on GPUs that support it, but not in software
};
Result<Sampler> make_sampler(const Device& device, const SamplerInfo& info);

// The uses of a resource. A barrier moves a resource from one use to another; use_info() defines the pipeline
// stages, accesses and image layout of each use.
enum class ResourceUse : std::uint8_t {
    undefined,      // newly created
    acquired,       // from the swapchain, with undefined contents; copies wait for the acquire semaphore
    color_target,   // a target of drawing or resolving
    depth_target,   // tested and written
    depth_read,     // tested and sampled at the same time
    sampled,        // read in fragment or compute shaders
    storage_write,  // written (and read) in compute shaders
    vertex_read,    // vertex and index buffers, and buffers read in vertex shaders
    uniform_read,   // buffers read in any shader
    transfer_from,
    transfer_to,
    host_read,  // read by the CPU after the fence
    present,
};

struct ResourceUseInfo {
    VkPipelineStageFlags2 stages = 0;
    VkAccessFlags2 access = 0;
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
};

ResourceUseInfo use_info(ResourceUse use);

struct ImageRange {
    VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
    std::uint32_t first_mip = 0, mips = VK_REMAINING_MIP_LEVELS;
    std::uint32_t first_layer = 0, layers = VK_REMAINING_ARRAY_LAYERS;
};

// Lets the GPU wait for the use `from`, makes its writes visible to the use `to`, and changes the image's
// layout. The contents are lost if `from` is undefined or acquired.
void image_barrier(VkCommandBuffer commands, VkImage image, ResourceUse from, ResourceUse to,
                   const ImageRange& range = {});

// As image_barrier(), but discards the contents: waits for the last use, then changes the layout. Use it for
// targets that are redrawn in every frame, because the GPU may still read the previous frame's contents.
void image_barrier_discarding(VkCommandBuffer commands, VkImage image, ResourceUse last, ResourceUse to,
                              const ImageRange& range = {});

// A barrier for all buffers. Buffers have no layout, and a global memory barrier costs the same as a buffer
// barrier.
void memory_barrier(VkCommandBuffer commands, ResourceUse from, ResourceUse to);

// The following functions transfer data outside of frames, for loading and tests. Each waits for the GPU.

// Records commands, submits them and waits for their completion.
Status submit_and_wait(Device& device, const std::function<void(VkCommandBuffer)>& record);

// Creates a buffer in device memory with these bytes.
Result<Buffer> upload_buffer(Device& device, std::span<const std::byte> bytes, VkBufferUsageFlags usage);

// Fills mip 0 of every layer from `texels` (layers one after the other), generates the other mips by halving,
// and leaves the image in ResourceUse::sampled. The image needs VK_IMAGE_USAGE_TRANSFER_DST_BIT. With several
// mips it also needs VK_IMAGE_USAGE_TRANSFER_SRC_BIT and a format that supports linear blits.
Status upload_image(Device& device, Image& image, std::span<const std::byte> texels);

// Reads the texels of one mip of one layer. The image is in the use `from` before and afterwards.
Result<std::vector<std::byte>> download_image(Device& device, const Image& image, ResourceUse from,
                                              std::uint32_t texel_size, std::uint32_t mip = 0,
                                              std::uint32_t layer = 0);

}  // namespace bolt::gpu
