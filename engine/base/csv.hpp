// Lines of comma-separated values (RFC 4180), also with other separators. A line is a record: a quoted field
// with a line break is not supported.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt {

// A line of a text file, for the errors in it.
struct FileLine {
    std::string_view file;
    int line = 0;  // from 1

    // Returns an error with the code bad_content. `column`: from 1, in characters; 0: unknown.
    [[nodiscard]] tl::unexpected<Error> error(int column, std::string what, std::string expected) const;
};

struct CsvField {
    std::string text;  // unquoted, without surrounding blanks
    int column = 1;    // column of its first character: from 1, in characters
};

// Returns the column of the byte at `offset` in a line of UTF-8 text: from 1, in characters.
int column_at(std::string_view line, std::size_t offset);

// Splits one line without its line end. Fails for a quote that is not closed, and for text after a closing
// quote; the error has the column, but not the file and the line.
Result<std::vector<CsvField>> split_csv_line(std::string_view line, char separator = ',');

// The text as a field: in quotes if it needs them. Text that would be read as a comment ('#') or that has
// blanks around it is quoted too.
std::string csv_field(std::string_view text);

}  // namespace bolt
