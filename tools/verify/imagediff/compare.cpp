#include "tools/verify/imagediff/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "engine/assets/image.hpp"
#include "engine/base/file.hpp"

namespace bolt::imagediff {

Result<Picture> read_png(const std::filesystem::path& path) {
    BOLT_TRY_ASSIGN(const auto bytes, read_file(path, std::size_t{1} << 28U, ErrorCode::failed));
    assets::Image image;
    image.name = path.string();
    image.encoded.assign(bytes.begin(), bytes.end());
    if (Status decoded = assets::decode(image); !decoded) {
        Error error = decoded.error();
        error.file = path.string();
        return fail(std::move(error));
    }
    Picture picture{image.width, image.height, {}};
    const auto channels = static_cast<std::size_t>(image.channels);
    for (std::size_t i = 0; i < image.pixels.size(); i += channels)
        for (std::size_t c = 0; c < 3; ++c) picture.rgb.push_back(image.pixels[i + (channels >= 3 ? c : 0)]);
    return picture;
}

Result<Difference> compare(const Picture& reference, const Picture& test) {
    if (reference.width != test.width || reference.height != test.height)
        return fail(ErrorCode::failed,
                    fmt::format("the pictures have different sizes: {}x{} and {}x{}", reference.width,
                                reference.height, test.width, test.height));
    Difference difference;
    std::size_t changed = 0;
    for (std::size_t i = 0; i < reference.rgb.size(); i += 3) {
        int largest = 0;
        for (std::size_t c = i; c < i + 3; ++c)
            largest = std::max(largest, std::abs(int{reference.rgb[c]} - int{test.rgb[c]}));
        changed += largest > 0 ? 1U : 0U;
        difference.largest = std::max(difference.largest, largest);
    }
    difference.changed = static_cast<double>(changed) /
                         static_cast<double>(std::max<std::size_t>(reference.rgb.size() / 3, 1));
    difference.flips = flip(reference, test);
    difference.mean_flip = mean(difference.flips);
    return difference;
}

Status write_flips(const std::filesystem::path& path, const Picture& size, const std::vector<float>& flips) {
    std::vector<std::uint8_t> grey;
    grey.reserve(flips.size());
    for (const float value : flips)
        grey.push_back(static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(value, 0.0F, 1.0F))));
    BOLT_TRY_ASSIGN(const auto png, assets::encode_png(size.width, size.height, 1, grey));
    return write_file(path, png);
}

}  // namespace bolt::imagediff
