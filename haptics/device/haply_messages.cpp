#include "haptics/device/haply_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "haptics/device/device.hpp"

namespace bolt::device {

namespace {

using Json = nlohmann::json;

constexpr std::size_t max_devices = 16;  // of one kind
constexpr double farthest = 0.6;         // m from the origin of the service's frame to any place in reach
constexpr double fastest = 50.0;         // m/s
// m, the middle of the reach from the arm's base: the resting position in the service's documentation.
constexpr Vec3 middle_from_base{0.0, -0.12, 0.15};

Vec3 from_haply(const Vec3& theirs) { return {theirs.x, theirs.z, -theirs.y}; }
Vec3 to_haply(const Vec3& ours) { return {ours.x, -ours.z, ours.y}; }

Error wrong_message(std::string what, std::string expected) {
    Error error;
    error.code = ErrorCode::failed;
    error.what = "Haply service: " + std::move(what);
    error.expected = std::move(expected);
    return error;
}

Result<Json> parse_object(std::string_view message) {
    Json json = Json::parse(message.begin(), message.end(), nullptr, /*allow_exceptions=*/false);
    if (json.is_discarded()) return fail(wrong_message("sends a message that is not JSON", "a JSON object"));
    if (!json.is_object())
        return fail(wrong_message(fmt::format("sends {}", json.type_name()), "a JSON object"));
    return json;
}

// Null if `value` is no object or has no such member.
const Json* find_member(const Json* value, const char* key) {
    if (value == nullptr || !value->is_object()) return nullptr;
    const auto found = value->find(key);
    return found == value->end() ? nullptr : &*found;
}

std::string kind_text(const Json* value) {
    return value == nullptr ? "missing" : fmt::format("of type {}", value->type_name());
}

Result<double> read_number(const Json* parent, const char* name, const char* key) {
    const Json* value = find_member(parent, key);
    if (value == nullptr || !value->is_number())
        return fail(wrong_message(fmt::format("{}.{} is {}", name, key, kind_text(value)), "a number"));
    const auto result = value->get<double>();
    if (!std::isfinite(result))
        return fail(wrong_message(fmt::format("{}.{} is not finite", name, key), "a number"));
    return result;
}

Result<bool> read_boolean(const Json* parent, const char* name, const char* key) {
    const Json* value = find_member(parent, key);
    if (value == nullptr || !value->is_boolean())
        return fail(wrong_message(fmt::format("{}.{} is {}", name, key, kind_text(value)), "true or false"));
    return value->get<bool>();
}

Result<std::string> device_id(const Json& device) {
    const Json* value = find_member(&device, "device_id");
    if (value == nullptr || !value->is_string())
        return fail(wrong_message(fmt::format("device_id is {}", kind_text(value)), "a string"));
    const auto& id = value->get_ref<const std::string&>();
    const bool plain = std::all_of(id.begin(), id.end(), [](char c) {
        return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '-' ||
               c == '_' || c == ':' || c == '.';
    });
    if (id.empty() || id.size() > 64 || !plain)
        return fail(wrong_message("device_id has unusual characters",
                                  "1 to 64 letters, digits, '-', '_', ':' or '.'"));
    return id;
}

// The devices of one kind; none if the message does not name the kind.
Result<const Json*> devices_of_kind(const Json& message, const char* key) {
    static const Json none = Json::array();
    const Json* value = find_member(&message, key);
    if (value == nullptr) return &none;
    if (!value->is_array())
        return fail(wrong_message(fmt::format("{} is {}", key, kind_text(value)), "an array"));
    if (value->size() > max_devices)
        return fail(wrong_message(fmt::format("{} has {} devices", key, value->size()),
                                  fmt::format("at most {}", max_devices)));
    return value;
}

// The device with this id; null if there is none.
Result<const Json*> find_device(const Json& message, const char* key, const std::string& id) {
    BOLT_TRY_ASSIGN(const Json* all, devices_of_kind(message, key));
    for (const Json& device : *all) {
        const Json* value = find_member(&device, "device_id");
        if (value != nullptr && value->is_string() && value->get_ref<const std::string&>() == id)
            return &device;
    }
    return nullptr;
}

// "x, y, z", no longer than `max_length`.
Result<Vec3> read_vector(const Json* state, const char* key, double max_length, const char* unit) {
    const Json* value = find_member(state, key);
    Vec3 v(0.0);
    BOLT_TRY_ASSIGN(v.x, read_number(value, key, "x"));
    BOLT_TRY_ASSIGN(v.y, read_number(value, key, "y"));
    BOLT_TRY_ASSIGN(v.z, read_number(value, key, "z"));
    const double length = std::hypot(v.x, v.y, v.z);
    if (!(length <= max_length))
        return fail(wrong_message(fmt::format("{} is {:.3g} {}", key, length, unit),
                                  fmt::format("{:g} {} at most", max_length, unit)));
    return v;
}

Result<Quat> read_orientation(const Json& value) {
    constexpr const char* name = "orientation";
    BOLT_TRY_ASSIGN(const double w, read_number(&value, name, "w"));
    BOLT_TRY_ASSIGN(const double x, read_number(&value, name, "x"));
    BOLT_TRY_ASSIGN(const double y, read_number(&value, name, "y"));
    BOLT_TRY_ASSIGN(const double z, read_number(&value, name, "z"));
    const double length = std::hypot(std::hypot(w, x), std::hypot(y, z));
    if (!(std::abs(length - 1.0) < 0.1))
        return fail(wrong_message(fmt::format("orientation has length {:.3g}", length), "a unit quaternion"));
    const Vec3 axis = from_haply({x, y, z});
    return glm::normalize(Quat(w, axis.x, axis.y, axis.z));
}

Result<std::uint32_t> pressed_buttons(const Json* state, bool wireless) {
    std::uint32_t pressed = 0;
    if (!wireless) {
        BOLT_TRY_ASSIGN(const bool button, read_boolean(state, "state", "button"));
        return button ? 1U : 0U;
    }
    const Json* buttons = find_member(state, "buttons");
    std::uint32_t bit = 1;
    for (const char* name : {"a", "b", "c"}) {
        BOLT_TRY_ASSIGN(const bool button, read_boolean(buttons, "buttons", name));
        if (button) pressed |= bit;
        bit <<= 1U;
    }
    return pressed;
}

// "inverse3", "minverse" …; services before 3.5 name no type.
Status check_type(const Json* config, const std::string& id) {
    const Json* type = find_member(config, "type");
    if (type == nullptr || *type == "inverse3" || *type == "inverse3x") return {};
    return fail(
        wrong_message(fmt::format("device {} is no Inverse3", id), "an Inverse3, whose limits are known"));
}

Status check_axes(const Json* config, const std::string& id) {
    const Json* permutation = find_member(find_member(config, "basis"), "permutation");
    if (permutation == nullptr || *permutation == "XYZ") return {};
    return fail(wrong_message(fmt::format("device {} permutes its axes (basis.permutation)", id), "XYZ"));
}

// A preset may have its origin in the middle of the reach; the others have it at the base.
Vec3 middle_of_reach(const Json* config) {
    const Json* preset = find_member(config, "preset");
    const bool centred = preset != nullptr && preset->is_string() &&
                         preset->get_ref<const std::string&>().ends_with("_centered");
    return centred ? Vec3(0.0) : middle_from_base;
}

Result<HaplyArmEntry> arm_entry(const Json& device) {
    HaplyArmEntry arm;
    BOLT_TRY_ASSIGN(arm.id, device_id(device));
    const Json* config = find_member(&device, "config");
    BOLT_TRY(check_type(config, arm.id));
    BOLT_TRY(check_axes(config, arm.id));
    BOLT_TRY_ASSIGN(arm.calibrated, read_boolean(find_member(&device, "status"), "status", "calibrated"));
    arm.middle = middle_of_reach(config);
    return arm;
}

Status read_grip(const Json& message, const HaplyGripEntry& grip, HaplyState& state) {
    BOLT_TRY_ASSIGN(const Json* device,
                    find_device(message, grip.wireless ? "wireless_verse_grip" : "verse_grip", grip.id));
    if (device == nullptr) return {};  // a wireless grip may sleep
    const Json* values = find_member(device, "state");
    const Json* turn = find_member(values, "orientation");
    if (turn == nullptr) return fail(wrong_message("orientation is missing", "an object"));
    BOLT_TRY_ASSIGN(state.orientation, read_orientation(*turn));
    BOLT_TRY_ASSIGN(state.buttons, pressed_buttons(values, grip.wireless));
    return {};
}

bool concerns(const Json* data, const HaplyArmEntry& arm) {
    const Json* id = find_member(data, "device_id");
    return id != nullptr && *id == arm.id;
}

}  // namespace

Result<HaplyInventory> parse_haply_inventory(std::string_view message) {
    BOLT_TRY_ASSIGN(const Json json, parse_object(message));
    HaplyInventory inventory;
    BOLT_TRY_ASSIGN(const Json* arms, devices_of_kind(json, "inverse3"));
    for (const Json& device : *arms) {
        BOLT_TRY_ASSIGN(HaplyArmEntry arm, arm_entry(device));
        inventory.arms.push_back(std::move(arm));
    }
    for (const bool wireless : {true, false}) {
        BOLT_TRY_ASSIGN(const Json* grips,
                        devices_of_kind(json, wireless ? "wireless_verse_grip" : "verse_grip"));
        for (const Json& device : *grips) {
            BOLT_TRY_ASSIGN(std::string id, device_id(device));
            inventory.grips.push_back({std::move(id), wireless});
        }
    }
    return inventory;
}

Result<HaplyState> parse_haply_state(std::string_view message, const HaplyArmEntry& arm,
                                     const HaplyGripEntry* grip) {
    BOLT_TRY_ASSIGN(const Json json, parse_object(message));
    BOLT_TRY_ASSIGN(const Json* device, find_device(json, "inverse3", arm.id));
    if (device == nullptr)
        return fail(lost_device_error(fmt::format("Haply Inverse3 {} is not connected any more", arm.id),
                                      "an arm that is switched on and connected by USB"));
    // States may leave the status out.
    if (const Json* status = find_member(device, "status"); find_member(status, "calibrated") != nullptr) {
        BOLT_TRY_ASSIGN(const bool calibrated, read_boolean(status, "status", "calibrated"));
        if (!calibrated)
            return fail(lost_device_error(fmt::format("Haply Inverse3 {} is not calibrated any more", arm.id),
                                          "an arm that was calibrated in its inkwell"));
    }
    const Json* values = find_member(device, "state");
    HaplyState state;
    BOLT_TRY_ASSIGN(const Vec3 position, read_vector(values, "cursor_position", farthest, "m"));
    BOLT_TRY_ASSIGN(const Vec3 velocity, read_vector(values, "cursor_velocity", fastest, "m/s"));
    state.position = from_haply(position - arm.middle);
    state.velocity = from_haply(velocity);
    if (grip != nullptr) BOLT_TRY(read_grip(json, *grip, state));
    return state;
}

std::optional<std::string> loss_in_haply_event(std::string_view message, const HaplyArmEntry& arm) {
    const Result<Json> json = parse_object(message);
    if (!json) return {};
    const Json* name = find_member(&*json, "name");
    const Json* data = find_member(&*json, "data");
    if (name == nullptr || !concerns(data, arm)) return {};
    if (*name == "device-disconnected") return "was disconnected";
    const Json* cause = find_member(data, "safety_type");
    if (*name != "device-safety-triggered" || cause == nullptr) return {};
    if (*cause == "ebrake_triggered") return "has braked: its emergency brake was triggered";
    if (*cause == "stall_detected") return "has braked: a motor stalled";
    return {};
}

std::optional<bool> is_old_haply_version(std::string_view answer) {
    const Result<Json> json = parse_object(answer);
    if (!json) return {};
    // Some services wrap the answer: {"ok": true, "data": {...}}.
    const Json* data = find_member(&*json, "data");
    const Json* version = find_member(data != nullptr ? data : &*json, "project_version");
    if (version == nullptr || !version->is_string()) return {};
    const auto& text = version->get_ref<const std::string&>();
    const char* const end = text.data() + text.size();
    int major = 0, minor = 0;
    const auto first = std::from_chars(text.data(), end, major);
    if (first.ec != std::errc() || first.ptr == end || *first.ptr != '.') return {};
    if (std::from_chars(first.ptr + 1, end, minor).ec != std::errc()) return {};
    return major < 3 || (major == 3 && minor < 5);
}

std::string haply_force_message(const HaplyArmEntry& arm, const Vec3& force, bool old) {
    const Vec3 v = to_haply(force);
    return fmt::format(
        R"({{"inverse3":[{{"device_id":"{}","commands":{{"set_cursor_force":{{"{}":{{"x":{:.6f},"y":{:.6f},"z":{:.6f}}}}}}}}}]}})",
        arm.id, old ? "values" : "vector", v.x, v.y, v.z);
}

}  // namespace bolt::device
