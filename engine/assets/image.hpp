// Decodes the PNG and JPEG images of a model, and encodes PNG. Eight bits per channel.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "engine/assets/model.hpp"
#include "engine/base/result.hpp"

namespace bolt::assets {

// Fills `pixels`, `width`, `height` and `channels` from `encoded`, which is kept. Does nothing if the image
// is decoded already. Fails above 16384 pixels per side or 64 million pixels in total.
Status decode(Image& image);

// Returns the bytes of a PNG file, the same for the same pixels. `pixels`: rows from the top, 1 to 4
// channels.
Result<std::string> encode_png(int width, int height, int channels, std::span<const std::uint8_t> pixels);

}  // namespace bolt::assets
