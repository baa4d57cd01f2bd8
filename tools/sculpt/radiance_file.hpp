// Radiance pictures (.hdr): shared-exponent RGBE with run lengths, as G. Ward describes them in Graphics Gems
// II (1991), "Real pixels".
#pragma once

#include <string>

#include "engine/base/result.hpp"
#include "tools/sculpt/environment.hpp"

namespace bolt::sculpt {

// The bytes of the file. Widths from 8 to 32767.
std::string encode_radiance(const Panorama& picture);

Result<Panorama> decode_radiance(const std::string& bytes);

}  // namespace bolt::sculpt
