#include "game/view/size.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace bolt::view {

Result<VkExtent2D> parse_size(const std::string& text) {
    unsigned width = 0, height = 0;
    char rest = 0;
    const bool read = std::sscanf(text.c_str(), "%ux%u%c", &width, &height, &rest) == 2;
    if (!read || width < 1 || height < 1 || width > 8192 || height > 8192)
        return fail(ErrorCode::usage, fmt::format("--size \"{}\" is no size", text),
                    "WIDTHxHEIGHT, up to 8192x8192");
    return VkExtent2D{width, height};
}

}  // namespace bolt::view
