#include "content/station/wheel_config_file.hpp"

#include "content/format/json_members.hpp"
#include "engine/base/file.hpp"

namespace bolt::content {
namespace {

using nlohmann::json;

constexpr const char* format_name = "boltwright rig 1";
constexpr std::size_t max_file_size = 1U << 16U;
constexpr double max_counts_per_turn = 1U << 24U;

}  // namespace

Result<device::WheelConfig> parse_wheel_config(std::string_view text, const std::string& file) {
    std::vector<Error> errors;
    const auto document = JsonDocument::parse(text, file, errors);
    if (!errors.empty()) return fail(errors.front());
    MemberReader members{*document, {}};
    const json& root = document->root();
    if (!root.is_object()) {
        members.report("", JsonPart::value, "the wheel configuration is not an object", "a JSON object");
        return fail(*members.first_error);
    }
    if (members.text(root, "format") != format_name)
        members.report("/format", JsonPart::value, "the format of the wheel configuration is unknown",
                       fmt::format("\"format\": \"{}\"", format_name));
    members.check_known(
        root, "", {"format", "full_torque_Nm", "most_torque_Nm", "counts_per_turn", "range_deg", "reversed"});
    device::WheelConfig config;
    const auto number = [&](const char* key, double low, double high, double& to) {
        if (root.contains(key)) to = members.number(root, "", key, low, high);
    };
    number("full_torque_Nm", 0.1, max_configurable_torque, config.full_torque);
    number("most_torque_Nm", 0.0, max_configurable_torque, config.max_torque);
    number("counts_per_turn", 0.0, max_counts_per_turn, config.counts_per_turn);
    double degrees = to_degrees(config.range);
    number("range_deg", 10.0, 65535.0, degrees);
    config.range = to_radians(degrees);
    if (root.contains("reversed")) config.reversed = members.flag(root, "reversed");
    if (members.first_error) return fail(*members.first_error);
    return config;
}

Result<device::WheelConfig> load_wheel_config(const std::filesystem::path& path) {
    BOLT_TRY_ASSIGN(const auto text, read_file(path, max_file_size, ErrorCode::bad_content));
    return parse_wheel_config(text, path.string());
}

}  // namespace bolt::content
