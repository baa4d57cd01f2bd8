// Radiance .hdr files: pictures of light.
#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::assets {

struct HdrImage {
    int width = 0, height = 0;
    std::vector<glm::vec3> pixels;  // radiance, rows from the top
};

// Refuses what is no such file, or has values that are not finite.
Result<HdrImage> read_hdr(const std::filesystem::path& path);
Status write_hdr(const std::filesystem::path& path, const HdrImage& image);

}  // namespace bolt::assets
