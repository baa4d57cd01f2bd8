#include "game/analysis/csv_line.hpp"

namespace bolt::analysis {

namespace {

bool blank(char c) { return c == ' ' || c == '\t'; }

tl::unexpected<Error> error_at(std::size_t position, std::string what, std::string expected) {
    Error error;
    error.code = ErrorCode::bad_content;
    error.column = static_cast<int>(position) + 1;
    error.what = std::move(what);
    error.expected = std::move(expected);
    return fail(std::move(error));
}

// Reads the quoted text that begins at `at` and leaves `at` behind its closing quote.
Result<std::string> quoted(std::string_view line, std::size_t& at) {
    const std::size_t open = at++;
    std::string text;
    for (; at < line.size(); ++at) {
        if (line[at] != '"') {
            text += line[at];
        } else if (at + 1 < line.size() && line[at + 1] == '"') {
            text += '"';
            ++at;
        } else {
            ++at;
            return text;
        }
    }
    return error_at(open, "this quote is not closed on its line", "a closing '\"'");
}

}  // namespace

Result<std::vector<Field>> split_line(std::string_view line) {
    std::vector<Field> fields;
    std::size_t at = 0;
    while (true) {
        while (at < line.size() && blank(line[at])) ++at;
        Field field;
        field.column = static_cast<int>(at) + 1;
        if (at < line.size() && line[at] == '"') {
            BOLT_TRY_ASSIGN(auto text, quoted(line, at));
            field.text = std::move(text);
            while (at < line.size() && blank(line[at])) ++at;
            if (at < line.size() && line[at] != ',')
                return error_at(at, "there is text behind a quoted field", "a comma or the end of the line");
        } else {
            const std::size_t end = std::min(line.find(',', at), line.size());
            field.text = line.substr(at, end - at);
            while (!field.text.empty() && blank(field.text.back())) field.text.pop_back();
            at = end;
        }
        fields.push_back(std::move(field));
        if (at >= line.size()) return fields;
        ++at;  // the comma
    }
}

}  // namespace bolt::analysis
