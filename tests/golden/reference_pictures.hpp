// Compares pictures with the references in tests/golden/pictures, which has a folder for each version of a
// driver: exactly on the driver and processor that made them, within a tolerance on others. A missing
// reference fails. Only tests/golden/update.sh updates references.
#pragma once

#include <filesystem>
#include <string>

#include "engine/gpu/device.hpp"
#include "engine/render/renderer.hpp"

namespace bolt::test {

// Tolerance for other drivers: they use the same sample positions, but rounding, filtering and division
// differ, so that a pixel at an edge may change sides.
struct Tolerance {
    double mean_flip = 0.03;
    int channel = 24;      // of 255; a pixel differs if a channel differs by more
    double share = 0.015;  // fraction of the pixels that may differ
};

struct ReferencePictures {
    std::filesystem::path references, failures;
    std::string driver;         // the current driver
    std::string pinned_driver;  // the driver of the references
    bool update = false;        // write the reference instead of comparing
};

// The project's references for pictures of this device.
ReferencePictures reference_pictures(const gpu::Device& device);

// The folder in `pictures` with the references of this version of a driver: "llvmpipe Mesa 22.3.6 (LLVM
// 15.0.6)" has "llvmpipe-Mesa-22.3.6-LLVM-15.0.6". A version without a folder gets the first of the others,
// or, to `update` references, a new one.
std::filesystem::path references_for(const std::filesystem::path& pictures, const std::string& driver,
                                     bool update);

// Name, version and processor.
std::string driver_of(const gpu::Device& device);

struct PictureComparison {
    bool passes = false;
    std::string why;  // figures, and the paths of the pictures
};

// Compares a picture with its reference. A failure writes NAME.actual.png and NAME.difference.png (per
// channel, stretched to the full range).
PictureComparison compare_with_reference(const ReferencePictures& pictures, const std::string& name,
                                         const render::Picture& picture, const Tolerance& tolerance = {});

// Joins pictures of equal height side by side.
render::Picture joined(const std::vector<render::Picture>& pictures);

}  // namespace bolt::test
