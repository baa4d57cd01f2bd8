#include "haptics/joint/tapped_thread.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "engine/base/nearest.hpp"

namespace bolt::joint {

namespace {

const std::vector<TappedMaterial>& materials() {
    static const std::vector<TappedMaterial> table = {
        {"S235", 210e9, 360e6, 0.80},    {"S355", 210e9, 470e6, 0.80},    {"C45", 210e9, 650e6, 0.65},
        {"GJL-250", 110e9, 250e6, 1.15}, {"GJS-400", 170e9, 400e6, 0.90}, {"A2", 200e9, 500e6, 0.80},
        {"6082-T6", 70e9, 290e6, 0.60},  {"AlSi9Cu3", 75e9, 240e6, 0.52},
    };
    return table;
}

// Carrying area per carrying metre of a thread, m: its shear cylinder has the `diameter`, and `height` is the
// depth of contact there.
double shear_width(double diameter, double pitch, double height) {
    return pi * diameter / pitch * (0.5 * pitch + height * std::tan(thread_half_angle));
}

// C2, for the external thread.
double bending_external(double R_S) {
    if (R_S <= 1.0) return 0.897;
    const double r = std::min(R_S, 2.2);
    return 5.594 + r * (-13.682 + r * (14.107 + r * (-6.057 + r * 0.9353)));
}

// C3, for the internal thread.
double bending_internal(double R_S) {
    if (R_S >= 1.0) return 0.897;
    const double r = std::max(R_S, 0.4);
    return 0.728 + r * (1.769 + r * (-2.896 + r * 1.296));
}

// N per metre of carrying engagement.
StrippingForces stripping_rates(const ScrewThread& thread, const PropertyClass& bolt,
                                const TappedMaterial& part) {
    const double P = thread.pitch, D1 = thread.d - 1.08253 * P;
    const double internal = part.shear_ratio * part.R_m * shear_width(thread.d, P, thread.d - thread.d2);
    const double external = bolt_shear_ratio(bolt) * bolt.R_m * shear_width(D1, P, thread.d2 - D1);
    const double R_S = internal / external;
    return {bending_internal(R_S) * internal, bending_external(R_S) * external};
}

}  // namespace

std::span<const TappedMaterial> tapped_materials() { return materials(); }

Result<TappedMaterial> tapped_material(std::string_view name) {
    std::vector<std::string> names;
    for (const TappedMaterial& material : materials()) {
        if (material.name == name) return material;
        names.push_back(material.name);
    }
    const std::string best = nearest(name, names);
    return fail(ErrorCode::bad_content, fmt::format("\"{}\" is not a known material of a tapped part", name),
                best.empty() ? fmt::format("one of {}", fmt::join(names, ", "))
                             : fmt::format("did you mean \"{}\"?", best));
}

double bolt_shear_ratio(const PropertyClass& bolt) {
    if (bolt.name.starts_with("A")) return 0.80;
    if (bolt.name == "8.8") return 0.65;
    if (bolt.name == "10.9") return 0.62;
    return bolt.name == "12.9" ? 0.60 : 0.70;
}

StrippingForces stripping_forces(const ScrewThread& thread, const PropertyClass& bolt,
                                 const TappedMaterial& part, double engagement) {
    const double carrying = std::max(0.0, engagement - idle_pitches * thread.pitch);
    const StrippingForces rates = stripping_rates(thread, bolt, part);
    return {rates.internal * carrying, rates.external * carrying};
}

double needed_engagement(const ScrewThread& thread, const PropertyClass& bolt, const TappedMaterial& part,
                         double surplus) {
    return surplus * bolt.R_m * thread.A_s / stripping_rates(thread, bolt, part).least() +
           idle_pitches * thread.pitch;
}

}  // namespace bolt::joint
