// A markup checker for tests: tags are closed in order, attributes are quoted, and each '&' begins an entity.
#pragma once

#include <cctype>
#include <string>
#include <string_view>
#include <vector>

namespace bolt::report {

struct MarkupChecker {
    std::string_view text;
    std::size_t at = 0;
    std::vector<std::string> open;

    [[nodiscard]] bool starts(std::string_view part) const { return text.substr(at).starts_with(part); }
    [[nodiscard]] std::string fault(const std::string& what) const {
        return what + " at byte " + std::to_string(at) + ": " + std::string(text.substr(at, 60));
    }
    bool skip_past(std::string_view part) {
        const std::size_t found = text.find(part, at);
        if (found == std::string_view::npos) return false;
        at = found + part.size();
        return true;
    }
    std::string name() {
        const std::size_t from = at;
        while (at < text.size() && (std::isalnum(static_cast<unsigned char>(text[at])) != 0 ||
                                    text[at] == '-' || text[at] == ':'))
            ++at;
        return std::string(text.substr(from, at - from));
    }
    void blanks() {
        while (at < text.size() && std::isspace(static_cast<unsigned char>(text[at])) != 0) ++at;
    }
    bool entity() {
        const std::size_t end = text.find(';', at);
        if (end == std::string_view::npos || end - at > 8) return false;
        const std::string_view body = text.substr(at + 1, end - at - 1);
        return body == "amp" || body == "lt" || body == "gt" || body == "quot" || body == "#39";
    }

    std::string attributes() {
        while (true) {
            blanks();
            if (at >= text.size() || text[at] == '>' || text[at] == '/') return {};
            if (name().empty()) return fault("no attribute name");
            if (!starts("=\"")) return fault("attribute without a quoted value");
            at += 2;
            for (; at < text.size() && text[at] != '"'; ++at) {
                if (text[at] == '<') return fault("'<' in an attribute");
                if (text[at] == '&' && !entity()) return fault("bare '&' in an attribute");
            }
            if (at >= text.size()) return fault("attribute not closed");
            ++at;
        }
    }

    std::string tag() {
        if (starts("<!DOCTYPE html>")) return skip_past(">") ? "" : fault("doctype");
        if (starts("<?xml")) return skip_past("?>") ? "" : fault("declaration");
        if (starts("<![CDATA[")) return skip_past("]]>") ? "" : fault("CDATA not closed");
        ++at;
        const bool closing = starts("/");
        if (closing) ++at;
        const std::string tag_name = name();
        if (tag_name.empty()) return fault("'<' without a tag");
        if (closing) {
            if (open.empty() || open.back() != tag_name) return fault("</" + tag_name + "> closes nothing");
            open.pop_back();
            return starts(">") && ++at > 0 ? "" : fault("tag not closed");
        }
        if (std::string wrong = attributes(); !wrong.empty()) return wrong;
        if (starts("/>")) {
            at += 2;
            return {};
        }
        if (!starts(">")) return fault("tag not closed");
        ++at;
        open.push_back(tag_name);
        // A style sheet is not markup; it ends at its closing tag.
        if (tag_name == "style") {
            at = text.find("</style>", at);
            if (at == std::string_view::npos) return "style is not closed";
        }
        return {};
    }
};

// Returns the first fault and its position, or an empty string if the text is well-formed.
inline std::string markup_fault(std::string_view text) {
    MarkupChecker checker{text, 0, {}};
    while (checker.at < text.size()) {
        if (text[checker.at] == '<') {
            if (std::string wrong = checker.tag(); !wrong.empty()) return wrong;
            continue;
        }
        if (text[checker.at] == '&' && !checker.entity()) return checker.fault("bare '&'");
        if (text[checker.at] == '>') return checker.fault("bare '>'");
        ++checker.at;
    }
    return checker.open.empty() ? "" : "<" + checker.open.back() + "> is never closed";
}

// Number of occurrences of `part`.
inline std::size_t count_of(std::string_view text, std::string_view part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string_view::npos;
         at = text.find(part, at + part.size()))
        ++count;
    return count;
}

}  // namespace bolt::report
