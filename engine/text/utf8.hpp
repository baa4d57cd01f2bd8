// UTF-8 to code points and back.
#pragma once

#include <string>
#include <string_view>

namespace bolt::text {

// What is no UTF-8 becomes U+FFFD, one for each byte that starts nothing.
std::u32string decode(std::string_view utf8);
std::string encode(std::u32string_view points);

}  // namespace bolt::text
