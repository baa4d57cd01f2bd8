// Names a text that the program says to people. Code that names one that is not in the table does not
// compile.
#pragma once

#include <cstddef>
#include <cstdint>

#include "content/words/key_rows.hpp"

namespace bolt::words {

class Key {
  public:
    // Implicit: a key is written as its name.
    consteval Key(const char* name) : index_(find(name)) {}  // NOLINT(google-explicit-constructor)
    static constexpr Key at(std::size_t index) { return Key(static_cast<std::uint16_t>(index)); }

    [[nodiscard]] constexpr std::size_t index() const { return index_; }
    [[nodiscard]] constexpr const KeyRow& row() const { return key_rows[index_]; }
    friend constexpr bool operator==(const Key&, const Key&) = default;

  private:
    constexpr explicit Key(std::uint16_t index) : index_(index) {}
    static consteval std::uint16_t find(std::string_view name) {
        for (std::size_t i = 0; i < key_count; ++i)
            if (key_rows[i].name == name) return static_cast<std::uint16_t>(i);
        throw "there is no such key in content/words/key_rows.hpp";
    }
    std::uint16_t index_ = 0;
};

}  // namespace bolt::words
