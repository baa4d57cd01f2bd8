// Light from all around, as an equirectangular image of radiance (the middle column is −Z, the right half +X,
// the top row +Y), and the Radiance .hdr files that hold such images.
#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::assets {

struct RadianceImage {
    int width = 0, height = 0;
    std::vector<glm::vec3> pixels;  // rows from the top
};

// Refuses what is no such file, or has values that are not finite.
Result<RadianceImage> read_hdr(const std::filesystem::path& path);
Status write_hdr(const std::filesystem::path& path, const RadianceImage& image);

}  // namespace bolt::assets
