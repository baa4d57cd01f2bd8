// FLIP: the visible difference of two pictures that are shown in turn, for each pixel; 0 equal, 1 the
// greatest.
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

// Eight bits a channel, sRGB, three channels, rows from the top.
struct Picture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
};

// 67 pixels a degree: 0.7 m from a display 0.7 m wide with 3840 pixels.
inline constexpr float usual_pixels_per_degree = 67.02F;

// A value a pixel; the pictures have the same size.
std::vector<float> flip(const Picture& reference, const Picture& test,
                        float pixels_per_degree = usual_pixels_per_degree);

double mean(std::span<const float> values);

// Compares two pictures.

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
