// Access to files in tests/oracles and tests/data.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace bolt::test {

using Row = std::map<std::string, std::string>;  // by column name

std::string test_file(const std::string& path_in_tests);  // returns its path

// Reads a table; lines that begin with # are comments. Throws if the file is missing, which fails the test.
std::vector<Row> read_table(const std::string& path_in_tests);

inline double number(const Row& row, const std::string& column) { return std::stod(row.at(column)); }

}  // namespace bolt::test
