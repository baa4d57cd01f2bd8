// Pictures held against references that are kept in tests/golden/pictures: bit for bit on the driver that
// made them, within a tolerance on any other. A missing reference fails. References are made anew by
// tests/golden/update.sh, and by nothing else.
#pragma once

#include <filesystem>
#include <string>

#include "engine/gpu/device.hpp"
#include "engine/render/picture.hpp"

namespace bolt::test {

// Elsewhere: other drivers place their samples on the same points, but round corners, filter and divide in
// their own way, so that a pixel at an edge may change sides.
struct Tolerance {
    double mean_flip = 0.03;
    int channel = 24;      // of 255: what lies beyond is counted as off
    double share = 0.015;  // of the pixels that may be off
};

struct Gallery {
    std::filesystem::path references, failures;
    std::string driver;         // that draws now
    std::string pinned_driver;  // that drew the references
    bool update = false;        // write what should be compared
};

// The one of this project, for pictures of this device.
Gallery gallery(const gpu::Device& device);

std::string driver_of(const gpu::Device& device);

struct Verdict {
    bool passes = false;
    std::string why;  // numbers, and where the pictures are
};

// On failure NAME.actual.png and NAME.difference.png (channel by channel, stretched to the full range) are
// written.
Verdict hold(const Gallery& gallery, const std::string& name, const render::Picture& picture,
             const Tolerance& tolerance = {});

// The pictures side by side.
render::Picture joined(const std::vector<render::Picture>& pictures);

}  // namespace bolt::test
