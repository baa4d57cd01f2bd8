#include "game/tool_models/parameters.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "engine/base/math.hpp"
#include "engine/base/nearest.hpp"

namespace bolt::tool_models {

namespace {

constexpr KindInfo kinds[] = {
    {ModelKind::open_end_wrench, "open_end", "open-end wrench, head at 15°", SizeMeasure::nut},
    {ModelKind::ring_wrench, "ring", "cranked ring wrench, 12 points", SizeMeasure::nut},
    {ModelKind::combination_wrench, "combination", "open end and ring of one size", SizeMeasure::nut},
    {ModelKind::hex_key, "hex_key", "hexagon key, ISO 2936", SizeMeasure::socket_screw},
    {ModelKind::ratchet, "socket", "12-point socket on a ratchet handle", SizeMeasure::nut},
    {ModelKind::extension_bar, "extension_bar", "extension bar between socket and handle",
     SizeMeasure::drive},
    {ModelKind::adaptor, "adaptor", "adaptor from one square drive to another", SizeMeasure::drive},
    {ModelKind::hex_bit, "hex_bit", "hexagon bit in a socket for a square drive", SizeMeasure::socket_screw},
    {ModelKind::click_torque_wrench, "torque_wrench", "click torque wrench with an open-end insert",
     SizeMeasure::nut},
    {ModelKind::electronic_torque_wrench, "electronic_torque_wrench",
     "torque wrench with a display and a light, open-end insert", SizeMeasure::nut},
};

// Widths across flats of the hexagons of ISO 4014 and ISO 4032 from M3 to M39, and further sizes of sets of
// wrenches.
constexpr double nut_sizes[] = {5.5, 7,  8,  9,  10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 21, 22,
                                24,  25, 27, 28, 30, 32, 34, 36, 38, 41, 42, 44, 46, 50, 55, 60};
// ISO 2936, as in the table iso2936def.csv of the Fasteners workbench of FreeCAD.
struct HexKeyRow {
    double size, arm, handle;  // mm
};
constexpr HexKeyRow key_rows[] = {
    {2, 18, 52},   {2.5, 20.5, 58.5}, {3, 23, 66},   {3.5, 25.5, 69.5}, {4, 29, 74},   {4.5, 30.5, 80},
    {5, 33, 85},   {6, 38, 96},       {7, 41, 102},  {8, 44, 108},      {9, 47, 114},  {10, 50, 122},
    {11, 53, 129}, {12, 57, 137},     {13, 63, 145}, {14, 70, 154},     {15, 73, 161}, {16, 76, 168},
    {17, 80, 177}, {18, 84, 188},     {19, 89, 199}, {21, 96, 211},     {22, 102, 222}};
constexpr double key_sizes[] = {2,  2.5, 3,  3.5, 4,  4.5, 5,  6,  7,  8,  9, 10,
                                11, 12,  13, 14,  15, 16,  17, 18, 19, 21, 22};

// Square drives of ISO 1174-1. Torques: catalogues, from memory, so they are estimates.
struct DriveRow {
    double size, torque;  // mm, N·m
};
constexpr DriveRow drive_rows[] = {{6.3, 30}, {10, 135}, {12.5, 340}, {20, 1000}, {25, 2700}};
constexpr double drive_sizes[] = {6.3, 10, 12.5, 20, 25};

// ISO 1711-1 in tables of Gedore's catalogue, N·m.
struct TorqueRow {
    double size, open_end, ring;
};
constexpr TorqueRow torque_rows[] = {
    {10, 31, 58.1}, {13, 64.5, 107}, {16, 115, 175}, {18, 160, 230}, {24, 359, 451}};

bool same(double a, double b) { return std::abs(a - b) < 1e-6; }

// A power law through neighbouring rows: test torques grow as a power of the size.
TestTorque interpolated_torque(double size_mm, double TorqueRow::*column) {
    const std::size_t last = std::size(torque_rows) - 1;
    std::size_t i = 0;
    while (i + 1 < last && size_mm > torque_rows[i + 1].size) ++i;
    const TorqueRow &a = torque_rows[i], &b = torque_rows[i + 1];
    for (const TorqueRow& row : {a, b})
        if (same(row.size, size_mm)) return {row.*column, TorqueSource::tabulated};
    const double exponent = std::log(b.*column / (a.*column)) / std::log(b.size / a.size);
    const double torque = a.*column * std::pow(size_mm / a.size, exponent);
    const bool within = size_mm > torque_rows[0].size && size_mm < torque_rows[last].size;
    return {torque, within ? TorqueSource::interpolated : TorqueSource::estimated};
}

std::string in_mm(double metres) { return fmt::format("{:g}", metres / mm); }

tl::unexpected<Error> usage(std::string what, std::string expected) {
    return fail(ErrorCode::usage, std::move(what), std::move(expected));
}

Status check_size(const ToolParameters& p) {
    const auto sizes = standard_sizes(measure_of(p));
    const double size = p.size / mm, low = sizes.front(), high = sizes.back();
    const bool is_drive = measure_of(p) == SizeMeasure::drive;
    const auto near = std::min_element(sizes.begin(), sizes.end(), [&](double a, double b) {
        return std::abs(a - size) < std::abs(b - size);
    });
    if (!std::isfinite(size) || size < low - 1e-6 || size > high + 1e-6)
        return usage(fmt::format("{} of {:g} mm: the size is out of range", info_of(p.kind).name, size),
                     fmt::format("{:g} to {:g} mm; the nearest is {:g}", low, high, *near));
    if (is_drive && !same(*near, size))
        return usage(fmt::format("{} of {:g} mm: there is no such square drive", info_of(p.kind).name, size),
                     fmt::format("{:g} mm, the nearest of {}", *near, fmt::join(sizes, ", ")));
    return {};
}

double standard_drive(const ToolParameters& p) {
    const double s = p.size / mm;
    switch (p.kind) {
        case ModelKind::adaptor:  // to the next greater drive; from the greatest, to the next smaller
            for (const double drive : drive_sizes)
                if (drive > s + 1e-6) return drive * mm;
            return drive_sizes[3] * mm;
        case ModelKind::extension_bar:
            return 0.0;
        default:
            return measure_of(p) == SizeMeasure::nut ? (s <= 13.0   ? 10.0
                                                        : s <= 32.0 ? 12.5
                                                                    : 20.0) *
                                                           mm
                                                     : (s <= 5.0    ? 10.0
                                                        : s <= 17.0 ? 12.5
                                                                    : 20.0) *
                                                           mm;
    }
}

// Lengths follow common tools and no standard, except those of keys. m.
double standard_length(const ToolParameters& p) {
    const double s = p.size;
    switch (p.kind) {
        case ModelKind::open_end_wrench:
        case ModelKind::ring_wrench:
            return std::round((8.2 * s + 83.0 * mm) / (5.0 * mm)) * 5.0 * mm;
        case ModelKind::combination_wrench:
            return std::round((9.5 * s + 55.0 * mm) / (5.0 * mm)) * 5.0 * mm;
        case ModelKind::hex_key:
            return key_arms(s).handle;
        case ModelKind::ratchet:
            return (p.drive < 11.0 * mm ? 200.0 : p.drive < 15.0 * mm ? 270.0 : 500.0) * mm;
        case ModelKind::extension_bar:
            return 10.0 * s;
        case ModelKind::adaptor:
            return 0.9 * s + 1.6 * p.drive;
        case ModelKind::hex_bit:
            return 55.0 * mm;
        default:
            return std::max(8.2 * s + 290.0 * mm, 380.0 * mm) + p.adaptor_length;
    }
}

bool has_open_end(const ToolParameters& p) {
    return p.kind == ModelKind::open_end_wrench || p.kind == ModelKind::combination_wrench ||
           (is_torque_wrench(p.kind) && !has_ratchet(p));
}

bool has_drive(const ToolParameters& p) {
    return has_ratchet(p) || p.kind == ModelKind::adaptor || p.kind == ModelKind::hex_bit;
}

Status check_head(const ToolParameters& p) {
    const std::string_view name = info_of(p.kind).name;
    if (p.head != ModelHead::standard && p.kind != ModelKind::ratchet && !is_torque_wrench(p.kind))
        return usage(fmt::format("{} has one head of its own", name), "no choice of heads");
    if (p.head == ModelHead::open_end && p.kind == ModelKind::ratchet)
        return usage("a ratchet does not turn an open end", "socket or hex_bit");
    if (p.extension != 0.0 && !has_ratchet(p))
        return usage(fmt::format("{} has no square drive for an extension bar", name),
                     "a socket or a bit on a ratchet");
    if (p.extension != 0.0 && !(p.extension > 39.9 * mm && p.extension < 600.1 * mm))
        return usage(fmt::format("an extension bar of {} mm is impossible", in_mm(p.extension)),
                     "40 to 600 mm");
    if (p.adaptor_length != 0.0 && (!is_torque_wrench(p.kind) || has_ratchet(p)))
        return usage(fmt::format("{} takes no adaptor that lengthens it", name),
                     "a torque wrench with an open end");
    if (p.adaptor_length != 0.0 && !(p.adaptor_length > 19.9 * mm && p.adaptor_length < 300.1 * mm))
        return usage(fmt::format("an adaptor of {} mm is impossible", in_mm(p.adaptor_length)),
                     "20 to 300 mm");
    return {};
}

Status check_options(const ToolParameters& p) {
    const std::string_view name = info_of(p.kind).name;
    BOLT_TRY(check_head(p));
    if (p.teeth != 0 && !has_ratchet(p))
        return usage(fmt::format("{} has no ratchet, so it has no teeth", name), "no number of teeth");
    if (p.teeth != 0 && std::find(ratchet_teeth.begin(), ratchet_teeth.end(), p.teeth) == ratchet_teeth.end())
        return usage(fmt::format("a ratchet of {} teeth is unknown", p.teeth),
                     fmt::format("{}", fmt::join(ratchet_teeth, ", ")));
    if (p.drive == 0.0) return {};
    if (!has_drive(p)) return usage(fmt::format("{} has no square drive beside its size", name), "no drive");
    for (const double drive : drive_sizes)
        if (same(drive, p.drive / mm)) {
            if (p.kind == ModelKind::adaptor && same(p.drive, p.size))
                return usage(fmt::format("an adaptor from {} mm to the same drive", in_mm(p.drive)),
                             "another drive");
            return {};
        }
    return usage(fmt::format("there is no square drive of {} mm", in_mm(p.drive)),
                 fmt::format("{} mm", fmt::join(drive_sizes, ", ")));
}

}  // namespace

bool is_torque_wrench(ModelKind kind) {
    return kind == ModelKind::click_torque_wrench || kind == ModelKind::electronic_torque_wrench;
}

double shortest_length(const ToolParameters& p) {
    switch (p.kind) {
        case ModelKind::hex_key:
            return 4.0 * p.size;
        case ModelKind::extension_bar:
            return 3.5 * p.size;
        case ModelKind::adaptor:
            return 0.5 * p.size + 1.2 * p.drive;
        case ModelKind::hex_bit:
            return 1.6 * p.drive + 0.6 * p.size;
        case ModelKind::ratchet:
            return 8.0 * p.drive;
        case ModelKind::combination_wrench:
            return 5.2 * p.size + 30.0 * mm;
        case ModelKind::click_torque_wrench:
        case ModelKind::electronic_torque_wrench:
            return has_ratchet(p) ? 8.0 * p.drive + 150.0 * mm : 3.0 * p.size + 130.0 * mm + p.adaptor_length;
        default:
            return 3.8 * p.size + 30.0 * mm;
    }
}

std::span<const KindInfo> model_kinds() { return kinds; }

const KindInfo& info_of(ModelKind kind) { return kinds[static_cast<std::size_t>(kind)]; }

bool has_ratchet(const ToolParameters& p) {
    return p.kind == ModelKind::ratchet ||
           (is_torque_wrench(p.kind) && (p.head == ModelHead::socket || p.head == ModelHead::hex_bit));
}

SizeMeasure measure_of(const ToolParameters& p) {
    return has_ratchet(p) && p.head == ModelHead::hex_bit ? SizeMeasure::socket_screw
                                                          : info_of(p.kind).measure;
}

Result<ModelKind> kind_named(std::string_view name) {
    std::vector<std::string> names;
    for (const KindInfo& info : kinds) {
        if (info.name == name) return info.kind;
        names.emplace_back(info.name);
    }
    const std::string near = nearest(name, names);
    return usage(
        fmt::format("there is no tool of the kind \"{}\"", name),
        near.empty() ? fmt::format("{}", fmt::join(names, ", ")) : fmt::format("did you mean \"{}\"?", near));
}

std::span<const double> standard_sizes(SizeMeasure measure) {
    switch (measure) {
        case SizeMeasure::socket_screw:
            return key_sizes;
        case SizeMeasure::drive:
            return drive_sizes;
        default:
            return nut_sizes;
    }
}

KeyArms key_arms(double size) {
    const double s = size / mm;
    std::size_t i = 0;
    while (i + 2 < std::size(key_rows) && s > key_rows[i + 1].size) ++i;
    const HexKeyRow &a = key_rows[i], &b = key_rows[i + 1];
    const double part = (s - a.size) / (b.size - a.size);
    return {(a.arm + part * (b.arm - a.arm)) * mm, (a.handle + part * (b.handle - a.handle)) * mm,
            same(s, a.size) || same(s, b.size)};
}

TestTorque test_torque(ModelKind kind, double size) {
    const double s = size / mm;
    switch (kind) {
        case ModelKind::ring_wrench:
        case ModelKind::ratchet:
            return interpolated_torque(s, &TorqueRow::ring);
        case ModelKind::extension_bar:
        case ModelKind::adaptor:
            for (const DriveRow& row : drive_rows)
                if (same(row.size, s)) return {row.torque, TorqueSource::estimated};
            return {};
        case ModelKind::hex_key:
        case ModelKind::hex_bit:
            return {};  // we have no table of ISO 2936 or ISO 2351
        default: {
            // Beyond the table the power law of open ends exceeds that of rings, which is impossible.
            TestTorque torque = interpolated_torque(s, &TorqueRow::open_end);
            torque.torque = std::min(torque.torque, interpolated_torque(s, &TorqueRow::ring).torque);
            return torque;
        }
    }
}

Result<ToolParameters> completed(ToolParameters p) {
    BOLT_TRY(check_size(p));
    BOLT_TRY(check_options(p));
    const bool outside = measure_of(p) == SizeMeasure::nut;
    if (p.opening == 0.0) p.opening = outside ? p.size + standard_play : p.size;
    if (has_drive(p) && p.drive == 0.0) p.drive = standard_drive(p);
    if (has_ratchet(p) && p.teeth == 0) p.teeth = ratchet_teeth[1];
    if (has_open_end(p) && !p.head_angle) p.head_angle = is_torque_wrench(p.kind) ? 0.0 : to_radians(15.0);
    if (p.length == 0.0) p.length = standard_length(p);
    const double shortest = shortest_length(p);
    if (!(p.length >= shortest - 1e-9 && p.length <= longest_tool))
        return usage(fmt::format("{} of {} mm: a length of {} mm is impossible", info_of(p.kind).name,
                                 in_mm(p.size), in_mm(p.length)),
                     fmt::format("{:.0f} to {:.0f} mm", std::ceil(shortest / mm), longest_tool / mm));
    return p;
}

std::string description(const ToolParameters& p) {
    std::string text = fmt::format("{}: size {} mm, opening {} mm, length {} mm", info_of(p.kind).name,
                                   in_mm(p.size), in_mm(p.opening), in_mm(p.length));
    if (p.head_angle) text += fmt::format(", head at {:g} degrees", to_degrees(*p.head_angle));
    const auto add = [&](const char* name, double value) {
        if (value > 0.0) text += fmt::format(", {} {} mm", name, in_mm(value));
    };
    add("drive", p.drive);
    add("head", p.head_thickness);
    add("jaw depth", p.jaw_depth);
    add("jaw tip", p.jaw_tip);
    if (p.teeth > 0) text += fmt::format(", {} teeth", p.teeth);
    if (p.head == ModelHead::socket) text += ", socket";
    if (p.head == ModelHead::hex_bit) text += ", hexagon bit";
    add("extension bar", p.extension);
    add("adaptor in line", p.adaptor_length);
    return text;
}

}  // namespace bolt::tool_models
