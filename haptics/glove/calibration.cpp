#include "haptics/glove/calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/base/math.hpp"

namespace bolt::glove {

namespace {

constexpr double least_span = 5.0;  // counts: less is no measurement of anything
constexpr std::array<const char*, poses> pose_names = {"flat hand", "fist", "spread hand", "thumb across"};

bool is_mpj(Sensor s) {
    return s == Sensor::index_mpj || s == Sensor::middle_mpj || s == Sensor::ring_mpj ||
           s == Sensor::little_mpj;
}
bool is_pij(Sensor s) {
    return s == Sensor::index_pij || s == Sensor::middle_pij || s == Sensor::ring_pij ||
           s == Sensor::little_pij;
}
bool is_dij(Sensor s) {
    return s == Sensor::index_dij || s == Sensor::middle_dij || s == Sensor::ring_dij ||
           s == Sensor::little_dij;
}

std::optional<double> degrees_in(Posture pose, Sensor s) {
    switch (pose) {
        case Posture::flat:
            return 0.0;  // fingers and thumb side by side, wrist straight
        case Posture::fist:
            if (is_mpj(s)) return 90.0;
            if (is_pij(s)) return 100.0;
            if (is_dij(s)) return 65.0;
            if (s == Sensor::palm_arch) return 25.0;
            return std::nullopt;
        case Posture::spread:
            if (s == Sensor::thumb_abduction) return 50.0;
            if (s == Sensor::middle_abduction) return 20.0;
            if (s == Sensor::ring_abduction) return 18.0;
            if (s == Sensor::little_abduction) return 25.0;
            return std::nullopt;
        case Posture::thumb_across:
            if (s == Sensor::thumb_roll) return 60.0;
            if (s == Sensor::thumb_mpj) return 50.0;
            if (s == Sensor::thumb_ij) return 60.0;
            return std::nullopt;
    }
    return std::nullopt;
}

struct Seen {
    double raw = 0.0, angle = 0.0, deviation = 0.0;
    Posture pose = Posture::flat;
};

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t n = values.size();
    return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

// What a sensor gave in a pose; none: it gave nothing.
std::optional<Seen> seen(const Held& held, Sensor sensor) {
    const std::optional<double> at = angle_in(held.pose, sensor);
    if (!at) return std::nullopt;
    std::vector<double> raw;
    for (const auto& sample : held.samples)
        if (sample[index(sensor)] != 0) raw.push_back(sample[index(sensor)]);
    if (raw.empty()) return std::nullopt;
    double mean = 0.0, squares = 0.0;
    for (const double r : raw) mean += r / static_cast<double>(raw.size());
    for (const double r : raw) squares += square(r - mean) / static_cast<double>(raw.size());
    return Seen{median(raw), *at, std::sqrt(squares), held.pose};
}

// The angle as a line of the raw value.
std::optional<Line> fit(const std::vector<Seen>& at) {
    double raw = 0.0, angle = 0.0;
    const auto n = static_cast<double>(at.size());
    for (const Seen& s : at) {
        raw += s.raw / n;
        angle += s.angle / n;
    }
    double both = 0.0, raws = 0.0;
    for (const Seen& s : at) {
        both += (s.raw - raw) * (s.angle - angle);
        raws += square(s.raw - raw);
    }
    if (!(raws > 0.0) || both == 0.0) return std::nullopt;
    const double gain = both / raws;
    return Line{gain, raw - angle / gain};
}

double figure_of(const SensorQuality& q) {
    return 1.0 / ((1.0 + square(poor_span / q.span)) * (1.0 + square(q.trembling / poor_trembling)));
}

}  // namespace

std::optional<double> angle_in(Posture pose, Sensor sensor) {
    const std::optional<double> degrees = degrees_in(pose, sensor);
    return degrees ? std::optional(to_radians(*degrees)) : std::nullopt;
}

Result<Calibrated> calibrate(std::span<const Held> held) {
    const auto has = [&](Posture pose) {
        return std::any_of(held.begin(), held.end(), [&](const Held& h) { return h.pose == pose; });
    };
    for (const Posture pose : {Posture::flat, Posture::fist})
        if (!has(pose))
            return fail(ErrorCode::failed,
                        fmt::format("no {} was shown", pose_names[static_cast<std::size_t>(pose)]),
                        "at least a flat hand and a fist");
    for (const Held& h : held)
        if (h.samples.empty())
            return fail(ErrorCode::failed, fmt::format("the glove gave nothing while the {} was held",
                                                       pose_names[static_cast<std::size_t>(h.pose)]));

    Calibrated result;
    result.figure = 1.0;
    bool any = false, trembled = false;
    for (std::size_t i = 0; i < all_sensors; ++i) {
        const auto sensor = static_cast<Sensor>(i);
        std::vector<Seen> at;
        for (const Held& h : held)
            if (const auto s = seen(h, sensor)) at.push_back(*s);
        if (at.size() < 2) continue;  // not a sensor of this glove, or no pose tells about it
        const auto [low, high] = std::minmax_element(
            at.begin(), at.end(), [](const Seen& a, const Seen& b) { return a.raw < b.raw; });
        SensorQuality& q = result.quality[i];
        q.span = high->raw - low->raw;
        any = true;
        const std::optional<Line> line = q.span >= least_span ? fit(at) : std::nullopt;
        if (!line) {
            result.figure = 0.0;
            result.remarks.push_back(fmt::format(
                "{}: moved by {:.0f} counts only; is the glove on properly, and was the pose taken?",
                name_of(sensor), q.span));
            continue;
        }
        for (const Seen& s : at) {
            q.trembling = std::max(q.trembling, std::abs(line->gain) * s.deviation);
            q.off = std::max(q.off, std::abs(angle(*line, s.raw) - s.angle));
        }
        trembled = trembled || q.trembling > poor_trembling;
        result.calibration.lines[i] = line;
        result.figure = std::min(result.figure, figure_of(q));
    }
    if (!any) return fail(ErrorCode::failed, "no sensor of the glove gave anything in two poses");
    if (trembled)
        result.remarks.emplace_back("the hand moved while a pose was held; hold still for two seconds");
    return result;
}

}  // namespace bolt::glove
