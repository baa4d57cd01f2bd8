// Image files: decodes PNG and JPEG, encodes PNG (eight bits per channel), reads and writes Radiance .hdr.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/assets/model.hpp"
#include "engine/base/result.hpp"

namespace bolt::assets {

// Fills `pixels`, `width`, `height` and `channels` from `encoded`, which is kept. Does nothing if the image
// is already decoded. Fails above 16384 pixels per side or 64 Mi pixels in total.
Status decode(Bitmap& image);

// Returns the bytes of a PNG file, the same for the same pixels. `pixels`: rows from the top, 1 to 4
// channels.
Result<std::string> encode_png(int width, int height, int channels, std::span<const std::uint8_t> pixels);

// Environment light as an equirectangular image of radiance by direction: -Z is in the middle, +X in the
// middle of the right half, +Y in the top row.
struct RadianceImage {
    int width = 0, height = 0;
    std::vector<glm::vec3> pixels;  // rows from the top
};

// Radiance .hdr files: shared-exponent RGBE with run-length encoding (G. Ward, Real pixels, Graphics Gems II,
// 1991). decode_hdr fails if the bytes are not such a file or contain values that are not finite; `path` is
// named in errors.
Result<RadianceImage> decode_hdr(std::string_view bytes, const std::filesystem::path& path);
Result<RadianceImage> read_hdr(const std::filesystem::path& path);

// The same image always gives the same bytes. The width must be in [8, 32767].
std::string encode_hdr(const RadianceImage& image);
Status write_hdr(const std::filesystem::path& path, const RadianceImage& image);

}  // namespace bolt::assets
