#include "content/station/point_table.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <utility>

#include "content/format/json_document.hpp"
#include "engine/base/csv.hpp"
#include "engine/base/file.hpp"

namespace bolt::content {
namespace {

constexpr std::size_t max_table_size = 1U << 20U;  // bytes

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

// Calls visit(field, offset in the line) for each field; returns the number of fields.
template <class Visit>
Result<std::size_t> each_field(std::string_view line, const Visit& visit) {
    std::size_t at = 0, count = 0;
    while (true) {
        const std::size_t end = std::min(line.find(',', at), line.size());
        const std::string_view field = trimmed(line.substr(at, end - at));
        const auto offset = field.empty() ? at : static_cast<std::size_t>(field.data() - line.data());
        BOLT_TRY(visit(count++, field, offset));
        if (end == line.size()) return count;
        at = end + 1;
    }
}

// The title without blanks.
std::string compact(std::string_view line) {
    std::string text;
    for (const char c : line)
        if (c != ' ' && c != '\t' && c != '\r') text += c;
    return text;
}

template <std::size_t N>
Result<std::array<double, N>> parse_row(std::string_view line, const FileLine& position) {
    std::array<double, N> row{};
    const auto read = [&](std::size_t index, std::string_view field, std::size_t offset) -> Status {
        if (index >= N)
            return position.error(column_at(line, offset), fmt::format("the row has more than {} numbers", N),
                                  "a number for each column");
        double value = 0.0;
        const auto [end, problem] = std::from_chars(field.data(), field.data() + field.size(), value);
        if (problem != std::errc() || end != field.data() + field.size() ||
            !(std::abs(value) <= max_coordinate))
            return position.error(column_at(line, offset),
                                  fmt::format("{} is not a coordinate", in_quotes(field)),
                                  "a number of metres");
        row[index] = value;
        return {};
    };
    BOLT_TRY_ASSIGN(const std::size_t count, each_field(line, read));
    if (count < N)
        return position.error(column_at(line, line.size()),
                              fmt::format("the row has {} of {} numbers", count, N),
                              "a number for each column");
    return row;
}

template <std::size_t N>
Result<std::vector<std::array<double, N>>> parse_table(std::string_view text, const std::string& file,
                                                       std::string_view title) {
    std::vector<std::array<double, N>> rows;
    FileLine position{file};
    bool titled = false;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        ++position.line;
        if (trimmed(line).empty() || trimmed(line).front() == '#') continue;
        if (!titled) {
            titled = compact(line) == title;
            if (!titled)
                return position.error(1, fmt::format("{} is not the title of the columns", in_quotes(line)),
                                      fmt::format("\"{}\"", title));
            continue;
        }
        if (rows.size() == max_table_points)
            return position.error(1, "the table is too long",
                                  fmt::format("at most {} points", max_table_points));
        BOLT_TRY_ASSIGN(const auto row, parse_row<N>(line, position));
        rows.push_back(row);
    }
    position.line = std::max(position.line, 1);
    if (!titled) return position.error(1, "the table is empty", fmt::format("the title \"{}\"", title));
    return rows;
}

}  // namespace

Result<std::vector<PointPair>> parse_point_pairs(std::string_view text, const std::string& file) {
    BOLT_TRY_ASSIGN(const auto rows, parse_table<6>(text, file, "ax,ay,az,bx,by,bz"));
    std::vector<PointPair> pairs;
    for (const auto& [ax, ay, az, bx, by, bz] : rows) pairs.push_back({{ax, ay, az}, {bx, by, bz}});
    return pairs;
}

Result<std::vector<PointPair>> load_point_pairs(const std::filesystem::path& path) {
    BOLT_TRY_ASSIGN(const auto text, read_file(path, max_table_size, ErrorCode::bad_content));
    return parse_point_pairs(text, path.string());
}

Result<std::vector<Vec3>> parse_points(std::string_view text, const std::string& file) {
    BOLT_TRY_ASSIGN(const auto rows, parse_table<3>(text, file, "x,y,z"));
    std::vector<Vec3> points;
    for (const auto& [x, y, z] : rows) points.emplace_back(x, y, z);
    return points;
}

Result<std::vector<Vec3>> load_points(const std::filesystem::path& path) {
    BOLT_TRY_ASSIGN(const auto text, read_file(path, max_table_size, ErrorCode::bad_content));
    return parse_points(text, path.string());
}

}  // namespace bolt::content
