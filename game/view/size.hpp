// WIDTHxHEIGHT, as command lines have it.
#pragma once

#include <string>

#include "engine/gpu/vk.hpp"

namespace bolt::view {

Result<VkExtent2D> parse_size(const std::string& text);

}  // namespace bolt::view
