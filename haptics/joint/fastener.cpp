#include "haptics/joint/fastener.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "engine/base/nearest.hpp"

namespace bolt::joint {

namespace {

constexpr double MPa = 1e6;

constexpr FastenerSize row(std::string_view name, double d, double coarse, double fine1, double fine2,
                           double fine3, double s, double k, double dw_head, double m, double dw_nut,
                           double w1, double w2, double wh, double hole) {
    return {name,        d * mm,  coarse * mm,  {fine1 * mm, fine2 * mm, fine3 * mm},
            s * mm,      k * mm,  dw_head * mm, m * mm,
            dw_nut * mm, w1 * mm, w2 * mm,      wh * mm,
            hole * mm};
}

// clang-format off
constexpr FastenerSize sizes[] = {
    //   size   d   P     fine pitches      s   k     d_w head m     d_w nut washer 7089   hole
    row("M4",   4, 0.70,  0.5,  0,    0,    7,  2.8,  5.88,  3.2,   5.9,   4.3,  9,  0.8,  4.5),
    row("M5",   5, 0.80,  0.5,  0,    0,    8,  3.5,  6.88,  4.7,   6.9,   5.3, 10,  1.0,  5.5),
    row("M6",   6, 1.00,  0.75, 0,    0,   10,  4.0,  8.88,  5.2,   8.9,   6.4, 12,  1.6,  6.6),
    row("M8",   8, 1.25,  1.0,  0.75, 0,   13,  5.3, 11.63,  6.8,  11.6,   8.4, 16,  1.6,  9.0),
    row("M10", 10, 1.50,  1.25, 1.0,  0,   16,  6.4, 14.63,  8.4,  14.6,  10.5, 20,  2.0, 11.0),
    row("M12", 12, 1.75,  1.5,  1.25, 1.0, 18,  7.5, 16.63, 10.8,  16.6,  13.0, 24,  2.5, 13.5),
    row("M14", 14, 2.00,  1.5,  1.25, 1.0, 21,  8.8, 19.64, 12.8,  19.6,  15.0, 28,  2.5, 15.5),
    row("M16", 16, 2.00,  1.5,  1.0,  0,   24, 10.0, 22.49, 14.8,  22.5,  17.0, 30,  3.0, 17.5),
    row("M18", 18, 2.50,  2.0,  1.5,  1.0, 27, 11.5, 25.34, 15.8,  24.9,  19.0, 34,  3.0, 20.0),
    row("M20", 20, 2.50,  2.0,  1.5,  1.0, 30, 12.5, 28.19, 18.0,  27.7,  21.0, 37,  3.0, 22.0),
    row("M22", 22, 2.50,  2.0,  1.5,  1.0, 34, 14.0, 31.71, 19.4,  31.4,  23.0, 39,  3.0, 24.0),
    row("M24", 24, 3.00,  2.0,  1.5,  1.0, 36, 15.0, 33.61, 21.5,  33.3,  25.0, 44,  4.0, 26.0),
    row("M27", 27, 3.00,  2.0,  1.5,  0,   41, 17.0, 38.00, 23.8,  38.0,  28.0, 50,  4.0, 30.0),
    row("M30", 30, 3.50,  2.0,  1.5,  3.0, 46, 18.7, 42.75, 25.6,  42.8,  31.0, 56,  4.0, 33.0),
    row("M33", 33, 3.50,  2.0,  1.5,  3.0, 50, 21.0, 46.55, 28.7,  46.6,  34.0, 60,  5.0, 36.0),
    row("M36", 36, 4.00,  3.0,  2.0,  1.5, 55, 22.5, 51.11, 31.0,  51.1,  37.0, 66,  5.0, 39.0),
    row("M39", 39, 4.00,  3.0,  2.0,  1.5, 60, 25.0, 55.86, 33.4,  55.9,  42.0, 72,  6.0, 42.0),
};

// ISO 4762; M4 is not in our source. Millimetres.
constexpr SocketHead socket_row(std::string_view size, double dk, double k, double s, double t, double dw) {
    return {size, dk * mm, k * mm, s * mm, t * mm, dw * mm};
}

constexpr SocketHead socket_heads[] = {
    //         size   d_k   k     s     t     d_w
    socket_row("M5", 8.5, 5, 4, 2.5, 8.03),   socket_row("M6", 10, 6, 5, 3, 9.38),
    socket_row("M8", 13, 8, 6, 4, 12.33),     socket_row("M10", 16, 10, 8, 5, 15.33),
    socket_row("M12", 18, 12, 10, 6, 17.23),  socket_row("M16", 24, 16, 14, 8, 23.17),
    socket_row("M20", 30, 20, 17, 10, 28.87), socket_row("M24", 36, 24, 19, 12, 34.81),
};

constexpr LockingNut locking_nuts[] = {
    // size, h max (ISO 7040), N·m of ISO 2320: first on at most, first off and fifth off at least
    {"M5", 6.8 * mm, 1.6, 0.29, 0.2},   {"M6", 8.0 * mm, 3.0, 0.45, 0.3},
    {"M8", 9.5 * mm, 6.0, 0.85, 0.6},   {"M10", 11.9 * mm, 10.5, 1.5, 1.0},
    {"M12", 14.9 * mm, 15.5, 2.3, 1.6}, {"M16", 19.1 * mm, 32.0, 4.5, 3.0},
    {"M20", 22.8 * mm, 54.0, 7.5, 5.3}, {"M24", 27.1 * mm, 80.0, 11.5, 8.0},
};

template <class Row, std::size_t count>
const Row* row_of(const Row (&rows)[count], std::string_view size) {
    const Row* const found =
        std::find_if(std::begin(rows), std::end(rows), [&](const Row& row) { return row.size == size; });
    return found == std::end(rows) ? nullptr : found;
}

struct ClassRow {
    std::string_view name;
    double R_p02, R_m;            // MPa, d ≤ 16 mm
    double R_p02_above, R_m_above; // MPa, d > 16 mm
    double proof_ratio;           // S_p / R_p0.2 (or R_eL)
    double fracture_strain;
    bool stainless;
};

constexpr ClassRow classes[] = {
    // ISO 898-1: nominal strengths up to 6.8, minimum strengths from 8.8 on; proof stress ratios of table 3.
    {"4.6",    240,  400,  240,  400, 0.94, 0.22, false},
    {"4.8",    320,  400,  320,  400, 0.91, 0.14, false},
    {"5.6",    300,  500,  300,  500, 0.93, 0.20, false},
    {"5.8",    400,  500,  400,  500, 0.90, 0.10, false},
    {"6.8",    480,  600,  480,  600, 0.92, 0.08, false},
    {"8.8",    640,  800,  660,  830, 0.91, 0.12, false},
    {"10.9",   940, 1040,  940, 1040, 0.88, 0.09, false},
    {"12.9",  1100, 1220, 1100, 1220, 0.88, 0.08, false},
    // ISO 3506-1. It gives no proof stress. Austenitic steel deviates from the elastic line early, so the ratio
    // of 0.8 is our estimate.
    {"A2-50",  210,  500,  210,  500, 0.80, 0.30, true},
    {"A2-70",  450,  700,  450,  700, 0.80, 0.20, true},
    {"A2-80",  600,  800,  600,  800, 0.80, 0.15, true},
    {"A4-50",  210,  500,  210,  500, 0.80, 0.30, true},
    {"A4-70",  450,  700,  450,  700, 0.80, 0.20, true},
    {"A4-80",  600,  800,  600,  800, 0.80, 0.15, true},
};
// clang-format on

std::string pitch_text(double pitch) { return fmt::format("{:g}", std::round(pitch / mm * 1000.0) / 1000.0); }

// The pitches of a size in mm, such as "2, 1.5 or 1". Every size has at least two.
std::string pitches_text(const FastenerSize& size) {
    std::string text = pitch_text(size.coarse_pitch);
    std::string last;
    for (const double p : size.fine_pitches) {
        if (p <= 0.0) continue;
        if (!last.empty()) text += ", " + last;
        last = pitch_text(p);
    }
    return text + " or " + last;
}

tl::unexpected<Error> unknown(std::string what, std::string_view given, const std::vector<std::string>& names,
                              std::string fallback) {
    const std::string best = nearest(given, names);
    return fail(ErrorCode::bad_content, std::move(what),
                best.empty() ? std::move(fallback) : fmt::format("did you mean \"{}\"?", best));
}

}  // namespace

std::span<const FastenerSize> fastener_sizes() { return sizes; }

const SocketHead* socket_head(std::string_view size) { return row_of(socket_heads, size); }
const LockingNut* locking_nut(std::string_view size) { return row_of(locking_nuts, size); }

std::vector<std::string> thread_names() {
    std::vector<std::string> names;
    for (const FastenerSize& size : sizes) names.emplace_back(size.name);
    for (const FastenerSize& size : sizes)
        for (const double pitch : size.fine_pitches)
            if (pitch > 0.0) names.push_back(fmt::format("{}x{}", size.name, pitch_text(pitch)));
    return names;
}

std::string describe_threads() {
    std::vector<std::string_view> names;
    for (const FastenerSize& size : sizes) names.push_back(size.name);
    return fmt::format("one of {}, or a fine thread such as \"M16x1.5\"", fmt::join(names, ", "));
}

Result<ThreadSize> parse_thread(std::string_view text) {
    const std::size_t cross = text.find('x');
    const std::string_view name = text.substr(0, cross);
    for (const FastenerSize& size : sizes) {
        if (size.name != name) continue;
        if (cross == std::string_view::npos)
            return ThreadSize{size, metric_thread(size.d, size.coarse_pitch)};
        const std::string_view digits = text.substr(cross + 1);
        double pitch = 0.0;
        const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), pitch);
        const bool whole = problem == std::errc{} && end == digits.data() + digits.size();
        const auto is = [&](double p) { return p > 0.0 && std::abs(p - pitch * mm) < 1e-9; };
        if (whole && (is(size.coarse_pitch) ||
                      std::any_of(std::begin(size.fine_pitches), std::end(size.fine_pitches), is)))
            return ThreadSize{size, metric_thread(size.d, pitch * mm)};
        return fail(ErrorCode::bad_content, fmt::format("\"{}\" is not a known thread", text),
                    fmt::format("{} with a pitch of {} mm", name, pitches_text(size)));
    }
    return unknown(fmt::format("\"{}\" is not a known thread size", text), text, thread_names(),
                   describe_threads());
}

std::string name(const ThreadSize& thread) {
    const double pitch = thread.thread.pitch;
    if (std::abs(pitch - thread.size.coarse_pitch) < 1e-9) return std::string(thread.size.name);
    return fmt::format("{}x{:.4g}", thread.size.name, pitch / mm);
}

std::vector<std::string> property_class_names() {
    std::vector<std::string> names;
    for (const ClassRow& c : classes) names.emplace_back(c.name);
    return names;
}

Result<PropertyClass> property_class(std::string_view name, double d) {
    for (const ClassRow& c : classes) {
        if (c.name != name) continue;
        const bool above = d > 16.0005 * mm;
        PropertyClass result;
        result.name = std::string(c.name);
        result.R_p02 = (above ? c.R_p02_above : c.R_p02) * MPa;
        result.R_m = (above ? c.R_m_above : c.R_m) * MPa;
        result.proof_ratio = c.proof_ratio;
        result.fracture_strain = c.fracture_strain;
        result.E = c.stainless ? 200e9 : 205e9;
        result.kappa = c.stainless ? 2.0 : 1.5;
        return result;
    }
    return unknown(fmt::format("\"{}\" is not a known property class", name), name, property_class_names(),
                   fmt::format("one of {}", fmt::join(property_class_names(), ", ")));
}

double thread_length(double d, double l) {
    const double b = 2.0 * d + (l <= 125 * mm ? 6 * mm : l <= 200 * mm ? 12 * mm : 25 * mm);
    return std::min(b, l);
}

}  // namespace bolt::joint
