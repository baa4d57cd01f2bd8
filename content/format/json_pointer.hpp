// JSON pointers (RFC 6901): "/joints/3/id".
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace bolt::content {

// One reference token, escaped: "a/b" becomes "a~1b".
std::string pointer_token(std::string_view key);

// All reference tokens, unescaped.
std::vector<std::string> pointer_tokens(std::string_view pointer);

// The last reference token, unescaped; empty for the whole document.
std::string last_token(std::string_view pointer);

}  // namespace bolt::content
