#include "engine/gpu/resources.hpp"

#include <algorithm>
#include <utility>

namespace bolt::gpu {

Result<Buffer> Buffer::create(Device& device, VkDeviceSize size, VkBufferUsageFlags usage, MemoryUse use) {
    Buffer buffer;
    buffer.device_ = &device;
    buffer.size_ = std::max<VkDeviceSize>(size, 4);
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = buffer.size_;
    info.usage = usage;
    if (Status made =
            check(vkCreateBuffer(device.get(), &info, nullptr, &buffer.buffer_), "creating a buffer");
        !made)
        return fail(made.error());
    VkMemoryRequirements needs{};
    vkGetBufferMemoryRequirements(device.get(), buffer.buffer_, &needs);
    BOLT_TRY_ASSIGN(auto allocation, device.memory().allocate(needs, use, Memory::Tiling::linear));
    buffer.allocation_ = allocation;
    const VkResult bound = vkBindBufferMemory(device.get(), buffer.buffer_, buffer.allocation_.memory,
                                              buffer.allocation_.offset);
    BOLT_TRY(check(bound, "binding a buffer"));
    return buffer;
}

void Buffer::swap(Buffer& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(buffer_, other.buffer_);
    std::swap(size_, other.size_);
    std::swap(allocation_, other.allocation_);
}

Buffer::~Buffer() {
    if (device_ == nullptr) return;
    vkDestroyBuffer(device_->get(), buffer_, nullptr);
    device_->memory().free(allocation_);
}

VkImageAspectFlags ImageInfo::aspect() const {
    switch (format) {
        case VK_FORMAT_D16_UNORM:
        case VK_FORMAT_D32_SFLOAT:
            return VK_IMAGE_ASPECT_DEPTH_BIT;
        default:
            return VK_IMAGE_ASPECT_COLOR_BIT;
    }
}

Result<Image> Image::create(Device& device, const ImageInfo& given) {
    Image image;
    image.device_ = &device;
    image.info_ = given;
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    if (given.cube) info.flags = VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = given.format;
    info.extent = {given.extent.width, given.extent.height, 1};
    info.mipLevels = given.mips;
    info.arrayLayers = given.layers;
    info.samples = given.samples;
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = given.usage;
    if (Status made = check(vkCreateImage(device.get(), &info, nullptr, &image.image_), "creating an image");
        !made)
        return fail(made.error());
    VkMemoryRequirements needs{};
    vkGetImageMemoryRequirements(device.get(), image.image_, &needs);
    BOLT_TRY_ASSIGN(auto allocation,
                    device.memory().allocate(needs, MemoryUse::device, Memory::Tiling::optimal));
    image.allocation_ = allocation;
    const VkResult bound =
        vkBindImageMemory(device.get(), image.image_, image.allocation_.memory, image.allocation_.offset);
    BOLT_TRY(check(bound, "binding an image"));

    const VkImageViewType type = given.cube                        ? VK_IMAGE_VIEW_TYPE_CUBE
                                 : given.layers > 1 || given.array ? VK_IMAGE_VIEW_TYPE_2D_ARRAY
                                                                   : VK_IMAGE_VIEW_TYPE_2D;
    BOLT_TRY_ASSIGN(auto view, image.view(type, 0, given.mips, 0, given.layers));
    image.view_ = std::move(view);
    return image;
}

Result<ImageView> Image::view(VkImageViewType type, std::uint32_t first_mip, std::uint32_t mips,
                              std::uint32_t first_layer, std::uint32_t layers) const {
    VkImageViewCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    info.image = image_;
    info.viewType = type;
    info.format = info_.format;
    info.subresourceRange = {info_.aspect(), first_mip, mips, first_layer, layers};
    VkImageView view = VK_NULL_HANDLE;
    if (Status made =
            check(vkCreateImageView(device_->get(), &info, nullptr, &view), "creating an image view");
        !made)
        return fail(made.error());
    return ImageView(device_->get(), view);
}

void Image::swap(Image& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(image_, other.image_);
    std::swap(info_, other.info_);
    std::swap(allocation_, other.allocation_);
    std::swap(view_, other.view_);
}

Image::~Image() {
    if (device_ == nullptr) return;
    view_ = {};
    vkDestroyImage(device_->get(), image_, nullptr);
    device_->memory().free(allocation_);
}

Result<Sampler> make_sampler(const Device& device, const SamplerInfo& given) {
    VkPhysicalDeviceFeatures features{};
    vkGetPhysicalDeviceFeatures(device.physical(), &features);
    VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    info.magFilter = given.filter;
    info.minFilter = given.min_filter.value_or(given.filter);
    info.mipmapMode = given.mips.value_or(given.filter == VK_FILTER_LINEAR ? VK_SAMPLER_MIPMAP_MODE_LINEAR
                                                                           : VK_SAMPLER_MIPMAP_MODE_NEAREST);
    info.addressModeU = info.addressModeW = given.address;
    info.addressModeV = given.address_v.value_or(given.address);
    // On llvmpipe (Mesa 22.3) anisotropic filtering took one millisecond per pixel: minutes per picture.
    const bool software = device.properties().deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    info.anisotropyEnable = given.anisotropy > 1.0F && !software ? features.samplerAnisotropy : VK_FALSE;
    info.maxAnisotropy = std::min(given.anisotropy, device.limits().maxSamplerAnisotropy);
    info.compareEnable = given.compares ? VK_TRUE : VK_FALSE;
    info.compareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
    info.maxLod = VK_LOD_CLAMP_NONE;
    info.borderColor = VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE;
    VkSampler sampler = VK_NULL_HANDLE;
    if (Status made = check(vkCreateSampler(device.get(), &info, nullptr, &sampler), "creating a sampler");
        !made)
        return fail(made.error());
    return Sampler(device.get(), sampler);
}

}  // namespace bolt::gpu
