#include "tools/author/import/metric_size.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace bolt::step_import {

namespace {

const joint::FastenerSize& nearest_size(double diameter) {
    const auto& sizes = joint::fastener_sizes();
    return *std::min_element(sizes.begin(), sizes.end(),
                             [&](const joint::FastenerSize& a, const joint::FastenerSize& b) {
                                 return std::abs(a.d - diameter) < std::abs(b.d - diameter);
                             });
}

double diameter_slack(const joint::FastenerSize& size) { return std::max(0.35 * mm, 0.04 * size.d); }

// Width across flats by DIN 931 and 934, which differs from ISO 272 for four sizes.
double din_across_flats(const joint::FastenerSize& size) {
    if (size.name == "M10") return 17.0 * mm;
    if (size.name == "M12") return 19.0 * mm;
    if (size.name == "M14") return 22.0 * mm;
    if (size.name == "M22") return 32.0 * mm;
    return size.across_flats;
}

// Nominal diameters of unified inch threads (ASME B1.1).
constexpr std::array inch_diameters = {
    std::pair{0.25, "1/4"},    std::pair{0.3125, "5/16"}, std::pair{0.375, "3/8"},
    std::pair{0.4375, "7/16"}, std::pair{0.5, "1/2"},     std::pair{0.5625, "9/16"},
    std::pair{0.625, "5/8"},   std::pair{0.75, "3/4"},    std::pair{0.875, "7/8"},
    std::pair{1.0, "1"},       std::pair{1.125, "1 1/8"}, std::pair{1.25, "1 1/4"},
    std::pair{1.375, "1 3/8"}, std::pair{1.5, "1 1/2"}};

}  // namespace

const joint::FastenerSize* size_of(double diameter, double across_flats) {
    const joint::FastenerSize& size = nearest_size(diameter);
    if (std::abs(size.d - diameter) > diameter_slack(size)) return nullptr;
    const auto fits = [&](double flats) { return std::abs(across_flats - flats) < flats_slack; };
    return fits(size.across_flats) || fits(din_across_flats(size)) ? &size : nullptr;
}

std::string explain_size(double diameter) {
    const joint::FastenerSize& size = nearest_size(diameter);
    const double din = din_across_flats(size);
    const std::string widths = din == size.across_flats
                                   ? fmt::format("{:g} mm", size.across_flats / mm)
                                   : fmt::format("{:g} or {:g} mm", size.across_flats / mm, din / mm);
    std::string text = fmt::format(
        "no metric size has both; expected {} with a cylinder {:.2f} to {:.2f} mm wide and a hexagon {} "
        "across flats",
        size.name, (size.d - diameter_slack(size)) / mm, (size.d + diameter_slack(size)) / mm, widths);
    for (const auto& [inches, name] : inch_diameters)
        if (std::abs(diameter - inches * 25.4 * mm) < 0.02 * mm)
            text += fmt::format(" ({:.2f} mm is the inch thread {} in, which the joint laws do not cover)",
                                diameter / mm, name);
    return text;
}

std::string thread_name(const joint::FastenerSize& size, double hole) {
    const auto off = [&](double pitch) { return std::abs(size.d - 1.0825 * pitch - hole); };
    double best = size.coarse_pitch;
    for (const double fine : size.fine_pitches)
        if (fine > 0.0 && off(fine) < 0.1 * mm && off(fine) + 0.1 * mm < off(best)) best = fine;
    return best == size.coarse_pitch ? std::string(size.name)
                                     : fmt::format("{}x{:g}", size.name, std::round(best / mm * 1e3) / 1e3);
}

}  // namespace bolt::step_import
