// Environment light as an equirectangular image of radiance (the middle column is -Z, the right half +X, the
// top row +Y), and its files: Radiance .hdr, shared-exponent RGBE with run-length encoding (G. Ward, Real
// pixels, Graphics Gems II, 1991).
#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::assets {

struct RadianceImage {
    int width = 0, height = 0;
    std::vector<glm::vec3> pixels;  // rows from the top
};

// Fails if the bytes are no such file or have values that are not finite. `path` is named in errors.
Result<RadianceImage> decode_hdr(std::string_view bytes, const std::filesystem::path& path);
Result<RadianceImage> read_hdr(const std::filesystem::path& path);

// The same image always gives the same bytes. The width must be in [8, 32767].
std::string encode_hdr(const RadianceImage& image);
Status write_hdr(const std::filesystem::path& path, const RadianceImage& image);

}  // namespace bolt::assets
