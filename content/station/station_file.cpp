#include "content/station/station_file.hpp"

#include <array>

#include "content/format/json_members.hpp"
#include "content/station/wheel_config_file.hpp"
#include "engine/base/file.hpp"
#include "haptics/device/connected_devices.hpp"

namespace bolt::content {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;
using station::Buttons;

constexpr const char* station_format = "boltwright station 1";
constexpr std::size_t max_station_size = 1U << 16U;
constexpr std::size_t max_path = 1000;  // bytes
constexpr unsigned max_button = 32;     // bits of a sample's buttons

struct NumberMember {
    const char* key;
    double low, high;
};

// A text that may not be empty.
struct TextMember {
    const char* key;
    std::size_t max_size;  // bytes
    const char* expected;
};
constexpr TextMember device_member{"device", MemberReader::max_text,
                                   "the id of a device, as `boltwright devices` lists it"};
constexpr TextMember port_member{"port", max_path, "a serial port, as /dev/ttyUSB0"};

struct AngleMember {
    const char* key;
    double Mounting::*angle;
};
constexpr std::array<AngleMember, 3> angle_members{
    {{"yaw_deg", &Mounting::yaw}, {"pitch_deg", &Mounting::pitch}, {"roll_deg", &Mounting::roll}}};

struct ButtonMember {
    const char* key;
    std::uint32_t Buttons::*mask;
};
constexpr std::array<ButtonMember, 4> button_members{{{"dead_man", &Buttons::dead_man},
                                                      {"clutch", &Buttons::clutch},
                                                      {"stop", &Buttons::stop},
                                                      {"reset", &Buttons::reset}}};

struct BoundMember {
    NumberMember number;
    std::optional<double> force::LimitBounds::*bound;
};
// A force or torque of 0 switches it off.
constexpr std::array<BoundMember, 6> bound_members{
    {{{"force_N", 0.0, 1000.0}, &force::LimitBounds::force},
     {{"torque_Nm", 0.0, max_configurable_torque}, &force::LimitBounds::torque},
     {{"stiffness_N_per_m", min_stiffness, 1e5}, &force::LimitBounds::stiffness},
     {{"torsion_Nm_per_rad", 0.1, 1000.0}, &force::LimitBounds::torsion},
     {{"damping_Ns_per_m", 0.0, 1000.0}, &force::LimitBounds::damping},
     {{"angular_damping_Nms_per_rad", 0.0, 10.0}, &force::LimitBounds::angular_damping}}};

// Null if the member is absent or is no object, which is then reported.
const json* object_member(MemberReader& members, const json& parent, const std::string& at, const char* key) {
    const auto it = parent.find(key);
    if (it == parent.end() || it->is_object()) return it == parent.end() ? nullptr : &*it;
    members.report(at + "/" + key, JsonPart::value, fmt::format("\"{}\" is not an object", key),
                   "an object {...}");
    return nullptr;
}

template <class Members>
std::vector<std::string> keys_of(const Members& table) {
    std::vector<std::string> keys;
    for (const auto& member : table) keys.emplace_back(member.key);
    return keys;
}

std::string read_text(MemberReader& members, const json& object, const std::string& at,
                      const TextMember& member) {
    if (!object.contains(member.key)) {
        members.report(at, JsonPart::value, fmt::format("\"{}\" is missing", member.key), member.expected);
        return {};
    }
    std::string text = members.text(object, at, member.key, member.max_size);
    if (text.empty())
        members.report(at + "/" + member.key, JsonPart::value, fmt::format("\"{}\" is empty", member.key),
                       member.expected);
    return text;
}

// The mask of a button's number, from 1, or of a list of numbers.
std::uint32_t read_mask(MemberReader& members, const json& value, const std::string& at) {
    std::uint32_t mask = 0;
    const auto add = [&](const json& number, const std::string& where) {
        const double n = number.is_number() ? number.get<double>() : 0.0;
        if (n >= 1.0 && n <= max_button && n == std::floor(n))
            mask |= 1U << (static_cast<unsigned>(n) - 1U);
        else
            members.report(where, JsonPart::value,
                           fmt::format("{} is not the number of a button", in_quotes(number.dump())),
                           fmt::format("a whole number from 1 to {}, or a list of them", max_button));
    };
    if (!value.is_array()) {
        add(value, at);
        return mask;
    }
    for (std::size_t i = 0; i < value.size(); ++i) add(value[i], fmt::format("{}/{}", at, i));
    return mask;
}

// A button with two functions would do both; one of them may be a default.
void check_buttons(MemberReader& members, const json& object, const std::string& at, const Buttons& buttons) {
    for (const ButtonMember& one : button_members)
        for (const ButtonMember& other : button_members) {
            if (&one == &other || (buttons.*one.mask & buttons.*other.mask) == 0) continue;
            if (!object.contains(one.key)) continue;
            members.report(
                at + "/" + one.key, JsonPart::value,
                fmt::format("\"{}\" has a button that is also \"{}\"{}", one.key, other.key,
                            object.contains(other.key) ? "" : ", as it is unless given"),
                fmt::format("another button, or another one for \"{}\", such as [] for none", other.key));
        }
}

void read_buttons(MemberReader& members, const json& device, const std::string& parent,
                  std::optional<Buttons>& to) {
    const json* object = object_member(members, device, parent, "buttons");
    if (object == nullptr) return;
    const std::string at = parent + "/buttons";
    members.check_known(*object, at, keys_of(button_members));
    Buttons buttons;
    for (const ButtonMember& member : button_members)
        if (const auto it = object->find(member.key); it != object->end())
            buttons.*member.mask = read_mask(members, *it, at + "/" + member.key);
    check_buttons(members, *object, at, buttons);
    to = buttons;
}

void read_mounting(MemberReader& members, const json& arm, Mounting& to) {
    const json* object = object_member(members, arm, "/arm", "mounting");
    if (object == nullptr) return;
    members.check_known(*object, "/arm/mounting", keys_of(angle_members));
    for (const AngleMember& member : angle_members)
        if (object->contains(member.key))
            to.*member.angle =
                to_radians(members.number(*object, "/arm/mounting", member.key, -360.0, 360.0));
}

void read_limits(MemberReader& members, const json& arm, force::LimitBounds& to) {
    const json* object = object_member(members, arm, "/arm", "limits");
    if (object == nullptr) return;
    std::vector<std::string> known;
    for (const BoundMember& member : bound_members) known.emplace_back(member.number.key);
    members.check_known(*object, "/arm/limits", known);
    for (const auto& [number, bound] : bound_members)
        if (object->contains(number.key))
            to.*bound = members.number(*object, "/arm/limits", number.key, number.low, number.high);
}

void read_arm(MemberReader& members, const json& root, std::optional<StationMover>& to) {
    const json* object = object_member(members, root, "", "arm");
    if (object == nullptr) return;
    members.check_known(
        *object, "/arm",
        {"device", "mounting", "scale", "power", "buttons", "limits", "effector_mass_kg", "tool"});
    StationMover& arm = to.emplace();
    arm.device = read_text(members, *object, "/arm", device_member);
    read_mounting(members, *object, arm.mounting);
    if (object->contains("scale")) arm.scale = members.number(*object, "/arm", "scale", 0.1, 20.0);
    if (object->contains("power")) arm.power_ratio = members.number(*object, "/arm", "power", 0.01, 10.0);
    read_buttons(members, *object, "/arm", arm.buttons);
    read_limits(members, *object, arm.limits);
    if (object->contains("effector_mass_kg"))
        arm.effector_mass =
            members.number(*object, "/arm", "effector_mass_kg", 0.0, device::max_effector_mass);
    if (object->contains("tool")) arm.tool = members.text(*object, "/arm", "tool");
}

void read_wheel(MemberReader& members, const json& root, std::optional<StationWheel>& to) {
    const json* object = object_member(members, root, "", "wheel");
    if (object == nullptr) return;
    std::vector<std::string> known = wheel_config_members();
    known.insert(known.end(), {"device", "buttons"});
    members.check_known(*object, "/wheel", known);
    StationWheel& wheel = to.emplace();
    wheel.device = read_text(members, *object, "/wheel", device_member);
    read_wheel_config(members, *object, "/wheel", wheel.config);
    read_buttons(members, *object, "/wheel", wheel.buttons);
}

constexpr const char* wrist_tracker_key = "wrist_tracker";

void read_glove(MemberReader& members, const json& root, StationFile& station) {
    const json* object = object_member(members, root, "", "glove");
    if (object == nullptr) return;
    members.check_known(*object, "/glove", {"port", wrist_tracker_key});
    station.glove_port = read_text(members, *object, "/glove", port_member);
    if (!object->contains(wrist_tracker_key)) return;
    const std::string role = members.text(*object, "/glove", wrist_tracker_key);
    station.wrist_tracker = parse_tracker_role(role);
    if (!station.wrist_tracker)
        members.report(
            fmt::format("/glove/{}", wrist_tracker_key), JsonPart::value,
            fmt::format("{} is not a role of a Vive tracker", in_quotes(role)),
            suggest(role, std::vector<std::string>(tracker_role_names.begin(), tracker_role_names.end())));
}

}  // namespace

Quat orientation_of(const Mounting& mounting) {
    return rotation({0.0, mounting.yaw, 0.0}) * rotation({mounting.pitch, 0.0, 0.0}) *
           rotation({0.0, 0.0, mounting.roll});
}

Result<StationFile> parse_station(std::string_view text, const std::string& file) {
    const FileHead head{
        "station file", station_format, {"$schema", "name", "arm", "wheel", "glove", "registrations"}};
    return parse_small_file(text, file, head, [](MemberReader& members, const json& root) {
        StationFile station;
        if (root.contains("$schema")) station.schema = members.text(root, "", "$schema", max_path);
        if (root.contains("name")) station.name = members.text(root, "", "name");
        read_arm(members, root, station.arm);
        read_wheel(members, root, station.wheel);
        read_glove(members, root, station);
        station.registrations = read_registrations(members, root);
        return station;
    });
}

Result<StationFile> load_station(const std::filesystem::path& path) {
    BOLT_TRY_ASSIGN(const auto text, read_file(path, max_station_size, ErrorCode::bad_content));
    return parse_station(text, path.string());
}

namespace {

ordered_json numbers_of(std::uint32_t mask) {
    ordered_json numbers = ordered_json::array();
    for (unsigned i = 0; i < max_button; ++i)
        if ((mask >> i & 1U) != 0) numbers.push_back(i + 1);
    return numbers.size() == 1 ? numbers[0] : numbers;
}

void write_buttons(ordered_json& device, const std::optional<Buttons>& buttons) {
    if (!buttons) return;
    for (const ButtonMember& member : button_members)
        device["buttons"][member.key] = numbers_of(*buttons.*member.mask);
}

ordered_json json_of(const StationMover& arm) {
    ordered_json object;
    object["device"] = arm.device;
    for (const AngleMember& member : angle_members)
        object["mounting"][member.key] = exact_degrees(arm.mounting.*member.angle);
    if (arm.scale) object["scale"] = *arm.scale;
    if (arm.power_ratio) object["power"] = *arm.power_ratio;
    write_buttons(object, arm.buttons);
    for (const auto& [number, bound] : bound_members)
        if (arm.limits.*bound) object["limits"][number.key] = *(arm.limits.*bound);
    if (arm.effector_mass > 0.0) object["effector_mass_kg"] = arm.effector_mass;
    if (!arm.tool.empty()) object["tool"] = arm.tool;
    return object;
}

ordered_json json_of(const StationWheel& wheel) {
    ordered_json object;
    object["device"] = wheel.device;
    write_wheel_config(object, wheel.config);
    write_buttons(object, wheel.buttons);
    return object;
}

}  // namespace

std::string station_json(const StationFile& station) {
    ordered_json root;
    if (!station.schema.empty()) root["$schema"] = station.schema;
    root["format"] = station_format;
    if (!station.name.empty()) root["name"] = station.name;
    if (station.arm) root["arm"] = json_of(*station.arm);
    if (station.wheel) root["wheel"] = json_of(*station.wheel);
    if (!station.glove_port.empty()) root["glove"]["port"] = station.glove_port;
    if (!station.glove_port.empty() && station.wrist_tracker)
        root["glove"][wrist_tracker_key] = name(*station.wrist_tracker);
    write_registrations(root, station.registrations);
    // Bytes that are not UTF-8 are replaced, because they would make the file unreadable.
    return root.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

Status save_station(const std::filesystem::path& path, const StationFile& station) {
    const std::string text = station_json(station);
    BOLT_TRY(parse_station(text, path.string()));
    return write_file(path, text);
}

}  // namespace bolt::content
