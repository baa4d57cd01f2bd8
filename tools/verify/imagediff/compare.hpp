// Compares two pictures.
#pragma once

#include <filesystem>

#include "engine/base/result.hpp"
#include "tools/verify/imagediff/flip.hpp"

namespace bolt::imagediff {

struct Difference {
    int largest = 0;       // of any channel, of 255
    double changed = 0.0;  // share of pixels with any difference
    double mean_flip = 0.0;
    std::vector<float> flips;  // a pixel
};

Result<Picture> read_png(const std::filesystem::path& path);

// An error if the sizes differ.
Result<Difference> compare(const Picture& reference, const Picture& test);

// The flips as grey levels.
Status write_flips(const std::filesystem::path& path, const Picture& size, const std::vector<float>& flips);

}  // namespace bolt::imagediff
