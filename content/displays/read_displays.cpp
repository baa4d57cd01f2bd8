#include "content/displays/display_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "content/format/embedded.hpp"
#include "content/format/reader.hpp"

namespace bolt::content {

namespace {

constexpr std::array<std::string_view, 4> stereo_names{"mono", "side_by_side", "top_bottom", "two_outputs"};
constexpr std::array<std::string_view, 4> tracker_names{"fixed", "dtrack", "openxr", "file"};
constexpr std::array<std::string_view, 3> pose_names{"headset", "left_hand", "right_hand"};
constexpr double length_tolerance = 1e-3;  // of a quaternion's length in the file

template <class Enumeration, std::size_t count>
Enumeration read_name(const JsonReader& reader, const JsonNode& node,
                      const std::array<std::string_view, count>& names, Enumeration fallback) {
    const auto text = reader.text(node);
    const auto it = text ? std::find(names.begin(), names.end(), *text) : names.end();
    return it == names.end() ? fallback : static_cast<Enumeration>(it - names.begin());
}

std::optional<int> read_integer(const JsonReader& reader, const JsonNode& node) {
    const auto number = reader.number(node);
    return number ? std::optional(static_cast<int>(*number)) : std::nullopt;
}

// Two integers.
std::optional<std::array<int, 2>> read_pair(const JsonReader& reader, const JsonNode& node) {
    const std::vector<JsonNode> parts = reader.items(node);
    if (parts.size() != 2) return std::nullopt;
    const auto first = read_integer(reader, parts[0]), second = read_integer(reader, parts[1]);
    if (!first || !second) return std::nullopt;
    return std::array{*first, *second};
}

// Changes the value only if the member is given and valid.
void read_number(JsonReader& reader, const JsonNode& object, const char* key, double& to) {
    to = reader.number(reader.member(object, key)).value_or(to);
}

Quat read_orientation(JsonReader& reader, const JsonNode& node, const Quat& fallback) {
    const std::vector<JsonNode> parts = reader.items(node);
    if (parts.size() != 4) return fallback;
    std::array<double, 4> q{};
    for (std::size_t i = 0; i < 4; ++i) {
        const auto part = reader.number(parts[i]);
        if (!part) return fallback;
        q[i] = *part;
    }
    const Quat read(q[0], q[1], q[2], q[3]);
    const double length = glm::length(read);
    if (std::abs(length - 1.0) > length_tolerance) {
        reader.report(node.pointer, fmt::format("the quaternion has the length {:g}", length),
                      "a unit quaternion [w, x, y, z]");
        return fallback;
    }
    // A quaternion that this program wrote is not renormalised, so that it keeps its bits.
    return std::abs(length - 1.0) < 1e-12 ? read : glm::normalize(read);
}

void read_pose(JsonReader& reader, const JsonNode& object, const char* key, Pose& to) {
    const JsonNode node = reader.member(object, key);
    to.position = reader.vector(reader.member(node, "position_m")).value_or(to.position);
    to.orientation = read_orientation(reader, reader.member(node, "orientation_wxyz"), to.orientation);
}

void read_axes(JsonReader& reader, const JsonNode& node, std::array<TrackerAxis, 3>& to) {
    const std::vector<JsonNode> items = reader.items(node);
    if (items.size() != 3 || !reader.is_valid(node.pointer)) return;
    std::array<TrackerAxis, 3> axes;
    glm::dmat3 rows(0.0);
    for (std::size_t i = 0; i < 3; ++i) {
        const std::string text = reader.text(items[i]).value_or("+x");
        axes[i] = {text[1] - 'x', text[0] == '-'};
        rows[axes[i].axis][static_cast<int>(i)] = axes[i].negative ? -1.0 : 1.0;
    }
    const double determinant = glm::determinant(rows);
    if (determinant > 0.5)
        to = axes;
    else
        reader.report(node.pointer,
                      determinant < -0.5 ? "these axes mirror the room" : "an axis is named twice",
                      "three different axes that make a right-handed frame, such as +x, +z, -y");
}

std::optional<Flystick> read_flystick(JsonReader& reader, const JsonNode& node) {
    if (!node) return std::nullopt;
    Flystick flystick;
    flystick.id = read_integer(reader, reader.member(node, "id")).value_or(flystick.id);
    read_pose(reader, node, "aim_in_body", flystick.aim_in_body);
    flystick.select = read_integer(reader, reader.member(node, "select")).value_or(flystick.select);
    flystick.menu = read_integer(reader, reader.member(node, "menu")).value_or(flystick.menu);
    flystick.tool = read_integer(reader, reader.member(node, "tool")).value_or(flystick.tool);
    const auto twice = [](int a, int b) { return a != 0 && a == b; };
    if (twice(flystick.select, flystick.menu) || twice(flystick.select, flystick.tool) ||
        twice(flystick.menu, flystick.tool))
        reader.report(node.pointer, "a button has two functions", "a button for each function, or 0");
    return flystick;
}

HeadTracking read_head(JsonReader& reader, const JsonNode& node) {
    HeadTracking head;
    const JsonNode tracker = reader.member(node, "tracker");
    head.tracker = read_name(reader, tracker, tracker_names, head.tracker);
    read_pose(reader, node, "fixed", head.fixed_head);
    head.port = read_integer(reader, reader.member(node, "port")).value_or(head.port);
    head.body = read_integer(reader, reader.member(node, "body")).value_or(head.body);
    head.flystick = read_flystick(reader, reader.member(node, "flystick"));
    if (head.flystick && head.tracker != HeadTracker::dtrack && reader.is_valid(tracker.pointer))
        reader.report(reader.member(node, "flystick").pointer,
                      fmt::format("the tracker \"{}\" has no flystick", name(head.tracker)),
                      "the tracker \"dtrack\"", JsonPart::key);
    head.pose = read_name(reader, reader.member(node, "pose"), pose_names, head.pose);
    const JsonNode recording = reader.member(node, "recording");
    head.recording = reader.text(recording).value_or("");
    if (head.tracker == HeadTracker::file && !recording && reader.is_valid(recording.pointer))
        reader.report(node.pointer, "the tracker \"file\" has no \"recording\"",
                      "the path of a file with recorded poses");
    read_axes(reader, reader.member(node, "axes"), head.axes);
    read_number(reader, node, "scale", head.scale);
    read_pose(reader, node, "tracker_in_room", head.tracker_in_room);
    read_pose(reader, node, "head_in_body", head.head_in_body);
    read_number(reader, node, "hold_s", head.hold);
    read_number(reader, node, "fade_s", head.fade);
    read_number(reader, node, "max_speed_m_per_s", head.max_speed);
    read_number(reader, node, "jump_s", head.jump_time);
    return head;
}

DisplayOutput read_output(JsonReader& reader, const JsonNode& node) {
    DisplayOutput output;
    const JsonNode monitor = reader.member(node, "monitor"), index = reader.member(node, "monitor_index"),
                   position = reader.member(node, "position_px"),
                   resolution = reader.member(node, "resolution_px");
    output.monitor = reader.text(monitor).value_or("");
    output.monitor_index = read_integer(reader, index);
    if (const auto pair = read_pair(reader, position)) output.position = {(*pair)[0], (*pair)[1]};
    if (const auto pair = read_pair(reader, resolution)) output.resolution = {(*pair)[0], (*pair)[1]};
    output.display = reader.text(reader.member(node, "display")).value_or("");
    output.process = read_integer(reader, reader.member(node, "rank")).value_or(0);
    if (!node) return output;
    // A member whose value is wrong counts as given: its mistake is reported already.
    const auto given = [&](const JsonNode& member) { return member || !reader.is_valid(member.pointer); };
    const int places = int{given(monitor)} + int{given(index)} + int{given(position)};
    if (places != 1 && reader.is_valid(node.pointer))
        reader.report(node.pointer,
                      places == 0 ? "the output has no place" : "the output has more than one place",
                      "one of \"monitor\", \"monitor_index\" and \"position_px\"");
    if (position && !given(resolution))
        reader.report(node.pointer, "a window has no size", "\"resolution_px\": [width, height]");
    return output;
}

// Reads an output that must be given if `wanted`, and must not be given otherwise.
JsonNode read_place(JsonReader& reader, const JsonNode& wall, const char* key, bool wanted, StereoMode mode) {
    JsonNode node = reader.member(wall, key);
    const bool given = node || !reader.is_valid(node.pointer);
    if (wanted && !given)
        reader.report(wall.pointer, fmt::format("\"{}\" is missing", key),
                      fmt::format("where \"{}\" shows its picture", name(mode)));
    else if (!wanted && given)
        reader.report(node.pointer,
                      fmt::format("\"{}\" has no meaning with the stereo mode \"{}\"", key, name(mode)),
                      mode == StereoMode::two_outputs ? "\"left_output\" and \"right_output\""
                                                      : "\"output\", or the stereo mode \"two_outputs\"",
                      JsonPart::key);
    return node;
}

Wall read_wall(JsonReader& reader, const JsonNode& node) {
    Wall wall;
    wall.name = reader.text(reader.member(node, "name")).value_or("");
    wall.lower_left = reader.vector(reader.member(node, "lower_left_m")).value_or(Vec3(0.0));
    wall.lower_right = reader.vector(reader.member(node, "lower_right_m")).value_or(Vec3(0.0));
    wall.upper_right = reader.vector(reader.member(node, "upper_right_m")).value_or(Vec3(0.0));
    const JsonNode stereo = reader.member(node, "stereo");
    wall.stereo = read_name(reader, stereo, stereo_names, wall.stereo);
    wall.swap_eyes = reader.boolean(reader.member(node, "swap_eyes")).value_or(false);
    const bool two = wall.stereo == StereoMode::two_outputs;
    JsonNode output = reader.member(node, "output"), left = reader.member(node, "left_output"),
             right = reader.member(node, "right_output");
    if (node && reader.is_valid(stereo.pointer)) {  // otherwise the outputs that it needs are not known
        output = read_place(reader, node, "output", !two, wall.stereo);
        left = read_place(reader, node, "left_output", two, wall.stereo);
        right = read_place(reader, node, "right_output", two, wall.stereo);
    }
    const DisplayOutput whole = read_output(reader, output), first = read_output(reader, left),
                        second = read_output(reader, right);
    wall.output = two ? first : whole;
    if (two) wall.right_output = second;
    return wall;
}

std::vector<Wall> read_walls(JsonReader& reader, const JsonNode& list) {
    std::vector<Wall> walls;
    std::map<std::string, int> lines;  // of names
    for (const JsonNode& node : reader.items(list)) {
        Wall wall = read_wall(reader, node);
        const JsonNode name_node = reader.member(node, "name");
        if (name_node) {
            const auto [first, is_new] = lines.emplace(wall.name, reader.line(name_node.pointer));
            if (!is_new)
                reader.report(name_node.pointer,
                              fmt::format("there is another wall {}", in_quotes(wall.name)),
                              fmt::format("a name of its own; the first is in line {}", first->second));
        }
        walls.push_back(std::move(wall));
    }
    return walls;
}

const JsonSchema& displays_schema() {
    static const JsonSchema schema(displays_schema_text());
    return schema;
}

}  // namespace

std::string_view name(StereoMode mode) { return stereo_names[static_cast<std::size_t>(mode)]; }

std::string_view name(TrackedPose pose) { return pose_names[static_cast<std::size_t>(pose)]; }

std::string_view name(HeadTracker tracker) { return tracker_names[static_cast<std::size_t>(tracker)]; }

std::string axis_name(const TrackerAxis& axis) {
    return {axis.negative ? '-' : '+', static_cast<char>('x' + axis.axis)};
}

LoadedDisplays parse_displays(std::string_view text, const std::string& file) {
    LoadedDisplays loaded;
    loaded.file = file;
    const auto document = JsonDocument::parse(text, file, loaded.errors);
    if (!document) return loaded;
    JsonReader reader(*document, displays_schema());
    const JsonNode root = reader.root();
    DisplayFile& displays = loaded.displays;
    displays.schema = reader.text(reader.member(root, "$schema")).value_or("");
    reader.member(root, "format");  // the schema permits one value only
    displays.name = reader.text(reader.member(root, "name")).value_or("");
    read_number(reader, root, "eye_separation_m", displays.eye_separation);
    displays.head = read_head(reader, reader.member(root, "head"));
    const JsonNode walls = reader.member(root, "walls");
    displays.walls = read_walls(reader, walls);
    for (const JsonNode& wall : reader.items(walls)) {
        const Error place = document->error(wall.pointer, JsonPart::value, {}, {});
        loaded.wall_positions.push_back({place.line, place.column});
    }
    for (Error& error : reader.take_errors()) loaded.errors.push_back(std::move(error));
    sort_by_position(loaded.errors);
    return loaded;
}

}  // namespace bolt::content
