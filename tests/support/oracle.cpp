#include "tests/support/oracle.hpp"

#include <fstream>
#include <sstream>
#include <stdexcept>

namespace bolt::test {

namespace {

std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> cells;
    std::stringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    if (!line.empty() && line.back() == ',') cells.emplace_back();
    return cells;
}

}  // namespace

std::string test_file(const std::string& path_in_tests) {
    return std::string(BOLT_TESTS) + "/" + path_in_tests;
}

std::vector<Row> read_table(const std::string& path_in_tests) {
    std::ifstream file(test_file(path_in_tests));
    if (!file) throw std::runtime_error("no table " + path_in_tests);
    std::vector<std::string> names;
    std::vector<Row> rows;
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line[0] == '#') continue;
        const std::vector<std::string> cells = split(line);
        if (names.empty()) {
            names = cells;
            continue;
        }
        Row row;
        for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = cells.at(i);
        rows.push_back(std::move(row));
    }
    return rows;
}

}  // namespace bolt::test
