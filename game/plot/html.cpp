#include "game/plot/html.hpp"

#include <fmt/format.h>

#include "game/plot/style.hpp"
#include "game/plot/text.hpp"

namespace bolt::plot {

std::string page(std::string_view title, std::string_view body) {
    return fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
        "<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n<main>\n{}</main>\n</body>\n</html>\n",
        escape(title), style_sheet(), body);
}

std::string figure(std::string_view heading, std::string_view svg, std::string_view caption) {
    std::string out = "<figure>";
    if (!heading.empty()) out += fmt::format("<div class=\"fh\">{}</div>", heading);
    out += svg;
    if (!caption.empty()) out += fmt::format("<figcaption>{}</figcaption>", caption);
    return out + "</figure>\n";
}

std::string fact(std::string_view name, std::string_view value) {
    return value.empty() ? std::string()
                         : fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", name, escape(value));
}

std::string path_fact(std::string_view name, std::string_view path) {
    if (path.empty()) return {};
    std::string words;
    for (std::size_t from = 0; from < path.size();) {
        const std::size_t slash = path.find('/', from);
        const std::size_t end = slash == std::string_view::npos ? path.size() : slash + 1;
        if (from > 0) words += "<wbr/>";
        words += escape(path.substr(from, end - from));
        from = end;
    }
    return fmt::format("<div class=\"path\"><dt>{}</dt><dd>{}</dd></div>\n", name, words);
}

}  // namespace bolt::plot
