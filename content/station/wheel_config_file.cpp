#include "content/station/wheel_config_file.hpp"

#include <limits>

#include "content/format/json_members.hpp"
#include "engine/base/file.hpp"

namespace bolt::content {
namespace {

using nlohmann::json;

constexpr const char* wheel_config_format = "boltwright rig 1";  // rig: older name of the configuration
constexpr std::size_t max_wheel_config_size = 1U << 16U;
constexpr double max_counts_per_turn = 1U << 24U;

}  // namespace

const std::vector<std::string>& wheel_config_members() {
    static const std::vector<std::string> names{"full_torque_Nm", "most_torque_Nm", "counts_per_turn",
                                                "range_deg", "reversed"};
    return names;
}

void read_wheel_config(MemberReader& members, const json& object, const std::string& at,
                       device::WheelConfig& config) {
    const auto number = [&](const char* key, double low, double high, double& to) {
        if (object.contains(key)) to = members.number(object, at, key, low, high);
    };
    number("full_torque_Nm", 0.1, max_configurable_torque, config.full_torque);
    number("most_torque_Nm", 0.0, max_configurable_torque, config.max_torque);
    number("counts_per_turn", 0.0, max_counts_per_turn, config.counts_per_turn);
    if (object.contains("range_deg"))
        config.range = to_radians(members.number(object, at, "range_deg", 10.0, 65535.0));
    if (object.contains("reversed")) config.reversed = members.flag(object, at, "reversed");
}

void write_wheel_config(nlohmann::ordered_json& object, const device::WheelConfig& config) {
    object["full_torque_Nm"] = config.full_torque;
    object["most_torque_Nm"] = config.max_torque;
    object["counts_per_turn"] = config.counts_per_turn;
    object["range_deg"] = exact_degrees(config.range);
    object["reversed"] = config.reversed;
}

double exact_degrees(double angle) {
    const double nearest = to_degrees(angle);
    const double short_form = std::round(nearest * 1e6) / 1e6;  // as a person writes it
    if (to_radians(short_form) == angle) return short_form;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double less = nearest, more = nearest;
    for (int i = 0; i < 8; ++i) {
        if (to_radians(less) == angle) return less;
        if (to_radians(more) == angle) return more;
        less = std::nextafter(less, -infinity);
        more = std::nextafter(more, infinity);
    }
    return nearest;
}

Result<device::WheelConfig> parse_wheel_config(std::string_view text, const std::string& file) {
    const FileHead head{"wheel configuration", wheel_config_format, wheel_config_members()};
    return parse_small_file(text, file, head, [](MemberReader& members, const json& root) {
        device::WheelConfig config;
        read_wheel_config(members, root, "", config);
        return config;
    });
}

Result<device::WheelConfig> load_wheel_config(const std::filesystem::path& path) {
    BOLT_TRY_ASSIGN(const auto text, read_file(path, max_wheel_config_size, ErrorCode::bad_content));
    return parse_wheel_config(text, path.string());
}

}  // namespace bolt::content
