#include "engine/assets/image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>

#include "engine/assets/stb.hpp"
#include "engine/base/file.hpp"

namespace bolt::assets {

namespace {

constexpr int side_limit = 16384;
constexpr std::int64_t pixel_limit = std::int64_t{1} << 26;

struct FreePixels {
    void operator()(void* pixels) const { stbi_image_free(pixels); }
};

void append(void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(data),
                                               static_cast<std::size_t>(size));
}

tl::unexpected<Error> image_error(const Bitmap& image, const std::string& why, std::string expected) {
    return fail(ErrorCode::bad_content, "the image " + (image.name.empty() ? "" : image.name + " ") + why,
                std::move(expected));
}

}  // namespace

Status decode(Bitmap& image) {
    if (!image.pixels.empty()) return {};
    const auto* bytes = image.encoded.data();
    if (image.encoded.size() > (std::size_t{1} << 30U))
        return image_error(image, "is larger than 1 GiB", "a smaller image");
    const int size = static_cast<int>(image.encoded.size());
    int width = 0;
    int height = 0;
    int channels = 0;
    if (size == 0 || stbi_info_from_memory(bytes, size, &width, &height, &channels) == 0)
        return image_error(image, "is neither PNG nor JPEG", "one of the two");
    // Check the size before decoding, so that a few bytes cannot allocate all memory.
    if (width < 1 || height < 1 || width > side_limit || height > side_limit ||
        std::int64_t{width} * height > pixel_limit)
        return image_error(
            image, fmt::format("has {} × {} pixels", width, height),
            fmt::format("at most {} pixels a side and {} pixels in total", side_limit, pixel_limit));
    const std::unique_ptr<stbi_uc, FreePixels> pixels(
        stbi_load_from_memory(bytes, size, &width, &height, &channels, 0));
    if (!pixels) return image_error(image, "cannot be decoded", "an undamaged image");
    image.width = width;
    image.height = height;
    image.channels = channels;
    const auto count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                       static_cast<std::size_t>(channels);
    image.pixels.assign(pixels.get(), pixels.get() + count);
    return {};
}

Result<std::string> encode_png(int width, int height, int channels, std::span<const std::uint8_t> pixels) {
    const bool valid = width > 0 && height > 0 && width <= side_limit && height <= side_limit &&
                       channels >= 1 && channels <= 4 &&
                       pixels.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                                            static_cast<std::size_t>(channels);
    if (!valid)
        return fail(ErrorCode::failed, "the number of pixel bytes does not match the image size",
                    "width × height × channels bytes");
    std::string bytes;
    if (stbi_write_png_to_func(append, &bytes, width, height, channels, pixels.data(), width * channels) == 0)
        return fail(ErrorCode::failed, "the PNG cannot be encoded", "enough memory for the picture");
    return bytes;
}

namespace {

tl::unexpected<Error> hdr_error(const std::filesystem::path& path, const char* what, const char* expected) {
    Error error;
    error.code = ErrorCode::bad_content;
    error.file = path.string();
    error.what = what;
    error.expected = expected;
    return fail(std::move(error));
}

// Encodes a pixel with a shared exponent.
std::array<std::uint8_t, 4> rgbe(const glm::vec3& radiance) {
    const float largest = std::max({radiance.x, radiance.y, radiance.z});
    if (!(largest > 1e-32F)) return {};
    int exponent = 0;
    (void)std::frexp(largest, &exponent);
    std::array<std::uint8_t, 4> out{};
    for (int i = 0; i < 3; ++i) {
        const float scaled = std::ldexp(std::max(radiance[i], 0.0F), 8 - exponent);
        out[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(std::min(scaled, 255.0F));
    }
    out[3] = static_cast<std::uint8_t>(exponent + 128);
    return out;
}

// Appends a row of one channel with run-length encoding: runs of four or more equal bytes are stored as count
// and value, other bytes are copied.
void append_runs(const std::vector<std::uint8_t>& row, std::string& out) {
    std::size_t i = 0;
    while (i < row.size()) {
        std::size_t start = i;  // of the next run
        std::size_t run = 0;
        while (start < row.size()) {
            run = 1;
            while (start + run < row.size() && run < 127 && row[start + run] == row[start]) ++run;
            if (run >= 4) break;
            start += run;
        }
        while (i < start) {
            const std::size_t count = std::min<std::size_t>(128, start - i);
            out.push_back(static_cast<char>(count));
            out.append(reinterpret_cast<const char*>(&row[i]), count);
            i += count;
        }
        if (i < row.size()) {
            out.push_back(static_cast<char>(128 + run));
            out.push_back(static_cast<char>(row[i]));
            i += run;
        }
    }
}

}  // namespace

std::string encode_hdr(const RadianceImage& image) {
    std::string out =
        fmt::format("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", image.height, image.width);
    const auto width = static_cast<std::size_t>(image.width);
    std::vector<std::uint8_t> plane(width);
    for (std::size_t row = 0; row < static_cast<std::size_t>(image.height); ++row) {
        out.push_back(2);
        out.push_back(2);
        out.push_back(static_cast<char>(width >> 8U));
        out.push_back(static_cast<char>(width & 0xFFU));
        for (std::size_t channel = 0; channel < 4; ++channel) {
            for (std::size_t x = 0; x < width; ++x) plane[x] = rgbe(image.pixels[row * width + x])[channel];
            append_runs(plane, out);
        }
    }
    return out;
}

Result<RadianceImage> decode_hdr(std::string_view file, const std::filesystem::path& path) {
    const auto* bytes = reinterpret_cast<const stbi_uc*>(file.data());
    const int size = static_cast<int>(file.size());
    RadianceImage image;
    int channels = 0;
    if (stbi_is_hdr_from_memory(bytes, size) == 0)
        return hdr_error(path, "is not a Radiance .hdr file", "a picture in that format");
    const std::unique_ptr<float, FreePixels> pixels(
        stbi_loadf_from_memory(bytes, size, &image.width, &image.height, &channels, 3));
    if (!pixels) return hdr_error(path, "cannot be decoded", "an undamaged picture");
    const std::size_t count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    for (std::size_t i = 0; i < count; ++i) {
        const float* p = pixels.get() + 3 * i;
        if (!std::isfinite(p[0] + p[1] + p[2]))
            return hdr_error(path, "has a pixel that is not finite", "finite values");
        image.pixels.emplace_back(p[0], p[1], p[2]);
    }
    return image;
}

Result<RadianceImage> read_hdr(const std::filesystem::path& path) {
    BOLT_TRY_ASSIGN(const auto bytes, read_file(path, std::size_t{1} << 28U, ErrorCode::bad_content));
    return decode_hdr(bytes, path);
}

Status write_hdr(const std::filesystem::path& path, const RadianceImage& image) {
    return write_file(path, encode_hdr(image));
}

}  // namespace bolt::assets
