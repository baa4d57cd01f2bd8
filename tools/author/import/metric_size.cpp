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

// Cap screws with a low head: height of the head and width of the socket, m.
struct LowHead {
    const char* size;
    double height, across_flats;
};
constexpr std::array din_7984 = {LowHead{"M5", 3.5 * mm, 3 * mm},  LowHead{"M6", 4 * mm, 4 * mm},
                                 LowHead{"M8", 5 * mm, 5 * mm},    LowHead{"M10", 6 * mm, 7 * mm},
                                 LowHead{"M12", 7 * mm, 8 * mm},   LowHead{"M16", 9 * mm, 12 * mm},
                                 LowHead{"M20", 11 * mm, 14 * mm}, LowHead{"M24", 13 * mm, 17 * mm}};

// Tolerances of a cap screw in CAD, which may be drawn with its largest or its least dimensions.
constexpr double socket_slack = 0.3 * mm;       // width across flats
constexpr double socket_undersize = 0.02 * mm;  // the key must still enter
constexpr double head_width_slack = 0.6 * mm;   // with or without knurling
constexpr double head_height_slack = 0.5 * mm;
constexpr double socket_depth_slack = 0.3 * mm;

std::string inch_text(double diameter) {
    for (const auto& [inches, name] : inch_diameters)
        if (std::abs(diameter - inches * 25.4 * mm) < 0.02 * mm)
            return fmt::format(" ({:.2f} mm is the inch thread {} in, which the joint laws do not cover)",
                               diameter / mm, name);
    return {};
}

}  // namespace

const joint::FastenerSize* size_of_thread(double diameter) {
    const joint::FastenerSize& size = nearest_size(diameter);
    return std::abs(size.d - diameter) > diameter_slack(size) ? nullptr : &size;
}

const joint::FastenerSize* size_of(double diameter, double across_flats) {
    const joint::FastenerSize* const found = size_of_thread(diameter);
    if (found == nullptr) return nullptr;
    const joint::FastenerSize& size = *found;
    const auto fits = [&](double flats) { return std::abs(across_flats - flats) < width_tolerance; };
    return fits(size.across_flats) || fits(din_across_flats(size)) ? &size : nullptr;
}

std::string explain_size(double diameter) {
    const joint::FastenerSize& size = nearest_size(diameter);
    const double din = din_across_flats(size);
    const std::string widths = din == size.across_flats
                                   ? fmt::format("{:g} mm", size.across_flats / mm)
                                   : fmt::format("{:g} or {:g} mm", size.across_flats / mm, din / mm);
    return fmt::format(
               "no metric size has both; expected {} with a cylinder {:.2f} to {:.2f} mm wide and a "
               "hexagon {} across flats",
               size.name, (size.d - diameter_slack(size)) / mm, (size.d + diameter_slack(size)) / mm,
               widths) +
           inch_text(diameter);
}

const joint::FastenerSize* size_of(double diameter, double across_flats, const CapHead& head) {
    const joint::FastenerSize& size = nearest_size(diameter);
    const joint::SocketHead* const standard = joint::socket_head(size.name);
    if (standard == nullptr || std::abs(size.d - diameter) > diameter_slack(size)) return nullptr;
    const bool fits = across_flats > standard->across_flats - socket_undersize &&
                      across_flats < standard->across_flats + socket_slack &&
                      std::abs(head.width - standard->diameter) < head_width_slack &&
                      std::abs(head.height - standard->height) < head_height_slack &&
                      head.depth > standard->depth - socket_depth_slack;
    return fits ? &size : nullptr;
}

std::string explain_size(double diameter, double across_flats, const CapHead& head) {
    const joint::FastenerSize& size = nearest_size(diameter);
    const joint::SocketHead* const standard = joint::socket_head(size.name);
    if (standard == nullptr)
        return fmt::format("the table of cap screws has no {}; expected one of M5 to M24 of ISO 4762{}",
                           size.name, inch_text(diameter));
    std::string text = fmt::format(
        "no cap screw of ISO 4762 has all of them; expected {} with a cylinder {:.2f} to {:.2f} mm wide, a "
        "socket of {:g} mm, at least {:g} mm deep, and a head {:g} mm wide and {:g} mm high",
        size.name, (size.d - diameter_slack(size)) / mm, (size.d + diameter_slack(size)) / mm,
        standard->across_flats / mm, standard->depth / mm, standard->diameter / mm, standard->height / mm);
    for (const LowHead& low : din_7984)
        if (size.name == low.size && std::abs(across_flats - low.across_flats) < socket_slack &&
            std::abs(head.height - low.height) < head_height_slack)
            text += " (it has the low head of DIN 7984, which the joint laws do not cover)";
    return text + inch_text(diameter);
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
