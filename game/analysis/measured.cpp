#include "game/analysis/measured.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/csv.hpp"
#include "engine/base/file.hpp"
#include "engine/base/math.hpp"
#include "engine/base/nearest.hpp"
#include "engine/base/result.hpp"

namespace bolt::analysis {

namespace {

constexpr std::size_t largest_file = std::size_t{64} << 20U;
constexpr double largest_angle = 1e7, largest_torque = 1e6;  // degrees, N·m; more is not a measurement
constexpr int absent = -1;

// Source of the published data sets, whose files have no source line.
constexpr std::string_view unfastening_source =
    "Al Assadi et al., J. Manuf. Syst. 65 (2022) 19–32, dataset_unfastening, CC BY 4.0";

struct Columns {
    int angle = absent, torque = absent, cycle = absent;
    std::size_t count = 0;
    std::vector<std::string> names;
};

bool is_blank(std::string_view line) { return line.find_first_not_of(" \t\r") == std::string_view::npos; }

// The text after "# <key>:"; empty for other comments.
std::string comment_value(std::string_view comment, std::string_view key) {
    comment.remove_prefix(std::min(comment.find_first_not_of("# \t"), comment.size()));
    if (!comment.starts_with(key) || !comment.substr(key.size()).starts_with(':')) return {};
    comment.remove_prefix(key.size() + 1);
    const std::size_t first = comment.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    const std::size_t last = comment.find_last_not_of(" \t\r");
    return std::string(comment.substr(first, last - first + 1));
}

Result<Columns> read_header(const std::vector<CsvField>& fields, const FileLine& position) {
    Columns columns;
    columns.count = fields.size();
    for (const CsvField& field : fields) columns.names.push_back(field.text);
    const std::pair<std::string, int*> expected[] = {
        {"angle_deg", &columns.angle}, {"torque_Nm", &columns.torque}, {"cycle", &columns.cycle}};
    for (const auto& [name, index] : expected) {
        for (std::size_t i = 0; i < fields.size(); ++i) {
            if (fields[i].text != name) continue;
            if (*index != absent)
                return position.error(fields[i].column, fmt::format("column '{}' appears twice", name),
                                      "each column once");
            *index = static_cast<int>(i);
        }
        if (*index != absent || name == "cycle") continue;
        const std::string near = nearest(name, columns.names);
        const auto at =
            std::find_if(fields.begin(), fields.end(), [&](const CsvField& f) { return f.text == near; });
        if (!near.empty())
            return position.error(at->column, fmt::format("there is no column '{}'", name),
                                  fmt::format("'{}' instead of '{}'", name, near));
        const bool semicolons = fields.size() == 1 && fields[0].text.find(';') != std::string::npos;
        return position.error(1, fmt::format("there is no column '{}'", name),
                              semicolons ? "columns separated by commas, with a decimal point"
                                         : "a first line that names the columns 'angle_deg' and 'torque_Nm'");
    }
    return columns;
}

Result<double> read_number(const CsvField& field, std::string_view name, double limit,
                           const FileLine& position) {
    std::string_view text = field.text;
    if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
    double value = 0.0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool valid = problem == std::errc() && end == text.data() + text.size() && std::isfinite(value);
    if (!valid)
        return position.error(field.column,
                              fmt::format("'{}' is not a number for '{}'", field.text.substr(0, 40), name),
                              "a decimal number such as -12.5");
    if (std::abs(value) > limit)
        return position.error(field.column, fmt::format("{} is out of range for '{}'", field.text, name),
                              fmt::format("a value between -{0:.0f} and {0:.0f}", limit));
    return value;
}

struct CsvParser {
    MeasuredRecord measured;
    FileLine position;
    Columns columns;
    bool has_header = false;
    std::map<std::string, std::size_t, std::less<>> by_name;

    Cycle& cycle(const std::string& name) {
        const auto [entry, fresh] = by_name.try_emplace(name, measured.cycles.size());
        if (fresh) measured.cycles.push_back({name, position.line, {}, {}});
        return measured.cycles[entry->second];
    }

    // `end_column`: column of the end of the line.
    Status row(const std::vector<CsvField>& fields, int end_column) {
        if (fields.size() != columns.count)
            return position.error(fields.size() < columns.count ? end_column : fields[columns.count].column,
                                  fmt::format("this row has {} fields", fields.size()),
                                  fmt::format("{}, as in the header", columns.count));
        const auto field = [&](int column) -> const CsvField& {
            return fields[static_cast<std::size_t>(column)];
        };
        BOLT_TRY_ASSIGN(const auto angle,
                        read_number(field(columns.angle), "angle_deg", largest_angle, position));
        BOLT_TRY_ASSIGN(const auto torque,
                        read_number(field(columns.torque), "torque_Nm", largest_torque, position));
        Cycle& current = cycle(columns.cycle == absent ? std::string() : field(columns.cycle).text);
        current.angle.push_back(to_radians(angle));
        current.torque.push_back(torque);
        return {};
    }

    Status line(std::string_view text) {
        if (is_blank(text)) return {};
        if (text[text.find_first_not_of(" \t")] == '#') {
            if (measured.source.empty()) measured.source = comment_value(text, "source");
            for (const auto& [key, value] :
                 {std::pair("thread", &measured.thread), std::pair("bolt_length_mm", &measured.bolt_length),
                  std::pair("property_class", &measured.property_class)})
                if (value->empty()) *value = comment_value(text, key);
            return {};
        }
        if (text.ends_with('\r')) text.remove_suffix(1);
        Result<std::vector<CsvField>> fields = split_csv_line(text);
        if (!fields)
            return position.error(fields.error().column, fields.error().what, fields.error().expected);
        if (has_header) return row(*fields, column_at(text, text.size()));
        BOLT_TRY_ASSIGN(auto header, read_header(*fields, position));
        columns = std::move(header);
        has_header = true;
        return {};
    }
};

double extreme_of(const Cycle& cycle) {
    return *std::max_element(cycle.torque.begin(), cycle.torque.end(),
                             [](double a, double b) { return std::abs(a) < std::abs(b); });
}

Status check_cycles(CsvParser& parser) {
    double extreme = 0.0;
    for (const Cycle& cycle : parser.measured.cycles) {
        parser.position.line = cycle.line;
        const std::string which = cycle.name.empty() ? "this file" : fmt::format("cycle '{}'", cycle.name);
        if (cycle.angle.size() < min_samples)
            return parser.position.error(1, fmt::format("{} has only {} samples", which, cycle.angle.size()),
                                         fmt::format("at least {}", min_samples));
        const double peak = extreme_of(cycle);
        if (peak == 0.0)
            return parser.position.error(1, which + " has only zero torques", "a run with a load");
        if (extreme * peak < 0.0)
            return parser.position.error(
                1, fmt::format("{} turns in the other direction than the cycles before", which),
                "all cycles of a file tightening (torque positive) or all loosening (negative)");
        extreme = peak;
    }
    parser.measured.direction = extreme < 0.0 ? joint::Direction::loosen : joint::Direction::tighten;
    return {};
}

}  // namespace

std::size_t MeasuredRecord::samples() const {
    std::size_t count = 0;
    for (const Cycle& cycle : cycles) count += cycle.angle.size();
    return count;
}

Result<MeasuredRecord> parse_measured(std::string_view text, std::string_view file) {
    CsvParser parser;
    parser.measured.file = file;
    parser.position.file = file;
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    while (!text.empty()) {
        ++parser.position.line;
        const std::size_t end = std::min(text.find('\n'), text.size());
        BOLT_TRY(parser.line(text.substr(0, end)));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    parser.position.line = std::max(1, parser.position.line);
    if (!parser.has_header)
        return parser.position.error(1, "there is no header line", "columns 'angle_deg' and 'torque_Nm'");
    if (parser.measured.cycles.empty())
        return parser.position.error(1, "there are no samples", fmt::format("at least {} rows", min_samples));
    BOLT_TRY(check_cycles(parser));
    const std::string name = std::filesystem::path(file).filename().string();
    const bool unfastening = name == "m6_releasable.csv" || name == "m8_releasable.csv";
    if (unfastening && parser.measured.source.empty()) parser.measured.source = unfastening_source;
    return std::move(parser.measured);
}

Result<MeasuredRecord> read_measured(const std::filesystem::path& path) {
    BOLT_TRY_ASSIGN(const auto text, read_file(path, largest_file, ErrorCode::bad_content));
    return parse_measured(text, path.string());
}

Status select_runs(MeasuredRecord& record, const std::vector<std::string>& names) {
    if (names.empty()) return {};
    std::vector<std::string> known;
    for (const Cycle& cycle : record.cycles)
        if (!cycle.name.empty()) known.push_back(cycle.name);
    for (const std::string& name : names)
        if (std::find(known.begin(), known.end(), name) == known.end()) {
            const std::string near = nearest(name, known);
            return fail(ErrorCode::usage, fmt::format("{}: there is no run \"{}\"", record.file, name),
                        known.empty()   ? "a column \"cycle\" with the names of the runs"
                        : !near.empty() ? fmt::format("did you mean \"{}\"?", near)
                                        : fmt::format("one of {}", fmt::join(known, ", ")));
        }
    std::erase_if(record.cycles, [&](const Cycle& cycle) {
        return std::find(names.begin(), names.end(), cycle.name) == names.end();
    });
    return {};
}

}  // namespace bolt::analysis
