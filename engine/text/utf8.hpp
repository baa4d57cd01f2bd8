// Conversion between UTF-8 and code points.
#pragma once

#include <string>
#include <string_view>

namespace bolt::text {

// Invalid UTF-8 becomes U+FFFD, one per byte that starts no character.
std::u32string decode(std::string_view utf8);
std::string encode(std::u32string_view points);

}  // namespace bolt::text
