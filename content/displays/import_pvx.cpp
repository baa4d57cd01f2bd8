#include "content/displays/import_pvx.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <pugixml.hpp>

#include "content/displays/pvx_machine.hpp"
#include "content/displays/pvx_messages.hpp"
#include "content/displays/pvx_values.hpp"
#include "content/displays/wall_geometry.hpp"
#include "content/format/json_document.hpp"
#include "content/format/json_syntax.hpp"
#include "engine/base/file.hpp"

namespace bolt::content {

namespace {

constexpr std::size_t max_pvx_size = 1U << 20U;  // bytes
constexpr std::size_t max_wall_name = 200;       // bytes
constexpr double same_corner = 1e-6;             // m

class PvxImport {
  public:
    PvxImport(std::string_view text, const std::string& file, const PvxOptions& options)
        : text_(text), messages_(text, file), scale_(options.scale), eye_height_(options.eye_height) {}

    ImportedDisplays run();

  private:
    pugi::xml_node parse(pugi::xml_document& document);
    void read_root(pugi::xml_node root);
    void read_element(pugi::xml_node node);
    void read_eye_separation(pugi::xml_node node);
    void read_machine(pugi::xml_node node);
    void name_wall(PvxMachine& machine);
    void assign_processes();
    void assign_monitors();
    void drop_single_display();
    void join_stereo_pairs();
    void read_stereo(PvxMachine& machine);
    void place_head();

    std::string_view text_;
    PvxMessages messages_;
    double scale_;
    std::optional<double> eye_height_;
    std::vector<PvxMachine> machines_;
    DisplayFile displays_;
};

// ParaView reads the Process of the server, else the last one.
pugi::xml_node choose_process(pugi::xml_node root) {
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
        const auto value = parse_bool(node.attribute("Value").as_string("1"));
        if (!value)
            messages_.fail_at(node, "Value",
                              in_quotes(node.attribute("Value").as_string()) + " is not a truth value",
                              "0 or 1");
        else if (!*value)
            messages_.warn_at(node, "Value",
                              "UseOffAxisProjection is off: walls always have an off-axis projection here");
    } else if (name == "IndependentViewers") {
        messages_.warn_at(node, nullptr,
                          "IndependentViewers is left out: all walls show what one viewer sees");
    } else if (name == "Option") {
        messages_.warn_at(
            node, nullptr,
            fmt::format("the option {} is left out", in_quotes(node.attribute("Name").as_string())));
    } else {
        messages_.warn_at(node, nullptr,
                          fmt::format("the element {} is not known and left out", in_quotes(name)));
    }
}

void PvxImport::read_eye_separation(pugi::xml_node node) {
    const auto value = finite_number(node.attribute("Value").as_string());
    const double separation = value.value_or(-1.0) * scale_;
    if (separation >= 0.0 && separation <= max_eye_separation)
        displays_.eye_separation = separation;
    else
        messages_.fail_at(
            node, "Value",
            fmt::format("the eye separation cannot be {}", in_quotes(node.attribute("Value").as_string())),
            fmt::format("0 to {:g} m; other units need another scale", max_eye_separation));
}

// Gives the wall a unique name, because machines of one computer have the same Name.
void PvxImport::name_wall(PvxMachine& machine) {
    std::string base = machine.host;
    if (base.size() > max_wall_name - 10) {
        messages_.fail_at(machine.node, "Name", "the Name is too long",
                          fmt::format("at most {} bytes", max_wall_name - 10));
        return;
    }
    if (base.empty()) base = "wall";
    const auto is_taken = [&](const std::string& name) {
        return std::any_of(machines_.begin(), machines_.end(), [&](const PvxMachine& other) {
            return &other != &machine && other.wall.name == name;
        });
    };
    machine.wall.name = base;
    for (int i = 2; is_taken(machine.wall.name); ++i) machine.wall.name = fmt::format("{} {}", base, i);
}

void PvxImport::read_machine(pugi::xml_node node) {
    if (machines_.size() > max_walls) return;
    if (machines_.size() == max_walls)
        messages_.fail_at(node, nullptr, "there are too many machines", fmt::format("at most {}", max_walls));
    machines_.push_back(read_pvx_machine(node, scale_, messages_));
    name_wall(machines_.back());
}

// In ParaView every Machine is a process, and its Name may be that of the computer or of the wall. The Names
// denote computers if two machines with different Names would otherwise cover the same pixels.
void PvxImport::assign_processes() {
    const auto collide = [](const PvxMachine& a, const PvxMachine& b) {
        const DisplayOutput &one = a.wall.output, &other = b.wall.output;
        if (a.host == b.host || one.display != other.display) return false;
        // Two windows without a Geometry both fill the screen.
        if (!one.position || !other.position) return !one.position && !other.position;
        const auto overlap = [](int from, int size, int other_from, int other_size) {
            return from < other_from + other_size && other_from < from + size;
        };
        return overlap(one.position->x, one.resolution->width, other.position->x, other.resolution->width) &&
               overlap(one.position->y, one.resolution->height, other.position->y, other.resolution->height);
    };
    bool names_are_computers = false;
    for (const PvxMachine& one : machines_)
        names_are_computers =
            names_are_computers || std::any_of(machines_.begin(), machines_.end(),
                                               [&](const PvxMachine& other) { return collide(one, other); });
    if (!names_are_computers) return;
    std::vector<std::string> hosts;
    for (PvxMachine& machine : machines_) {
        const auto it = std::find(hosts.begin(), hosts.end(), machine.host);
        machine.wall.output.process = static_cast<int>(it - hosts.begin());
        if (it == hosts.end()) hosts.push_back(machine.host);
    }
    messages_.warn_at(
        machines_.front().node, nullptr,
        fmt::format("windows of machines with different Names overlap, so each Name is taken as a computer "
                    "with a process of its own: {} processes",
                    hosts.size()));
}

// Assigns monitors to walls without a Geometry: the first such wall of a process is on its first monitor, and
// so on.
void PvxImport::assign_monitors() {
    std::vector<int> next(max_walls, 0);
    for (PvxMachine& machine : machines_) {
        DisplayOutput& output = machine.wall.output;
        if (!output.position) output.monitor_index = next[static_cast<std::size_t>(output.process)]++;
    }
}

// Removes the display if all walls have the same one, because the program itself then runs on it.
void PvxImport::drop_single_display() {
    const std::string display = machines_.front().wall.output.display;
    if (display.empty()) return;
    for (const PvxMachine& machine : machines_)
        if (machine.wall.output.display != display) return;
    for (PvxMachine& machine : machines_) machine.wall.output.display.clear();
    if (display != ":0" && display != ":0.0")
        messages_.warn_at(
            machines_.front().node, "Environment",
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
        const auto right = std::find_if(machines_.begin(), machines_.end(), [&](const PvxMachine& other) {
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

void PvxImport::read_stereo(PvxMachine& machine) {
    const std::string& type = machine.stereo;
    if (type == "SplitViewportHorizontal")
        machine.wall.stereo = StereoMode::side_by_side;
    else if (type == "Left" || type == "Right")
        messages_.warn_at(
            machine.node, "StereoType",
            fmt::format("no machine has the same corners and the StereoType \"{}\": the wall is mono",
                        type == "Left" ? "Right" : "Left"));
    else if (!type.empty() && type != "Mono" && type != "None")
        messages_.warn_at(
            machine.node, "StereoType",
            fmt::format("the StereoType {} has no counterpart: the wall is mono", in_quotes(type)));
}

// The file has no position of the viewer: chooses a point from which all walls are seen from the front.
void PvxImport::place_head() {
    Vec3 middle(0.0);
    for (const Wall& wall : displays_.walls) {
        const Vec3 center = 0.5 * (wall.lower_left + wall.upper_right);
        middle += (center + 0.5 * width(wall) * axes_of(wall).normal) / static_cast<double>(machines_.size());
    }
    Vec3& head = displays_.head.fixed_head.position;
    if (eye_height_) head.y = *eye_height_;
    for (const Vec3& point : {head, Vec3(0.0, eye_height_.value_or(0.0), 0.0), middle}) {
        head = point;
        const auto is_in_front = [&](const Wall& wall) {
            return distance_in_front(axes_of(wall), point) > 0.05;
        };
        if (std::all_of(displays_.walls.begin(), displays_.walls.end(), is_in_front)) break;
    }
    messages_.warn_at(
        machines_.front().node, nullptr,
        fmt::format("the file does not have the viewer and its tracker: enter them; until then the head is "
                    "fixed at {:.2f}, {:.2f}, {:.2f} m",
                    head.x, head.y, head.z));
}

// Returns the element pvx; none after a mistake.
pugi::xml_node PvxImport::parse(pugi::xml_document& document) {
    if (const auto mistake = explain_encoding(text_)) {
        messages_.fail_at(mistake->offset, mistake->what, mistake->expected);
        return {};
    }
    const pugi::xml_parse_result parsed =
        document.load_buffer(text_.data(), text_.size(), pugi::parse_default, pugi::encoding_utf8);
    if (!parsed) {
        messages_.fail_at(std::min(static_cast<std::size_t>(parsed.offset), text_.size()),
                          fmt::format("this is not XML: {}", parsed.description()), {});
        return {};
    }
    const pugi::xml_node root = document.child("pvx");
    if (!root)
        messages_.fail_at(std::size_t{0}, "the file has no element pvx",
                          "a file of ParaView: <pvx>...</pvx>");
    return root;
}

void PvxImport::read_root(pugi::xml_node root) {
    const pugi::xml_node process = choose_process(root);
    for (const pugi::xml_node node : root.children()) {
        if (node.type() != pugi::node_element || node == process) continue;
        if (std::string_view(node.name()) != "Process")
            read_element(node);
        else if (node.first_child())
            messages_.warn_at(node, nullptr, "another Process is used; this one is left out");
    }
    for (const pugi::xml_node node : process.children())
        if (node.type() == pugi::node_element) read_element(node);
    if (machines_.empty() && !messages_.has_errors())
        messages_.fail_at(root, nullptr, "there is no Machine", "a Machine for each wall");
}

ImportedDisplays PvxImport::run() {
    pugi::xml_document document;
    if (const pugi::xml_node root = parse(document)) read_root(root);
    if (!messages_.has_errors()) {
        assign_processes();
        assign_monitors();
        drop_single_display();
        join_stereo_pairs();
        for (PvxMachine& machine : machines_) {
            read_stereo(machine);
            for (Vec3* corner :
                 {&machine.wall.lower_left, &machine.wall.lower_right, &machine.wall.upper_right})
                corner->y += eye_height_.value_or(0.0);
            displays_.walls.push_back(machine.wall);
        }
        place_head();
    }
    ImportedDisplays result;
    result.errors = messages_.take_errors();
    result.warnings = messages_.take_warnings();
    if (result.ok()) result.displays = std::move(displays_);
    return result;
}

}  // namespace

ImportedDisplays import_pvx(std::string_view text, const std::string& file, const PvxOptions& options) {
    return PvxImport(text, file, options).run();
}

ImportedDisplays load_pvx(const std::filesystem::path& path, const PvxOptions& options) {
    const Result<std::string> text = read_file(path, max_pvx_size, ErrorCode::bad_content);
    if (text) return import_pvx(*text, path.string(), options);
    ImportedDisplays failed;
    failed.errors.push_back(text.error());
    return failed;
}

}  // namespace bolt::content
