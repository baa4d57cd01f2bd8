// Compares two images of one size, by channel and by FLIP. FLIP is, for each pixel, the difference that a
// viewer sees when the two images alternate, from 0 (none) to 1 (the greatest).
//   P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström, M. D. Fairchild, FLIP: A Difference
//   Evaluator for Alternating Images, Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020. The
//   low-dynamic-range measure, section 4.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::imagediff {

// 8-bit sRGB, three channels, rows from the top.
struct RgbImage {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
};

// For a viewer 0.7 m from a display that is 0.7 m wide and has 3840 pixels.
inline constexpr float default_pixels_per_degree = 67.02F;

// Returns one value per pixel. The images must have the same size.
std::vector<float> flip(const RgbImage& reference, const RgbImage& test,
                        float pixels_per_degree = default_pixels_per_degree);

double mean(std::span<const float> values);

struct Difference {
    int largest = 0;       // largest difference of any channel, 0 to 255
    double changed = 0.0;  // fraction of the pixels that differ in any channel
    double mean_flip = 0.0;
    std::vector<float> flips;  // one per pixel
};

Result<RgbImage> read_png(const std::filesystem::path& path);

// Fails if the sizes differ.
Result<Difference> compare(const RgbImage& reference, const RgbImage& test);

// Writes the FLIP values as grey levels. Only the size of the image `size` is used.
Status write_flips(const std::filesystem::path& path, const RgbImage& size, const std::vector<float>& flips);

}  // namespace bolt::imagediff
