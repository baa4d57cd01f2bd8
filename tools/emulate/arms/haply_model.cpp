#include "tools/emulate/arms/haply_model.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace bolt::emulate {

namespace {

using Json = nlohmann::json;

constexpr double encoder_step = 10e-6;    // m
constexpr double dt = 25e-6;              // s
constexpr double max_force = 10.0;        // N
constexpr Vec3 middle{0.0, -0.12, 0.15};  // m, of the reach, from the arm's base
constexpr const char* arm_id = "049D";
constexpr const char* grip_id = "61576";

Json to_json(const Vec3& v) { return {{"x", v.x}, {"y", v.y}, {"z", v.z}}; }

}  // namespace

void HaplyArmModel::advance(double seconds) {
    const double end = time_ + seconds;
    for (; time_ + 0.5 * dt < end; time_ += dt) step();
}

void HaplyArmModel::set_fault(HaplyFault fault) {
    fault_ = fault;
    fault_time_.reset();
    const bool gone = fault == HaplyFault::missing || fault == HaplyFault::disconnected ||
                      fault == HaplyFault::brake || fault == HaplyFault::stall;
    renders_ = !gone;
    if (gone) force_until_ = std::min(force_until_, time_);
    switch (fault) {
        case HaplyFault::disconnected:
            return add_event("device-disconnected", nullptr);
        case HaplyFault::brake:
            return add_event("device-safety-triggered", "ebrake_triggered");
        case HaplyFault::stall:
            return add_event("device-safety-triggered", "stall_detected");
        default:
            return;
    }
}

std::string HaplyArmModel::inventory() const { return devices(true).dump(); }

std::optional<std::string> HaplyArmModel::answer(const std::string& message) {
    if (command(message)) {
        ++commands;
    } else {
        ++rejected;
    }
    if (fault_ == HaplyFault::none) return devices(false).dump();
    if (!fault_time_) fault_time_ = time_;
    switch (fault_) {
        case HaplyFault::close:
            return {};
        case HaplyFault::silence:
            return "";
        case HaplyFault::nonsense:
            return R"({"inverse3":[{"device_id":"049D","state":{"cursor_pos)";
        case HaplyFault::array:
            return "[1, 2, 3]";
        case HaplyFault::huge:
            return devices(false).dump() + std::string(200'000, ' ');
        case HaplyFault::overflow:
            return R"({"inverse3":[{"device_id":"049D","state":{"cursor_position":{"x":1e999,"y":0,"z":0}}}]})";
        default:
            return devices(false).dump();
    }
}

void HaplyArmModel::step() {
    const Vec3 spring = options_.stiffness * (intention - position_);
    // Implicit in the friction.
    velocity_ = (velocity_ + dt / options_.mass * (spring + force())) /
                (1.0 + dt / options_.mass * options_.viscous_friction);
    position_ += dt * velocity_;
}

void HaplyArmModel::add_event(const char* name, const char* safety_type) {
    Json data{{"device_family", "inverse"}, {"device_id", arm_id}};
    if (safety_type != nullptr) data["safety_type"] = safety_type;
    events.push_back(
        Json{{"name", name}, {"category", "device"}, {"level", "warning"}, {"data", data}}.dump());
    fault_time_ = time_;
}

bool HaplyArmModel::is_before_3_5() const {
    return !options_.version.empty() && std::strtod(options_.version.c_str(), nullptr) < 3.5;
}

bool HaplyArmModel::command(const std::string& message) {
    const Json json = Json::parse(message, nullptr, false);
    const Json::json_pointer at(std::string("/inverse3/0/commands/set_cursor_force/") +
                                (is_before_3_5() ? "values" : "vector"));
    const Json::json_pointer id("/inverse3/0/device_id");
    if (!json.is_object() || !json.contains(at) || !json.contains(id) || json[id] != arm_id) return false;
    Vec3 force{json[at].value("x", NAN), json[at].value("y", NAN), json[at].value("z", NAN)};
    if (!finite(force)) return false;
    if (const double length = glm::length(force); length > max_force) force *= max_force / length;
    if (!renders_) return true;
    force_ = force;
    force_until_ = force == Vec3(0.0) ? std::min(force_until_, time_) : time_ + options_.command_lifetime;
    return true;
}

Json HaplyArmModel::position_json() const {
    const Vec3 from_origin = options_.centred ? position_ : position_ + middle;
    Json json = to_json(encoder_step * glm::round(from_origin / encoder_step));
    if (fault_ == HaplyFault::millimetres) json = to_json(1000.0 * from_origin);
    if (fault_ == HaplyFault::null_position) json["y"] = nullptr;  // as a service writes NaN
    if (fault_ == HaplyFault::text_position) json["z"] = "0.1";
    return json;
}

Json HaplyArmModel::arm_json(bool with_config) const {
    Json arm{{"device_id", arm_id}};
    if (with_config) {
        arm["config"] = {{"preset", options_.centred ? "arm_front_centered" : "defaults"},
                         {"basis", {{"permutation", options_.basis}}},
                         {"handedness", "right"}};
        if (!options_.type.empty()) arm["config"]["type"] = options_.type;
    }
    arm["state"] = {{"cursor_velocity", to_json(velocity_)}, {"current_cursor_force", to_json(force())}};
    if (fault_ != HaplyFault::no_position) arm["state"]["cursor_position"] = position_json();
    arm["status"] = {{"calibrated", options_.calibrated && fault_ != HaplyFault::uncalibrated}};
    return arm;
}

Json HaplyArmModel::grip_json() const {
    const double length = fault_ == HaplyFault::turn ? 0.5 : 1.0;
    const Quat q = orientation * length;
    Json state{{"orientation", {{"w", q.w}, {"x", q.x}, {"y", q.y}, {"z", q.z}}}};
    const auto pressed = [&](unsigned bit) { return (buttons >> bit & 1U) != 0; };
    if (options_.grip == HaplyGrip::wired) {
        state["button"] = pressed(0);
    } else {
        state["buttons"] = {{"a", pressed(0)}, {"b", pressed(1)}, {"c", pressed(2)}};
    }
    return {{"device_id", grip_id}, {"state", state}, {"status", Json::object()}};
}

Json HaplyArmModel::devices(bool with_config) const {
    Json message{{"session_id", 1}, {"inverse3", Json::array()}};
    if (options_.arm && fault_ != HaplyFault::missing) message["inverse3"].push_back(arm_json(with_config));
    message["verse_grip"] = Json::array();
    message["wireless_verse_grip"] = Json::array();
    if (options_.grip == HaplyGrip::wired) message["verse_grip"].push_back(grip_json());
    if (options_.grip == HaplyGrip::wireless) message["wireless_verse_grip"].push_back(grip_json());
    return message;
}

}  // namespace bolt::emulate
