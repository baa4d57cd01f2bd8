// Pixels out of the PNG and JPEG files that a model carries, and into PNG files. Eight bits a channel.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "engine/assets/model.hpp"
#include "engine/base/result.hpp"

namespace bolt::assets {

// Fills `pixels`, `width`, `height` and `channels` from `encoded`, with as many channels as the file has;
// `encoded` stays. Does nothing to an image that has pixels. Refuses more than 16384 pixels a side or 64
// million in all.
Status decode(Image& image);

// A PNG file's bytes, the same for the same pixels. `pixels`: rows from the top, 1 to 4 channels.
Result<std::string> encode_png(int width, int height, int channels, std::span<const std::uint8_t> pixels);

}  // namespace bolt::assets
