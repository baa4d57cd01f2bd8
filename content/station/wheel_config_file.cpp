#include "content/station/wheel_config_file.hpp"

#include "content/format/members.hpp"
#include "engine/base/file.hpp"

namespace bolt::content {
namespace {

using nlohmann::json;

constexpr const char* format_name = "boltwright rig 1";
constexpr std::size_t longest_file = 1U << 16U;
constexpr double finest_encoder = 1U << 24U;  // counts a turn

}  // namespace

Result<device::WheelConfig> parse_wheel_config(std::string_view text, const std::string& file) {
    std::vector<Error> errors;
    const auto document = JsonDocument::parse(text, file, errors);
    if (!errors.empty()) return fail(errors.front());
    Members members{*document, {}};
    const json& root = document->root();
    if (!root.is_object()) {
        members.report("", Part::value, "this says nothing of a rig", "expected a JSON object");
        return fail(*members.wrong);
    }
    if (members.text(root, "format") != format_name)
        members.report("/format", Part::value, "this is no rig that is known here",
                       fmt::format("expected \"format\": \"{}\"", format_name));
    members.only(root, "",
                 {"format", "full_torque_Nm", "most_torque_Nm", "counts_per_turn", "range_deg", "reversed"});
    device::WheelConfig rig;
    const auto number = [&](const char* key, double low, double high, double& to) {
        if (root.contains(key)) to = members.number(root, "", key, low, high);
    };
    number("full_torque_Nm", 0.1, max_configurable_torque, rig.full_torque);
    number("most_torque_Nm", 0.0, max_configurable_torque, rig.max_torque);
    number("counts_per_turn", 0.0, finest_encoder, rig.counts_per_turn);
    double degrees = to_degrees(rig.range);
    number("range_deg", 10.0, 65535.0, degrees);
    rig.range = to_radians(degrees);
    if (root.contains("reversed")) rig.reversed = members.flag(root, "reversed");
    if (members.wrong) return fail(*members.wrong);
    return rig;
}

Result<device::WheelConfig> load_wheel_config(const std::filesystem::path& path) {
    BOLT_TRY_ASSIGN(const auto text, read_file(path, longest_file, ErrorCode::bad_content));
    return parse_wheel_config(text, path.string());
}

}  // namespace bolt::content
