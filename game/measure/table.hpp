// Reads columns of numbers from the text file of a data logger.
//
// A row is a line. Fields are separated by commas, semicolons or tabs and may be in double quotes. One line
// names the columns. Blank lines and lines that begin with # are skipped. Every number that is read must be
// finite; a message names file, line and column of one that is not.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"
#include "game/measure/rig.hpp"

namespace bolt::measure {

struct Table {
    std::string file;
    std::vector<std::vector<double>> columns;  // those requested, in their order
    std::vector<std::string> labels;           // of the text column, one for each row; empty without one
    std::vector<int> lines;                    // line of each row in the file, from 1
    std::vector<std::vector<int>> places;      // position in its line of each number in `columns`

    [[nodiscard]] std::size_t rows() const { return lines.size(); }
    // An error in a row, or at a number.
    [[nodiscard]] Error error(std::size_t row, std::string what, std::string expected) const;
    [[nodiscard]] Error error(std::size_t row, std::size_t column, std::string what,
                              std::string expected) const;
};

inline constexpr std::size_t max_table_bytes = std::size_t{512} << 20U;
inline constexpr double largest_number = 1e12;  // magnitude of a number in a table

// `wanted`: names of the columns of numbers; `label`: name of a column that is read as text; may be empty.
// `file` is used in messages.
Result<Table> parse_table(std::string_view text, const std::string& file, const TableFormat& format,
                          std::span<const std::string> wanted, const std::string& label = {});

}  // namespace bolt::measure
