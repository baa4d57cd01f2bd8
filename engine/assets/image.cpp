#include "engine/assets/image.hpp"

#include <memory>

#include "engine/assets/stb.hpp"

namespace bolt::assets {

namespace {

constexpr int side_limit = 16384;
constexpr std::int64_t pixel_limit = std::int64_t{1} << 26;

struct Free {
    void operator()(stbi_uc* pixels) const { stbi_image_free(pixels); }
};

void append(void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(data),
                                               static_cast<std::size_t>(size));
}

tl::unexpected<Error> image_error(const Image& image, const std::string& why) {
    return fail(ErrorCode::bad_content, "the image " + (image.name.empty() ? "" : image.name + " ") + why);
}

}  // namespace

Status decode(Image& image) {
    if (!image.pixels.empty()) return {};
    const auto* bytes = image.encoded.data();
    if (image.encoded.size() > (std::size_t{1} << 30U)) return image_error(image, "is larger than 1 GiB");
    const int size = static_cast<int>(image.encoded.size());
    int width = 0;
    int height = 0;
    int channels = 0;
    if (size == 0 || stbi_info_from_memory(bytes, size, &width, &height, &channels) == 0)
        return image_error(image, "is neither PNG nor JPEG");
    // Check the size before decoding, so that a few bytes cannot allocate all memory.
    if (width < 1 || height < 1 || width > side_limit || height > side_limit ||
        std::int64_t{width} * height > pixel_limit)
        return image_error(image,
                           "is larger than " + std::to_string(side_limit) + " pixels a side or 64 million");
    const std::unique_ptr<stbi_uc, Free> pixels(
        stbi_load_from_memory(bytes, size, &width, &height, &channels, 0));
    if (!pixels) return image_error(image, "cannot be decoded");
    image.width = width;
    image.height = height;
    image.channels = channels;
    const auto count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                       static_cast<std::size_t>(channels);
    image.pixels.assign(pixels.get(), pixels.get() + count);
    return {};
}

Result<std::string> encode_png(int width, int height, int channels, std::span<const std::uint8_t> pixels) {
    const bool sound = width > 0 && height > 0 && width <= side_limit && height <= side_limit &&
                       channels >= 1 && channels <= 4 &&
                       pixels.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                                            static_cast<std::size_t>(channels);
    if (!sound)
        return fail(ErrorCode::failed, "the pixels do not fill an image", "width × height × channels bytes");
    std::string bytes;
    if (stbi_write_png_to_func(append, &bytes, width, height, channels, pixels.data(), width * channels) == 0)
        return fail(ErrorCode::failed, "the PNG cannot be encoded");
    return bytes;
}

}  // namespace bolt::assets
