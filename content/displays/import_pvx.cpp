#include "content/displays/import_pvx.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <pugixml.hpp>

#include "content/displays/pvx_values.hpp"
#include "content/displays/wall_geometry.hpp"
#include "content/format/json_document.hpp"
#include "content/format/json_syntax.hpp"
#include "engine/base/file.hpp"

namespace bolt::content {

namespace {

constexpr std::size_t max_pvx_size = 1U << 20U;  // bytes
constexpr std::size_t max_name_size = 200;       // bytes
constexpr double max_corner = 1000.0;            // m
constexpr double same_corner = 1e-6;             // m
constexpr std::size_t max_pvx_messages = 200;    // errors, and warnings

// A Machine element, as it is read.
struct Machine {
    Wall wall;
    std::string host;    // its attribute Name
    std::string stereo;  // its attribute StereoType
    pugi::xml_node node;
};

class PvxImport {
  public:
    PvxImport(std::string_view text, const std::string& file, double scale)
        : text_(text), file_(file), scale_(scale) {}

    ImportedDisplays run();

  private:
    [[nodiscard]] Error error_at(std::size_t offset, std::string what, std::string expected) const;
    // `attribute` null: at the element.
    [[nodiscard]] std::size_t offset_of(pugi::xml_node node, const char* attribute) const;
    void fail_at(pugi::xml_node node, const char* attribute, std::string what, std::string expected) {
        add(result_.errors, node, attribute, std::move(what), std::move(expected));
    }
    void warn_at(pugi::xml_node node, const char* attribute, std::string what) {
        add(result_.warnings, node, attribute, std::move(what), {});
    }
    void add(std::vector<Error>& list, pugi::xml_node node, const char* attribute, std::string what,
             std::string expected);
    pugi::xml_node choose_process(pugi::xml_node root);
    void read_element(pugi::xml_node node);
    void read_eye_separation(pugi::xml_node node);
    void read_machine(pugi::xml_node node);
    void read_corner(pugi::xml_node node, const char* attribute, Vec3& to);
    void read_geometry(Machine& machine);
    void read_environment(Machine& machine);
    void check_attributes(pugi::xml_node node);
    void name_wall(Machine& machine);
    void assign_ranks();
    void assign_monitors();
    void drop_single_display();
    void join_stereo_pairs();
    void read_stereo(Machine& machine);
    void place_head();

    std::string_view text_;
    const std::string& file_;
    double scale_;
    std::vector<Machine> machines_;
    bool too_many_ = false;
    ImportedDisplays result_;
};

Error PvxImport::error_at(std::size_t offset, std::string what, std::string expected) const {
    const std::string_view before = text_.substr(0, offset);
    const std::size_t line_start = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
    const auto is_character = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; };
    Error error;
    error.code = ErrorCode::bad_content;
    error.what = std::move(what);
    error.expected = std::move(expected);
    error.file = file_;
    error.line = static_cast<int>(std::count(before.begin(), before.end(), '\n')) + 1;
    error.column = static_cast<int>(std::count_if(before.begin() + static_cast<std::ptrdiff_t>(line_start),
                                                  before.end(), is_character)) +
                   1;
    return error;
}

std::size_t PvxImport::offset_of(pugi::xml_node node, const char* attribute) const {
    const std::ptrdiff_t at = node.offset_debug();
    const std::size_t start = at < 0 ? 0 : static_cast<std::size_t>(at);
    if (attribute == nullptr) return start;
    // The parser keeps no positions of attributes: find the name before the end of the tag.
    const std::string name(attribute);
    const std::size_t end = std::min(text_.find('>', start), text_.size());
    for (std::size_t i = text_.find(name, start); i < end; i = text_.find(name, i + 1)) {
        const std::size_t after = i + name.size();
        const bool ends = after < text_.size() && (text_[after] == '=' || is_blank(text_[after]));
        if (i > 0 && is_blank(text_[i - 1]) && ends) return i;
    }
    return start;
}

// Bounded, because each message costs a search through the file.
void PvxImport::add(std::vector<Error>& list, pugi::xml_node node, const char* attribute, std::string what,
                    std::string expected) {
    if (list.size() > max_pvx_messages) return;
    if (list.size() == max_pvx_messages) {
        what = "further messages are not shown: this is probably no file of ParaView";
        expected.clear();
    }
    list.push_back(error_at(offset_of(node, attribute), std::move(what), std::move(expected)));
}

// ParaView reads the Process of the server, else the last one.
pugi::xml_node PvxImport::choose_process(pugi::xml_node root) {
    pugi::xml_node chosen;
    for (const pugi::xml_node child : root.children("Process")) {
        const std::string_view type = child.attribute("Type").as_string();
        chosen = child;
        if (type == "server" || type == "render-server") break;
    }
    return chosen;
}

void PvxImport::read_element(pugi::xml_node node) {
    const std::string_view name = node.name();
    if (name == "Machine") {
        read_machine(node);
    } else if (name == "EyeSeparation") {
        read_eye_separation(node);
    } else if (name == "UseOffAxisProjection") {
        const auto value = truth(node.attribute("Value").as_string("1"));
        if (!value)
            fail_at(node, "Value", in_quotes(node.attribute("Value").as_string()) + " is not a truth value",
                    "0 or 1");
        else if (!*value)
            warn_at(node, "Value",
                    "UseOffAxisProjection is off: walls always have an off-axis projection here");
    } else if (name == "IndependentViewers") {
        warn_at(node, nullptr, "IndependentViewers is left out: all walls show what one viewer sees");
    } else if (name == "Option") {
        warn_at(node, nullptr,
                fmt::format("the option {} is left out", in_quotes(node.attribute("Name").as_string())));
    } else {
        warn_at(node, nullptr, fmt::format("the element {} is not known and left out", in_quotes(name)));
    }
}

void PvxImport::read_eye_separation(pugi::xml_node node) {
    const auto value = finite_number(node.attribute("Value").as_string());
    const double separation = value.value_or(-1.0) * scale_;
    if (separation >= 0.0 && separation <= max_eye_separation)
        result_.displays.eye_separation = separation;
    else
        fail_at(
            node, "Value",
            fmt::format("the eye separation cannot be {}", in_quotes(node.attribute("Value").as_string())),
            fmt::format("0 to {:g} m; other units need another scale", max_eye_separation));
}

void PvxImport::read_corner(pugi::xml_node node, const char* attribute, Vec3& to) {
    const char* text = node.attribute(attribute).as_string();
    const std::vector<std::string_view> parts = parts_of(text, ',');
    bool good = parts.size() == 3;
    for (int i = 0; good && i < 3; ++i) {
        const auto value = finite_number(parts[static_cast<std::size_t>(i)]);
        good = value && std::abs(*value * scale_) <= max_corner;
        if (good) to[i] = *value * scale_;
    }
    if (good) return;
    if (node.attribute(attribute).empty())
        fail_at(node, nullptr, fmt::format("{} is missing", attribute), "a corner: three numbers, m");
    else
        fail_at(node, attribute, fmt::format("{} cannot be {}", attribute, in_quotes(text)),
                fmt::format("three numbers of at most {:g} m; other units need another scale", max_corner));
}

void PvxImport::read_geometry(Machine& machine) {
    const pugi::xml_attribute attribute = machine.node.attribute("Geometry");
    if (attribute.empty()) {
        warn_at(machine.node, nullptr, "without a Geometry the wall fills a monitor; enter which one");
        return;
    }
    const auto geometry = parse_geometry(attribute.value());
    if (!geometry) {
        fail_at(machine.node, "Geometry", fmt::format("Geometry cannot be {}", in_quotes(attribute.value())),
                "width x height + x + y in pixels, such as 1920x1080+0+0");
        return;
    }
    machine.wall.output.position = geometry->first;
    machine.wall.output.resolution = geometry->second;
}

void PvxImport::read_environment(Machine& machine) {
    constexpr std::string_view display = "DISPLAY=";
    for (const std::string_view part : parts_of(machine.node.attribute("Environment").as_string(), ';')) {
        const std::string_view value = part.starts_with(display) ? part.substr(display.size()) : "";
        if (!value.empty() && value.size() <= max_name_size)
            machine.wall.output.display = value;
        else
            warn_at(machine.node, "Environment",
                    fmt::format("{} of Environment is left out", in_quotes(part)));
    }
}

// Attributes that have no place in a display file, unless their value is what happens anyway.
void PvxImport::check_attributes(pugi::xml_node node) {
    struct AttributeRule {
        const char* name;
        const char* natural;  // value without effect; null: every value is read
        const char* why;
    };
    static constexpr AttributeRule rules[] = {
        {"Name", nullptr, ""},
        {"Environment", nullptr, ""},
        {"Geometry", nullptr, ""},
        {"LowerLeft", nullptr, ""},
        {"LowerRight", nullptr, ""},
        {"UpperRight", nullptr, ""},
        {"StereoType", nullptr, ""},
        {"ShowBorders", "0", "windows have no border"},
        {"FullScreen", "0", "the window stays at its Geometry"},
        {"Coverable", "0", "the window is not kept behind others"},
        {"Show2DOverlays", "1", "the panel of the trainer is part of the room"},
        {"ViewerId", "0", "all walls show what one viewer sees"}};
    for (const pugi::xml_attribute attribute : node.attributes()) {
        const std::string_view name = attribute.name();
        const auto* const rule = std::find_if(std::begin(rules), std::end(rules),
                                              [&](const AttributeRule& r) { return name == r.name; });
        if (rule == std::end(rules))
            warn_at(node, attribute.name(),
                    fmt::format("the attribute {} is not known and left out", in_quotes(name)));
        else if (rule->natural != nullptr && attribute.value() != std::string_view(rule->natural))
            warn_at(node, attribute.name(),
                    fmt::format("{} {} is left out: {}", name, in_quotes(attribute.value()), rule->why));
    }
}

// A name of its own: machines of one computer have the same Name.
void PvxImport::name_wall(Machine& machine) {
    std::string base = machine.host;
    if (base.size() > max_name_size - 10) {
        fail_at(machine.node, "Name", "the Name is too long",
                fmt::format("at most {} bytes", max_name_size - 10));
        return;
    }
    if (base.empty()) base = "wall";
    const auto is_taken = [&](const std::string& name) {
        return std::any_of(machines_.begin(), machines_.end(),
                           [&](const Machine& m) { return m.wall.name == name; });
    };
    machine.wall.name = base;
    for (int i = 2; is_taken(machine.wall.name); ++i) machine.wall.name = fmt::format("{} {}", base, i);
}

void PvxImport::read_machine(pugi::xml_node node) {
    if (machines_.size() == max_walls) {
        if (!too_many_)
            fail_at(node, nullptr, "there are too many machines", fmt::format("at most {}", max_walls));
        too_many_ = true;
        return;
    }
    Machine machine;
    machine.node = node;
    machine.host = node.attribute("Name").as_string();
    machine.stereo = node.attribute("StereoType").as_string();
    name_wall(machine);
    read_corner(node, "LowerLeft", machine.wall.lower_left);
    read_corner(node, "LowerRight", machine.wall.lower_right);
    read_corner(node, "UpperRight", machine.wall.upper_right);
    read_geometry(machine);
    read_environment(machine);
    check_attributes(node);
    machines_.push_back(std::move(machine));
}

// In ParaView every Machine is a process, and its Name may be that of the computer or of the wall. They are
// computers if two of them would show on the same pixels.
void PvxImport::assign_ranks() {
    const auto collide = [](const Machine& a, const Machine& b) {
        const DisplayOutput &one = a.wall.output, &other = b.wall.output;
        if (a.host == b.host || one.display != other.display || !one.position || !other.position)
            return false;
        const auto overlap = [](int from, int size, int other_from, int other_size) {
            return from < other_from + other_size && other_from < from + size;
        };
        return overlap(one.position->x, one.resolution->width, other.position->x, other.resolution->width) &&
               overlap(one.position->y, one.resolution->height, other.position->y, other.resolution->height);
    };
    bool computers = false;
    for (const Machine& one : machines_)
        computers = computers || std::any_of(machines_.begin(), machines_.end(),
                                             [&](const Machine& other) { return collide(one, other); });
    if (!computers) return;
    std::vector<std::string> hosts;
    for (Machine& machine : machines_) {
        const auto it = std::find(hosts.begin(), hosts.end(), machine.host);
        machine.wall.output.rank = static_cast<int>(it - hosts.begin());
        if (it == hosts.end()) hosts.push_back(machine.host);
    }
    warn_at(
        machines_.front().node, nullptr,
        fmt::format("windows of several machines are at the same place, so each Name is a computer: {} ranks",
                    hosts.size()));
}

// Walls without a Geometry: the first such wall of a rank on its first monitor, and so on.
void PvxImport::assign_monitors() {
    std::vector<int> next(max_walls, 0);
    for (Machine& machine : machines_) {
        DisplayOutput& output = machine.wall.output;
        if (!output.position) output.monitor_index = next[static_cast<std::size_t>(output.rank)]++;
    }
}

// With one display for all walls the program itself runs on it.
void PvxImport::drop_single_display() {
    const std::string display = machines_.front().wall.output.display;
    if (display.empty()) return;
    for (const Machine& machine : machines_)
        if (machine.wall.output.display != display) return;
    for (Machine& machine : machines_) machine.wall.output.display.clear();
    if (display != ":0" && display != ":0.0")
        warn_at(machines_.front().node, "Environment",
                fmt::format("all walls are on the display {}: start the program there", in_quotes(display)));
}

void PvxImport::join_stereo_pairs() {
    const auto same = [](const Wall& a, const Wall& b) {
        return glm::length(a.lower_left - b.lower_left) < same_corner &&
               glm::length(a.lower_right - b.lower_right) < same_corner &&
               glm::length(a.upper_right - b.upper_right) < same_corner;
    };
    for (std::size_t i = 0; i < machines_.size(); ++i) {
        if (machines_[i].stereo != "Left") continue;
        const auto right = std::find_if(machines_.begin(), machines_.end(), [&](const Machine& other) {
            return other.stereo == "Right" && same(machines_[i].wall, other.wall);
        });
        if (right == machines_.end()) continue;
        machines_[i].stereo.clear();
        machines_[i].wall.stereo = StereoMode::two_outputs;
        machines_[i].wall.right_output = right->wall.output;
        const auto at = static_cast<std::size_t>(right - machines_.begin());
        machines_.erase(right);
        if (at < i) --i;
    }
}

void PvxImport::read_stereo(Machine& machine) {
    const std::string& type = machine.stereo;
    if (type == "SplitViewportHorizontal")
        machine.wall.stereo = StereoMode::side_by_side;
    else if (type == "Left" || type == "Right")
        warn_at(machine.node, "StereoType",
                fmt::format("no machine has the same corners and the StereoType \"{}\": the wall is mono",
                            type == "Left" ? "Right" : "Left"));
    else if (!type.empty() && type != "Mono" && type != "None")
        warn_at(machine.node, "StereoType",
                fmt::format("the StereoType {} has no counterpart: the wall is mono", in_quotes(type)));
}

// The file does not say where the viewer is: a point from which all walls are seen from the front.
void PvxImport::place_head() {
    Vec3 middle(0.0);
    for (const Wall& wall : result_.displays.walls) {
        const Vec3 center = 0.5 * (wall.lower_left + wall.upper_right);
        middle +=
            (center + 0.5 * width(wall) * frame_of(wall).normal) / static_cast<double>(machines_.size());
    }
    Vec3& head = result_.displays.head.fixed_head.position;
    for (const Vec3& point : {head, Vec3(0.0), middle}) {
        head = point;
        const auto is_in_front = [&](const Wall& wall) {
            return distance_in_front(frame_of(wall), point) > 0.05;
        };
        if (std::all_of(result_.displays.walls.begin(), result_.displays.walls.end(), is_in_front)) break;
    }
    warn_at(
        machines_.front().node, nullptr,
        fmt::format("the file does not have the viewer and its tracker: enter them; until then the head is "
                    "fixed at {:.2f}, {:.2f}, {:.2f} m",
                    head.x, head.y, head.z));
}

ImportedDisplays PvxImport::run() {
    if (const auto mistake = explain_encoding(text_)) {
        result_.errors.push_back(error_at(mistake->offset, mistake->what, mistake->expected));
        return std::move(result_);
    }
    pugi::xml_document document;
    const pugi::xml_parse_result parsed =
        document.load_buffer(text_.data(), text_.size(), pugi::parse_default, pugi::encoding_utf8);
    if (!parsed) {
        result_.errors.push_back(error_at(std::min(static_cast<std::size_t>(parsed.offset), text_.size()),
                                          fmt::format("this is not XML: {}", parsed.description()), {}));
        return std::move(result_);
    }
    const pugi::xml_node root = document.child("pvx");
    if (!root) {
        result_.errors.push_back(
            error_at(0, "the file has no element pvx", "a file of ParaView: <pvx>...</pvx>"));
        return std::move(result_);
    }
    const pugi::xml_node process = choose_process(root);
    for (const pugi::xml_node node : root.children()) {
        if (node.type() != pugi::node_element || node == process) continue;
        if (process && std::string_view(node.name()) == "Process")
            warn_at(node, nullptr, "another Process is used; this one is left out");
        else
            read_element(node);
    }
    for (const pugi::xml_node node : process.children())
        if (node.type() == pugi::node_element) read_element(node);
    if (machines_.empty() && result_.errors.empty())
        fail_at(root, nullptr, "there is no Machine", "a Machine for each wall");
    if (!result_.errors.empty()) {
        sort_by_position(result_.errors);
        return std::move(result_);
    }
    assign_ranks();
    assign_monitors();
    drop_single_display();
    join_stereo_pairs();
    for (Machine& machine : machines_) {
        read_stereo(machine);
        result_.displays.walls.push_back(machine.wall);
    }
    place_head();
    sort_by_position(result_.warnings);
    return std::move(result_);
}

}  // namespace

ImportedDisplays import_pvx(std::string_view text, const std::string& file, double scale) {
    return PvxImport(text, file, scale).run();
}

ImportedDisplays load_pvx(const std::filesystem::path& path, double scale) {
    const Result<std::string> text = read_file(path, max_pvx_size, ErrorCode::bad_content);
    if (text) return import_pvx(*text, path.string(), scale);
    ImportedDisplays failed;
    failed.errors.push_back(text.error());
    return failed;
}

}  // namespace bolt::content
