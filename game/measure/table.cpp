#include "game/measure/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "engine/base/csv.hpp"
#include "engine/base/nearest.hpp"

namespace bolt::measure {

namespace {

class TableParser {
  public:
    TableParser(const std::string& file, const TableFormat& format, std::span<const std::string> wanted,
                const std::string& label)
        : format_(format), wanted_(wanted), label_(label) {
        table_.file = file;
        table_.columns.resize(wanted.size());
        table_.places.resize(wanted.size());
    }

    Status line(std::string_view text) {
        ++line_;
        if (text.ends_with('\r')) text.remove_suffix(1);
        if (line_ <= format_.lines_before_header) return {};
        if (after_header_ > 0) {
            --after_header_;
            return {};
        }
        const std::size_t first = text.find_first_not_of(" \t");
        if (first == std::string_view::npos || text[first] == '#') return {};
        BOLT_TRY(split(text));
        return has_header_ ? row(text) : header(text);
    }

    Result<Table> finish() {
        line_ = std::max(line_, 1);
        if (!has_header_)
            return error(1, "there is no line that names the columns",
                         fmt::format("a line with '{}'", wanted_.empty() ? label_ : wanted_[0]));
        if (table_.rows() == 0) return error(1, "there are no rows after the header", "measured values");
        return std::move(table_);
    }

  private:
    [[nodiscard]] tl::unexpected<Error> error(int column, std::string what, std::string expected) const {
        return FileLine{table_.file, line_}.error(column, std::move(what), std::move(expected));
    }

    Status split(std::string_view line) {
        auto fields = split_csv_line(line, format_.separator);
        if (!fields) return error(fields.error().column, fields.error().what, fields.error().expected);
        fields_ = std::move(*fields);
        return {};
    }

    Status find_column(const std::string& name, std::size_t& index) const {
        std::vector<std::string> names;
        std::size_t count = 0;
        for (std::size_t i = 0; i < fields_.size(); ++i) {
            names.emplace_back(fields_[i].text);
            if (fields_[i].text != name) continue;
            if (count++ > 0)
                return error(fields_[i].column, fmt::format("column '{}' appears twice", name),
                             "each column once");
            index = i;
        }
        if (count > 0) return {};
        const std::string near = nearest(name, names);
        if (!near.empty())
            return error(1, fmt::format("there is no column '{}'", name),
                         fmt::format("did you mean '{}'?", near));
        if (names.size() == 1)
            return error(1, fmt::format("there is no column '{}', and this line has only one column", name),
                         "\"separator\" and \"lines_before_header\" of the rig as in this file");
        return error(
            1, fmt::format("there is no column '{}'", name),
            fmt::format("one of the columns {}",
                        fmt::join(names.begin(),
                                  names.begin() + std::min<std::ptrdiff_t>(std::ssize(names), 12), ", ")));
    }

    Status header(std::string_view text) {
        if (text.find('\0') != std::string_view::npos)
            return error(1, "the file is not plain text in UTF-8",
                         "UTF-8; iconv -f UTF-16 -t UTF-8 converts a file of 16-bit characters");
        field_count_ = fields_.size();
        for (const std::string& name : wanted_) {
            std::size_t index = 0;
            BOLT_TRY(find_column(name, index));
            indices_.push_back(index);
        }
        if (!label_.empty()) BOLT_TRY(find_column(label_, label_index_));
        has_header_ = true;
        after_header_ = format_.lines_after_header;
        return {};
    }

    Result<double> number(const CsvField& field, const std::string& name) const {
        const auto wrong = [&](std::string what) {
            return error(
                field.column, std::move(what),
                fmt::format("a number such as {}; remove the row, or repair the channel and measure again",
                            format_.decimal_comma ? "-12,5" : "-12.5"));
        };
        if (field.text.empty()) return wrong(fmt::format("'{}' has no value in this row", name));
        std::string text(field.text.substr(0, 64));
        if (format_.decimal_comma) std::replace(text.begin(), text.end(), ',', '.');
        const std::size_t begin = text.starts_with('+') ? 1 : 0;
        double value = 0.0;
        const auto [end, problem] = std::from_chars(text.data() + begin, text.data() + text.size(), value);
        if (problem != std::errc() || end != text.data() + text.size() || text.starts_with("+-")) {
            const bool comma = !format_.decimal_comma && field.text.find(',') != std::string::npos;
            if (comma)
                return error(field.column, fmt::format("'{}' has a decimal comma", text),
                             "\"decimal\": \"comma\" in the rig's \"table\"");
            return wrong(fmt::format("'{}' is not a number for '{}'", text, name));
        }
        if (!std::isfinite(value)) return wrong(fmt::format("'{}' is {}", name, text));
        if (std::abs(value) > largest_number)
            return wrong(fmt::format("{} is out of range for '{}'", text, name));
        return value;
    }

    // A row may be longer than the header, because loggers write comments there. It may be shorter if it has
    // all requested columns.
    Status row(std::string_view text) {
        if (fields_.size() < field_count_ && fields_.size() <= last_needed())
            return error(column_at(text, text.size()), fmt::format("this row has {} fields", fields_.size()),
                         fmt::format("{}, as in the header; the file may have been cut off", field_count_));
        for (std::size_t i = 0; i < wanted_.size(); ++i) {
            BOLT_TRY_ASSIGN(const auto value, number(fields_[indices_[i]], wanted_[i]));
            table_.columns[i].push_back(value);
            table_.places[i].push_back(fields_[indices_[i]].column);
        }
        if (!label_.empty()) table_.labels.emplace_back(fields_[label_index_].text);
        table_.lines.push_back(line_);
        return {};
    }

    [[nodiscard]] std::size_t last_needed() const {
        std::size_t last = label_.empty() ? 0 : label_index_;
        for (const std::size_t index : indices_) last = std::max(last, index);
        return last;
    }

    TableFormat format_;
    std::span<const std::string> wanted_;
    std::string label_;
    Table table_;
    std::vector<CsvField> fields_;
    std::vector<std::size_t> indices_;
    std::size_t label_index_ = 0, field_count_ = 0;
    int line_ = 0, after_header_ = 0;
    bool has_header_ = false;
};

}  // namespace

Error Table::error(std::size_t row, std::string what, std::string expected) const {
    Error e;
    e.code = ErrorCode::bad_content;
    e.file = file;
    e.line = row < lines.size() ? lines[row] : 0;
    e.what = std::move(what);
    e.expected = std::move(expected);
    return e;
}

Error Table::error(std::size_t row, std::size_t column, std::string what, std::string expected) const {
    Error e = error(row, std::move(what), std::move(expected));
    if (column < places.size() && row < places[column].size()) e.column = places[column][row];
    return e;
}

Result<Table> parse_table(std::string_view text, const std::string& file, const TableFormat& format,
                          std::span<const std::string> wanted, const std::string& label) {
    if (text.starts_with("TDSm")) {
        Error e;
        e.code = ErrorCode::bad_content;
        e.file = file;
        e.what = "is a TDMS file";
        e.expected =
            "a CSV file; in LabVIEW or DIAdem export it as CSV, because Debian has no library for TDMS";
        return fail(std::move(e));
    }
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    TableParser parser(file, format, wanted, label);
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        BOLT_TRY(parser.line(text.substr(0, end)));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return parser.finish();
}

}  // namespace bolt::measure
