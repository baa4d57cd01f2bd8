#include "content/displays/pvx_messages.hpp"

#include <algorithm>
#include <utility>

#include "content/displays/pvx_values.hpp"
#include "content/format/json_document.hpp"

namespace bolt::content {

Error PvxMessages::error_at(std::size_t offset, std::string what, std::string expected) const {
    const std::string_view before = text_.substr(0, offset);
    const std::size_t line_start = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
    const auto is_character = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; };
    Error error;
    error.code = ErrorCode::bad_content;
    error.what = std::move(what);
    error.expected = std::move(expected);
    error.file = file_;
    error.line = static_cast<int>(std::count(before.begin(), before.end(), '\n')) + 1;
    error.column = static_cast<int>(std::count_if(before.begin() + static_cast<std::ptrdiff_t>(line_start),
                                                  before.end(), is_character)) +
                   1;
    return error;
}

std::size_t PvxMessages::offset_of(pugi::xml_node node, const char* attribute) const {
    const std::ptrdiff_t at = node.offset_debug();
    const std::size_t start = at < 0 ? 0 : static_cast<std::size_t>(at);
    if (attribute == nullptr) return start;
    // The parser keeps no positions of attributes: find the name before the end of the tag.
    const std::string name(attribute);
    const std::size_t end = std::min(text_.find('>', start), text_.size());
    for (std::size_t i = text_.find(name, start); i < end; i = text_.find(name, i + 1)) {
        const std::size_t after = i + name.size();
        const bool ends = after < text_.size() && (text_[after] == '=' || is_blank(text_[after]));
        if (i > 0 && is_blank(text_[i - 1]) && ends) return i;
    }
    return start;
}

// Bounded, because each message costs a search through the file.
void PvxMessages::add(std::vector<Error>& list, pugi::xml_node node, const char* attribute, std::string what,
                      std::string expected) {
    if (list.size() > max_pvx_messages) return;
    if (list.size() == max_pvx_messages) {
        what = "further messages are not shown: this is probably no file of ParaView";
        expected.clear();
    }
    list.push_back(error_at(offset_of(node, attribute), std::move(what), std::move(expected)));
}

std::vector<Error> PvxMessages::take_errors() {
    sort_by_position(errors_);
    return std::move(errors_);
}

std::vector<Error> PvxMessages::take_warnings() {
    sort_by_position(warnings_);
    return std::move(warnings_);
}

}  // namespace bolt::content
