// The SPIR-V of the shaders in tests/gpu/shaders, by file name.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

std::span<const std::uint32_t> test_shaders(std::string_view name);
