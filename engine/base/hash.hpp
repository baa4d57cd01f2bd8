// The 64-bit FNV-1a hash (Fowler, Noll, Vo). Every step can be inverted, so a single changed byte always
// changes the hash. It is not a cryptographic hash.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace bolt {

class Fnv1a {
  public:
    void add(std::uint8_t byte) { value_ = (value_ ^ byte) * 0x100000001B3ULL; }
    void add(std::span<const std::byte> bytes) {
        for (const std::byte byte : bytes) add(static_cast<std::uint8_t>(byte));
    }
    void add(std::string_view text) {
        for (const char c : text) add(static_cast<std::uint8_t>(c));
    }
    [[nodiscard]] std::uint64_t value() const { return value_; }

  private:
    std::uint64_t value_ = 0xCBF29CE484222325ULL;
};

}  // namespace bolt
