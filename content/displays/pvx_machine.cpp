#include "content/displays/pvx_machine.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "content/displays/pvx_values.hpp"
#include "content/format/json_document.hpp"

namespace bolt::content {

namespace {

constexpr std::size_t max_display_name = 200;  // bytes
constexpr double max_corner = 1000.0;          // m

void read_corner(pugi::xml_node node, const char* attribute, double scale, PvxMessages& messages, Vec3& to) {
    const char* text = node.attribute(attribute).as_string();
    const std::vector<std::string_view> parts = split(text, ',');
    bool good = parts.size() == 3;
    for (int i = 0; good && i < 3; ++i) {
        const auto value = finite_number(parts[static_cast<std::size_t>(i)]);
        good = value && std::abs(*value * scale) <= max_corner;
        if (good) to[i] = *value * scale;
    }
    if (good) return;
    if (node.attribute(attribute).empty())
        messages.fail_at(node, nullptr, fmt::format("{} is missing", attribute),
                         "a corner: three numbers, m");
    else
        messages.fail_at(
            node, attribute, fmt::format("{} cannot be {}", attribute, in_quotes(text)),
            fmt::format("three numbers of at most {:g} m; other units need another scale", max_corner));
}

void read_geometry(PvxMachine& machine, PvxMessages& messages) {
    const pugi::xml_attribute attribute = machine.node.attribute("Geometry");
    if (attribute.empty()) {
        messages.warn_at(machine.node, nullptr,
                         "without a Geometry the wall fills a monitor; enter which one");
        return;
    }
    const auto geometry = parse_geometry(attribute.value());
    if (!geometry) {
        messages.fail_at(machine.node, "Geometry",
                         fmt::format("Geometry cannot be {}", in_quotes(attribute.value())),
                         "width x height + x + y in pixels, such as 1920x1080+0+0");
        return;
    }
    machine.wall.output.position = geometry->first;
    machine.wall.output.resolution = geometry->second;
}

void read_environment(PvxMachine& machine, PvxMessages& messages) {
    constexpr std::string_view display = "DISPLAY=";
    for (const std::string_view part : split(machine.node.attribute("Environment").as_string(), ';')) {
        const std::string_view value = part.starts_with(display) ? part.substr(display.size()) : "";
        if (!value.empty() && value.size() <= max_display_name)
            machine.wall.output.display = value;
        else
            messages.warn_at(machine.node, "Environment",
                             fmt::format("{} of Environment is left out", in_quotes(part)));
    }
}

// Warns of attributes that a display file cannot express, unless their value has no effect.
void report_left_out(pugi::xml_node node, PvxMessages& messages) {
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
            messages.warn_at(node, attribute.name(),
                             fmt::format("the attribute {} is not known and left out", in_quotes(name)));
        else if (rule->natural != nullptr && attribute.value() != std::string_view(rule->natural))
            messages.warn_at(
                node, attribute.name(),
                fmt::format("{} {} is left out: {}", name, in_quotes(attribute.value()), rule->why));
    }
}

}  // namespace

PvxMachine read_pvx_machine(pugi::xml_node node, double scale, PvxMessages& messages) {
    PvxMachine machine;
    machine.node = node;
    machine.host = node.attribute("Name").as_string();
    machine.stereo = node.attribute("StereoType").as_string();
    read_corner(node, "LowerLeft", scale, messages, machine.wall.lower_left);
    read_corner(node, "LowerRight", scale, messages, machine.wall.lower_right);
    read_corner(node, "UpperRight", scale, messages, machine.wall.upper_right);
    read_geometry(machine, messages);
    read_environment(machine, messages);
    report_left_out(node, messages);
    return machine;
}

}  // namespace bolt::content
