// One line of a CSV file, taken apart with the column of every field.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::analysis {

struct Field {
    std::string text;  // unquoted, without surrounding blanks
    int column = 1;    // 1-based, where the text begins
};

// RFC 4180 within a line. Errors have the column, not the file and line.
Result<std::vector<Field>> split_line(std::string_view line);

}  // namespace bolt::analysis
