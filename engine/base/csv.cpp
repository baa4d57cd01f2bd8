#include "engine/base/csv.hpp"

#include <algorithm>

namespace bolt {

namespace {

tl::unexpected<Error> error_at(int column, std::string what, std::string expected) {
    return FileLine{}.error(column, std::move(what), std::move(expected));
}

int characters_in(std::string_view utf8) {
    const auto begins_character = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; };
    return static_cast<int>(std::count_if(utf8.begin(), utf8.end(), begins_character));
}

// Reads the quoted text that begins at `at` and sets `at` after its closing quote.
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
    return error_at(column_at(line, open), "this quote is not closed on its line", "a closing '\"'");
}

}  // namespace

tl::unexpected<Error> FileLine::error(int column, std::string what, std::string expected) const {
    Error error;
    error.code = ErrorCode::bad_content;
    error.file = file;
    error.line = line;
    error.column = column;
    error.what = std::move(what);
    error.expected = std::move(expected);
    return fail(std::move(error));
}

int column_at(std::string_view line, std::size_t offset) { return 1 + characters_in(line.substr(0, offset)); }

Result<std::vector<CsvField>> split_csv_line(std::string_view line, char separator) {
    const auto blank = [&](char c) { return (c == ' ' || c == '\t') && c != separator; };
    std::vector<CsvField> fields;
    std::size_t at = 0, counted = 0;
    int column = 1;  // of the byte at `counted`
    while (true) {
        while (at < line.size() && blank(line[at])) ++at;
        CsvField field;
        column += characters_in(line.substr(counted, at - counted));
        counted = at;
        field.column = column;
        if (at < line.size() && line[at] == '"') {
            BOLT_TRY_ASSIGN(auto text, quoted(line, at));
            field.text = std::move(text);
            while (at < line.size() && blank(line[at])) ++at;
            if (at < line.size() && line[at] != separator)
                return error_at(column_at(line, at), "there is text after a quoted field",
                                separator == ',' ? "a comma or the end of the line"
                                                 : "the separator or the end of the line");
        } else {
            const std::size_t end = std::min(line.find(separator, at), line.size());
            field.text = line.substr(at, end - at);
            while (!field.text.empty() && blank(field.text.back())) field.text.pop_back();
            at = end;
        }
        fields.push_back(std::move(field));
        if (at >= line.size()) return fields;
        ++at;  // the separator
    }
}

std::string csv_field(std::string_view text) {
    const bool blanks = !text.empty() && (text.front() == ' ' || text.back() == ' ');
    if (!blanks && text.find_first_of(",;\"#\t\r\n") == std::string_view::npos) return std::string(text);
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + "\"";
}

}  // namespace bolt
