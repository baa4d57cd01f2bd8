// Messages about a .pvx file, with line and column.
#pragma once

#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::content {

inline constexpr std::size_t max_pvx_messages = 200;  // errors, and as many warnings

// `text` and `file` must outlive it. Nodes are those of the document that was parsed from `text`.
class PvxMessages {
  public:
    PvxMessages(std::string_view text, const std::string& file) : text_(text), file_(file) {}

    // Adds an error or a warning at an attribute of the node; `attribute` null: at the node itself.
    void fail_at(pugi::xml_node node, const char* attribute, std::string what, std::string expected) {
        add(errors_, node, attribute, std::move(what), std::move(expected));
    }
    void warn_at(pugi::xml_node node, const char* attribute, std::string what) {
        add(warnings_, node, attribute, std::move(what), {});
    }
    // Adds an error at a byte of the text.
    void fail_at(std::size_t offset, std::string what, std::string expected) {
        errors_.push_back(error_at(offset, std::move(what), std::move(expected)));
    }

    [[nodiscard]] bool has_errors() const { return !errors_.empty(); }
    // Each returns its messages, sorted by position, and clears them.
    std::vector<Error> take_errors();
    std::vector<Error> take_warnings();

  private:
    [[nodiscard]] Error error_at(std::size_t offset, std::string what, std::string expected) const;
    [[nodiscard]] std::size_t offset_of(pugi::xml_node node, const char* attribute) const;
    void add(std::vector<Error>& list, pugi::xml_node node, const char* attribute, std::string what,
             std::string expected);

    std::string_view text_;
    const std::string& file_;
    std::vector<Error> errors_, warnings_;
};

}  // namespace bolt::content
