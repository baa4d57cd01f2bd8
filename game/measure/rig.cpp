#include "game/measure/rig.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "content/format/embedded.hpp"
#include "content/format/reader.hpp"
#include "engine/base/file.hpp"
#include "engine/base/math.hpp"
#include "haptics/joint/fastener.hpp"

namespace bolt::measure {

namespace {

using content::JsonNode;
using content::JsonPart;
using content::JsonReader;

constexpr std::size_t max_rig_size = 1U << 20U;  // bytes
constexpr double coverage = 2.0;                 // k of expanded uncertainties

enum class UnitKind { torque, force, angle, time };

struct Unit {
    std::string_view name;
    UnitKind kind;
    double factor;                              // to SI
    std::array<std::string_view, 4> spellings;  // others, in lower case
};

constexpr double pound_force = 4.4482216152605, kilogram_force = 9.80665;  // N, exact

constexpr Unit units[] = {
    {"N.m", UnitKind::torque, 1.0, {"nm", "n m", "n·m", "newton metres"}},
    {"N.mm", UnitKind::torque, 1e-3, {"nmm", "n mm", "n·mm", ""}},
    {"kgf.m", UnitKind::torque, kilogram_force, {"kgfm", "kgf m", "kgf·m", ""}},
    {"lbf.ft", UnitKind::torque, pound_force * 0.3048, {"lbfft", "ft-lb", "ft.lb", "lbf ft"}},
    {"lbf.in", UnitKind::torque, pound_force * 0.0254, {"lbfin", "in-lb", "in.lb", "lbf in"}},
    {"N", UnitKind::force, 1.0, {"newton", "", "", ""}},
    {"kN", UnitKind::force, 1e3, {"", "", "", ""}},
    {"kgf", UnitKind::force, kilogram_force, {"", "", "", ""}},
    {"lbf", UnitKind::force, pound_force, {"", "", "", ""}},
    {"deg", UnitKind::angle, pi / 180.0, {"°", "degree", "degrees", ""}},
    {"rad", UnitKind::angle, 1.0, {"radian", "radians", "", ""}},
    {"turn", UnitKind::angle, 2.0 * pi, {"turns", "rev", "revs", ""}},
    {"s", UnitKind::time, 1.0, {"sec", "seconds", "", ""}},
    {"ms", UnitKind::time, 1e-3, {"", "", "", ""}},
    {"us", UnitKind::time, 1e-6, {"µs", "", "", ""}},
    {"min", UnitKind::time, 60.0, {"", "", "", ""}},
};

const Unit* find_unit(std::string_view name) {
    for (const Unit& unit : units)
        if (unit.name == name) return &unit;
    return nullptr;
}

std::string lower(std::string_view text) {
    std::string out(text);
    for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return out;
}

const Unit* find_spelling(std::string_view text) {
    const std::string name = lower(text);
    for (const Unit& unit : units) {
        if (lower(unit.name) == name) return &unit;
        for (const std::string_view spelling : unit.spellings)
            if (!spelling.empty() && spelling == name) return &unit;
    }
    return nullptr;
}

// Reads the parts of a description. Reports what the schema cannot express.
class RigReader {
  public:
    RigReader(const content::JsonDocument& document, JsonReader& reader)
        : document_(document), reader_(reader) {}

    [[nodiscard]] RigPosition position(const JsonNode& node) const {
        if (!node) return {};
        const Error at = document_.error(node.pointer, JsonPart::value, "", "");
        return {at.line, at.column};
    }

    bool has(const JsonNode& object, const char* key) {
        const JsonNode member = reader_.member(object, key);
        return member || !reader_.is_valid(member.pointer);
    }

    std::string text(const JsonNode& object, const char* key) {
        return reader_.text(reader_.member(object, key)).value_or("");
    }

    double number(const JsonNode& object, const char* key, double fallback = 0.0) {
        return reader_.number(reader_.member(object, key)).value_or(fallback);
    }

    Channel channel(const JsonNode& object) {
        Channel channel;
        channel.position = position(object);
        channel.column = text(object, "column");
        const JsonNode unit = reader_.member(object, "unit");
        channel.unit_name = reader_.text(unit).value_or("");
        channel.unit_position = position(unit);
        if (const Unit* known = find_unit(channel.unit_name)) channel.unit = known->factor;
        channel.gain = number(object, "gain", 1.0);
        channel.offset = number(object, "offset");
        const JsonNode reversed = reader_.member(object, "reversed");
        channel.reversed = reader_.boolean(reversed).value_or(false);
        channel.reversed_position = reversed ? position(reversed) : channel.position;
        channel.low_pass = number(object, "low_pass_Hz");
        channel.resolution = number(object, "resolution") * channel.unit;
        channel.uncertainty = number(object, "uncertainty") * channel.unit / coverage;
        return channel;
    }

    TimeSource time(const JsonNode& object) {
        TimeSource time;
        time.column = text(object, "column");
        time.rate = number(object, "rate_Hz");
        time.longest_gap = number(object, "longest_gap_s");
        if (const Unit* unit = find_unit(text(object, "unit"))) time.unit = unit->factor;
        const bool column = has(object, "column"), rate = has(object, "rate_Hz");
        if (object && column == rate)
            reader_.report(
                object.pointer,
                column ? "the time has both a column and a rate" : "the time has neither a column nor a rate",
                "\"column\" or \"rate_Hz\"");
        if (object && rate && !column && has(object, "unit"))
            reader_.report(object.pointer + "/unit", "a unit has no meaning without a column",
                           "\"column\", or no unit", JsonPart::key);
        return time;
    }

    TorqueChannel torque(const JsonNode& object) {
        TorqueChannel torque;
        torque.channel = channel(object);
        torque.channel.relative_uncertainty = number(object, "uncertainty_percent") / 100.0 / coverage;
        torque.lever = number(object, "lever_mm") * 1e-3;
        torque.lever_uncertainty = number(object, "lever_uncertainty_mm") * 1e-3 / coverage;
        torque.tare = number(object, "tare_s");
        const Unit* unit = find_unit(torque.channel.unit_name);
        const bool lever = has(object, "lever_mm");
        if (unit != nullptr && unit->kind == UnitKind::force && !lever)
            reader_.report(
                object.pointer + "/unit", fmt::format("{} is a force", unit->name),
                "\"lever_mm\", the distance from the bolt's axis to the force, or a unit of torque");
        if (unit != nullptr && unit->kind == UnitKind::torque)
            for (const char* key : {"lever_mm", "lever_uncertainty_mm"})
                if (has(object, key))
                    reader_.report(object.pointer + "/" + key,
                                   fmt::format("{} is a torque, which needs no lever", unit->name),
                                   "a unit of force, such as N, or no lever", JsonPart::key);
        return torque;
    }

    AngleSource angle(const JsonNode& object) {
        AngleSource angle;
        angle.position = position(object);
        const JsonNode second = reader_.member(object, "second_file"),
                       points = reader_.member(object, "points_s_deg");
        const bool column = has(object, "column"), speed = has(object, "speed_deg_s"),
                   list = points || !reader_.is_valid(points.pointer);
        const int ways = (column ? 1 : 0) + (speed ? 1 : 0) + (list ? 1 : 0);
        if (object && ways != 1)
            reader_.report(object.pointer, ways == 0 ? "there is no angle" : "there is more than one angle",
                           "one of \"column\", \"speed_deg_s\" and \"points_s_deg\"");
        if (object && column && !has(object, "unit"))
            reader_.report(object.pointer, "the column of the angle has no unit",
                           "\"unit\": \"deg\", \"rad\" or \"turn\"");
        if (object && !column)
            for (const char* key : {"unit", "gain", "offset", "reversed", "low_pass_Hz", "resolution",
                                    "largest_step_deg", "second_file"})
                if (has(object, key))
                    reader_.report(object.pointer + "/" + key,
                                   fmt::format("\"{}\" has no meaning without a column", key),
                                   "\"column\", or no such member", JsonPart::key);
        angle.channel = channel(object);
        angle.largest_step = to_radians(number(object, "largest_step_deg"));
        if (!column) angle.channel.uncertainty = number(object, "uncertainty") * to_radians(0.5);
        angle.kind = speed    ? AngleKind::speed
                     : list   ? AngleKind::points
                     : second ? AngleKind::second_file
                              : AngleKind::column;
        angle.speed = to_radians(number(object, "speed_deg_s"));
        read_second(second, angle);
        read_points(points, angle);
        return angle;
    }

  private:
    void read_second(const JsonNode& second, AngleSource& angle) {
        if (!second) return;
        angle.ending = text(second, "ending");
        angle.delay = number(second, "delay_s");
        angle.second_time = time(reader_.member(second, "time"));
        if (angle.ending.find('/') != std::string::npos)
            reader_.report(second.pointer + "/ending", "the ending has a slash",
                           "a second file in the folder of the run");
    }

    void read_points(const JsonNode& points, AngleSource& angle) {
        for (const JsonNode& node : reader_.items(points)) {
            const std::vector<JsonNode> pair = reader_.items(node);
            if (pair.size() != 2) continue;
            const AnglePoint point{reader_.number(pair[0]).value_or(nan),
                                   to_radians(reader_.number(pair[1]).value_or(nan))};
            if (!angle.points.empty() && point.time <= angle.points.back().time)
                reader_.report(
                    pair[0].pointer,
                    fmt::format("the time {:g} s is not after {:g} s", point.time, angle.points.back().time),
                    "ascending times");
            angle.points.push_back(point);
        }
    }

    const content::JsonDocument& document_;
    JsonReader& reader_;
};

const content::JsonSchema& rig_schema() {
    static const content::JsonSchema schema(content::rig_schema_text());
    return schema;
}

void read_table(RigReader& from, const JsonNode& node, TableFormat& table, JsonReader& reader) {
    const std::string separator = from.text(node, "separator");
    table.separator = separator == "semicolon" ? ';' : separator == "tab" ? '\t' : ',';
    table.decimal_comma = from.text(node, "decimal") == "comma";
    table.lines_before_header = static_cast<int>(from.number(node, "lines_before_header"));
    table.lines_after_header = static_cast<int>(from.number(node, "lines_after_header"));
    if (table.decimal_comma && table.separator == ',')
        reader.report(node.pointer + "/decimal", "the comma separates columns and decimals",
                      "\"separator\": \"semicolon\" or \"tab\"");
}

}  // namespace

Error Rig::error(RigPosition position, std::string what, std::string expected) const {
    Error e;
    e.code = ErrorCode::bad_content;
    e.file = file;
    e.line = position.line;
    e.column = position.column;
    e.what = std::move(what);
    e.expected = std::move(expected);
    return e;
}

std::string unit_in_name(std::string_view column) {
    while (!column.empty() && column.back() == ' ') column.remove_suffix(1);
    if (column.empty()) return {};
    std::size_t open = std::string_view::npos;
    if (column.back() == ']') open = column.rfind('[');
    if (column.back() == ')') open = column.rfind('(');
    if (open != std::string_view::npos) {
        const Unit* unit = find_spelling(column.substr(open + 1, column.size() - open - 2));
        return unit != nullptr ? std::string(unit->name) : std::string();
    }
    open = column.rfind('_');
    if (open == std::string_view::npos) return {};
    const Unit* unit = find_spelling(column.substr(open + 1));
    return unit != nullptr ? std::string(unit->name) : std::string();
}

LoadedRig parse_rig(std::string_view text, const std::string& file) {
    LoadedRig loaded;
    const auto document = content::JsonDocument::parse(text, file, loaded.errors);
    if (!document) return loaded;
    JsonReader reader(*document, rig_schema());
    RigReader from(*document, reader);
    const JsonNode root = reader.root();
    Rig& rig = loaded.rig;
    rig.file = file;
    rig.title = from.text(root, "title");
    rig.source = from.text(root, "source");
    for (const char* key : {"title", "source"})
        if (from.text(root, key).find_first_of("\r\n") != std::string::npos)
            reader.report(root.pointer + "/" + key, "the text has a line break", "one line");
    rig.direction =
        from.text(root, "direction") == "loosen" ? joint::Direction::loosen : joint::Direction::tighten;
    const JsonNode thread = reader.member(root, "thread");
    rig.thread = reader.text(thread).value_or("");
    if (!rig.thread.empty())
        if (const auto known = joint::parse_thread(rig.thread); !known)
            reader.report(thread.pointer, known.error().what, known.error().expected);
    const JsonNode grade = reader.member(root, "property_class");
    rig.property_class = reader.text(grade).value_or("");
    if (!rig.property_class.empty())
        if (const auto known = joint::property_class(rig.property_class, 0.01); !known)
            reader.report(grade.pointer, known.error().what, known.error().expected);
    rig.bolt_length = 1e-3 * from.number(root, "bolt_length_mm");
    read_table(from, reader.member(root, "table"), rig.table, reader);
    rig.time = from.time(reader.member(root, "time"));
    rig.torque = from.torque(reader.member(root, "torque"));
    rig.angle = from.angle(reader.member(root, "angle"));
    const JsonNode cycle = reader.member(root, "cycle");
    rig.cycle_column = from.text(cycle, "column");
    if (cycle && rig.angle.kind == AngleKind::second_file)
        reader.report(cycle.pointer, "several runs in one file cannot be joined with a second file",
                      "one file for each run", JsonPart::key);
    for (Error& error : reader.take_errors()) loaded.errors.push_back(std::move(error));
    content::sort_by_position(loaded.errors);
    return loaded;
}

LoadedRig load_rig(const std::filesystem::path& path) {
    const Result<std::string> text = read_file(path, max_rig_size, ErrorCode::bad_content);
    if (text) return parse_rig(*text, path.string());
    LoadedRig loaded;
    loaded.errors.push_back(text.error());
    return loaded;
}

}  // namespace bolt::measure
