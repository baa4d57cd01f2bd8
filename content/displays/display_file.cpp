#include "content/displays/display_file.hpp"

#include <nlohmann/json.hpp>

#include "content/displays/display_names.hpp"
#include "engine/base/file.hpp"

namespace bolt::content {

using nlohmann::ordered_json;

namespace {

constexpr std::size_t max_display_file_size = 1U << 20U;  // bytes

// Equal numbers, so that a value is read back to itself.
bool same(const Pose& a, const Pose& b) { return a.position == b.position && a.orientation == b.orientation; }

ordered_json json_of(const Vec3& point) { return {point.x, point.y, point.z}; }

ordered_json json_of(const Pose& pose) {
    const Quat& q = pose.orientation;
    return {{"position_m", json_of(pose.position)}, {"orientation_wxyz", {q.w, q.x, q.y, q.z}}};
}

ordered_json json_of(const DisplayOutput& output) {
    ordered_json object = ordered_json::object();
    if (!output.monitor.empty()) object["monitor"] = output.monitor;
    if (output.monitor_index) object["monitor_index"] = *output.monitor_index;
    if (output.position) object["position_px"] = {output.position->x, output.position->y};
    if (output.resolution) object["resolution_px"] = {output.resolution->width, output.resolution->height};
    if (!output.display.empty()) object["display"] = output.display;
    if (output.process != 0) object["rank"] = output.process;
    return object;
}

ordered_json json_of(const Wall& wall) {
    ordered_json object;
    object["name"] = wall.name;
    object["lower_left_m"] = json_of(wall.lower_left);
    object["lower_right_m"] = json_of(wall.lower_right);
    object["upper_right_m"] = json_of(wall.upper_right);
    object["stereo"] = name(wall.stereo);
    if (wall.swap_eyes) object["swap_eyes"] = true;
    object[wall.right_output ? "left_output" : "output"] = json_of(wall.output);
    if (wall.right_output) object["right_output"] = json_of(*wall.right_output);
    return object;
}

ordered_json json_of(const Flystick& flystick) {
    ordered_json object;
    object["id"] = flystick.id;
    if (!same(flystick.aim_in_body, Pose{})) object["aim_in_body"] = json_of(flystick.aim_in_body);
    object["select"] = flystick.select;
    object["menu"] = flystick.menu;
    object["tool"] = flystick.tool;
    return object;
}

// Writes `port`, `body` and `pose` if the head has the tracker that uses them, or if they are not the
// defaults.
// Writes the members from `axes` on together, if any of them is not the default.
ordered_json json_of(const HeadTracking& head) {
    const HeadTracking unless_given;
    ordered_json object;
    object["tracker"] = name(head.tracker);
    object["fixed"] = json_of(head.fixed_head);
    if (head.tracker == HeadTracker::dtrack || head.port != unless_given.port) object["port"] = head.port;
    if (head.tracker == HeadTracker::dtrack || head.body != unless_given.body) object["body"] = head.body;
    if (head.flystick) object["flystick"] = json_of(*head.flystick);
    if (head.tracker == HeadTracker::openxr || head.pose != unless_given.pose)
        object["pose"] = name(head.pose);
    if (!head.recording.empty()) object["recording"] = head.recording;
    HeadTracking without_settings;
    without_settings.fixed_head = head.fixed_head;
    without_settings.port = head.port;
    without_settings.body = head.body;
    without_settings.flystick = head.flystick;
    without_settings.pose = head.pose;
    without_settings.recording = head.recording;
    if (head == without_settings) return object;
    for (const TrackerAxis& axis : head.axes) object["axes"].push_back(axis_name(axis));
    object["scale"] = head.scale;
    object["tracker_in_room"] = json_of(head.tracker_in_room);
    object["head_in_body"] = json_of(head.head_in_body);
    object["hold_s"] = head.hold;
    object["fade_s"] = head.fade;
    object["max_speed_m_per_s"] = head.max_speed;
    object["jump_s"] = head.jump_time;
    return object;
}

// The end of the array that begins at `start`; npos if it has arrays or objects in it. The text is valid
// JSON.
std::size_t end_of_flat_array(std::string_view text, std::size_t start) {
    bool in_text = false;
    for (std::size_t i = start + 1; i < text.size(); ++i) {
        if (text[i] == '\\' && in_text)
            ++i;
        else if (text[i] == '"')
            in_text = !in_text;
        else if (!in_text && (text[i] == '[' || text[i] == '{'))
            return std::string_view::npos;
        else if (!in_text && text[i] == ']')
            return i;
    }
    return std::string_view::npos;
}

// Writes arrays of numbers or texts in one line, as people do.
std::string with_flat_arrays(std::string_view text) {
    std::string flat;
    bool in_text = false;
    std::size_t array_end = 0;  // of the flat array that `i` is in
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '[' && !in_text && i >= array_end) {
            const std::size_t end = end_of_flat_array(text, i);
            if (end != std::string_view::npos) array_end = end;
        }
        if (c == '"') in_text = !in_text;
        if (c == '\n' && i < array_end) {  // a line break is never in a text
            i = text.find_first_not_of(' ', i + 1) - 1;
            if (flat.back() == ',') flat += ' ';
            continue;
        }
        flat += c;
        if (c == '\\') flat += text[++i];
    }
    return flat;
}

}  // namespace

bool Flystick::operator==(const Flystick& other) const {
    return id == other.id && same(aim_in_body, other.aim_in_body) && select == other.select &&
           menu == other.menu && tool == other.tool;
}

bool HeadTracking::operator==(const HeadTracking& other) const {
    return tracker == other.tracker && flystick == other.flystick && same(fixed_head, other.fixed_head) &&
           port == other.port && body == other.body && pose == other.pose && recording == other.recording &&
           axes == other.axes && scale == other.scale && same(tracker_in_room, other.tracker_in_room) &&
           same(head_in_body, other.head_in_body) && hold == other.hold && fade == other.fade &&
           max_speed == other.max_speed && jump_time == other.jump_time;
}

Quat orientation_of(const std::array<TrackerAxis, 3>& axes) {
    glm::dmat3 rows(0.0);  // row i has the tracker's coordinate that becomes the room's coordinate i
    for (int i = 0; i < 3; ++i) {
        const TrackerAxis& axis = axes[static_cast<std::size_t>(i)];
        rows[axis.axis][i] = axis.negative ? -1.0 : 1.0;
    }
    return glm::normalize(glm::quat_cast(rows));
}

LoadedDisplays load_displays(const std::filesystem::path& path) {
    const Result<std::string> text = read_file(path, max_display_file_size, ErrorCode::bad_content);
    if (text) return parse_displays(*text, path.string());
    LoadedDisplays loaded;
    loaded.file = path.string();
    loaded.errors.push_back(text.error());
    return loaded;
}

std::string displays_json(const DisplayFile& displays) {
    ordered_json root;
    if (!displays.schema.empty()) root["$schema"] = displays.schema;
    root["format"] = displays_format;
    if (!displays.name.empty()) root["name"] = displays.name;
    root["eye_separation_m"] = displays.eye_separation;
    root["head"] = json_of(displays.head);
    root["walls"] = ordered_json::array();
    for (const Wall& wall : displays.walls) root["walls"].push_back(json_of(wall));
    // Bytes that are not UTF-8 are replaced, because they would make the file unreadable.
    return with_flat_arrays(root.dump(2, ' ', false, ordered_json::error_handler_t::replace)) + "\n";
}

Status save_displays(const std::filesystem::path& path, const DisplayFile& displays) {
    const std::string text = displays_json(displays);
    const LoadedDisplays again = parse_displays(text, path.string());
    if (!again.ok()) return fail(again.errors.front());
    return write_file(path, text);
}

}  // namespace bolt::content
