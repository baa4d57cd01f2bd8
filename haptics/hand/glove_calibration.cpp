#include "haptics/hand/glove_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/base/math.hpp"

namespace bolt::hand {

namespace {

constexpr double least_span = 5.0;  // counts: less is no measurement of anything
constexpr std::array<const char*, posture_count> posture_names = {"flat hand", "fist", "spread hand",
                                                                  "thumb across"};

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

std::optional<double> degrees_in(Posture posture, Sensor s) {
    switch (posture) {
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
    Posture posture = Posture::flat;
};

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t n = values.size();
    return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

// The readings of a sensor in a posture; empty: none.
std::optional<Seen> seen(const PostureSamples& held, Sensor sensor) {
    const std::optional<double> at = posture_angle(held.posture, sensor);
    if (!at) return std::nullopt;
    std::vector<double> raw;
    for (const auto& sample : held.samples)
        if (sample[index(sensor)] != 0) raw.push_back(sample[index(sensor)]);
    if (raw.empty()) return std::nullopt;
    double mean = 0.0, squares = 0.0;
    for (const double r : raw) mean += r / static_cast<double>(raw.size());
    for (const double r : raw) squares += square(r - mean) / static_cast<double>(raw.size());
    return Seen{median(raw), *at, std::sqrt(squares), held.posture};
}

// Least-squares fit of angle over raw reading.
std::optional<LinearFit> fit(const std::vector<Seen>& at) {
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
    return LinearFit{gain, raw - angle / gain};
}

double score_of(const SensorQuality& q) {
    return 1.0 / ((1.0 + square(poor_span / q.span)) * (1.0 + square(q.noise / poor_noise)));
}

}  // namespace

std::optional<double> posture_angle(Posture posture, Sensor sensor) {
    const std::optional<double> degrees = degrees_in(posture, sensor);
    return degrees ? std::optional(to_radians(*degrees)) : std::nullopt;
}

Result<CalibrationResult> calibrate(std::span<const PostureSamples> held) {
    const auto has = [&](Posture posture) {
        return std::any_of(held.begin(), held.end(),
                           [&](const PostureSamples& h) { return h.posture == posture; });
    };
    for (const Posture posture : {Posture::flat, Posture::fist})
        if (!has(posture))
            return fail(ErrorCode::failed,
                        fmt::format("the posture \"{}\" is missing",
                                    posture_names[static_cast<std::size_t>(posture)]),
                        "at least a flat hand and a fist");
    for (const PostureSamples& h : held)
        if (h.samples.empty())
            return fail(ErrorCode::failed, fmt::format("the glove sent no samples of the {}",
                                                       posture_names[static_cast<std::size_t>(h.posture)]));

    CalibrationResult result;
    result.score = 1.0;
    bool any = false, trembled = false;
    for (std::size_t i = 0; i < sensor_count; ++i) {
        const auto sensor = static_cast<Sensor>(i);
        std::vector<Seen> at;
        for (const PostureSamples& h : held)
            if (const auto s = seen(h, sensor)) at.push_back(*s);
        if (at.size() < 2) continue;  // not a sensor of this glove, or no posture tells about it
        const auto [low, high] = std::minmax_element(
            at.begin(), at.end(), [](const Seen& a, const Seen& b) { return a.raw < b.raw; });
        SensorQuality& q = result.quality[i];
        q.span = high->raw - low->raw;
        any = true;
        const std::optional<LinearFit> line = q.span >= least_span ? fit(at) : std::nullopt;
        if (!line) {
            result.score = 0.0;
            result.remarks.push_back(fmt::format(
                "{}: moved by {:.0f} counts only; is the glove on properly, and was the posture taken?",
                name_of(sensor), q.span));
            continue;
        }
        for (const Seen& s : at) {
            q.noise = std::max(q.noise, std::abs(line->gain) * s.deviation);
            q.residual = std::max(q.residual, std::abs(angle(*line, s.raw) - s.angle));
        }
        trembled = trembled || q.noise > poor_noise;
        result.calibration.fits[i] = line;
        result.score = std::min(result.score, score_of(q));
    }
    if (!any) return fail(ErrorCode::failed, "no sensor has readings in two postures");
    if (trembled)
        result.remarks.emplace_back("the hand moved while a posture was held; hold still for two seconds");
    return result;
}

}  // namespace bolt::hand
