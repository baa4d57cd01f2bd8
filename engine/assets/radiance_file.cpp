#include "engine/assets/radiance_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>

#include "engine/assets/stb.hpp"
#include "engine/base/file.hpp"

namespace bolt::assets {

namespace {

struct Free {
    void operator()(float* pixels) const { stbi_image_free(pixels); }
};

tl::unexpected<Error> hdr_error(const std::filesystem::path& path, const char* what) {
    Error error;
    error.code = ErrorCode::bad_content;
    error.file = path.string();
    error.what = what;
    return fail(std::move(error));
}

// The shared-exponent encoding of a pixel.
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

// Appends a row of one channel with run-length encoding: runs of four and more are counted, other bytes are
// copied.
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
    if (stbi_is_hdr_from_memory(bytes, size) == 0) return hdr_error(path, "is no Radiance .hdr file");
    const std::unique_ptr<float, Free> pixels(
        stbi_loadf_from_memory(bytes, size, &image.width, &image.height, &channels, 3));
    if (!pixels) return hdr_error(path, "cannot be decoded");
    const std::size_t count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    for (std::size_t i = 0; i < count; ++i) {
        const float* p = pixels.get() + 3 * i;
        if (!std::isfinite(p[0] + p[1] + p[2])) return hdr_error(path, "has a pixel that is not finite");
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
