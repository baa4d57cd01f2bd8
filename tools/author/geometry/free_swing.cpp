#include "tools/author/geometry/free_swing.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace bolt::geometry {

namespace {

constexpr double resolution = to_radians(0.01);

struct SwingProbe {
    const Obstacles& surroundings;
    const Bvh& tool;
    double height;

    // Returns the part that the tool collides with at this handle angle, or no_part.
    [[nodiscard]] std::uint32_t operator()(double angle) const {
        return surroundings.first_hit_by(tool, at(angle));
    }
    // Returns true only if the tool is free at all angles up to `half` from `angle`.
    [[nodiscard]] bool surely_free(double angle, double half) const {
        return !surroundings.may_be_hit(tool, at(angle), {half, Vec3{0.0}});
    }
    [[nodiscard]] RigidMotion at(double angle) const {
        return RigidMotion::about_y(angle, Vec3{0.0, height, 0.0});
    }
};

// Probes the samples from `first` to `last`, `step` rad apart, that are not surely free. `hits` is no_part
// before.
void probe_samples(const SwingProbe& probe, double step, int first, int last,
                   std::vector<std::uint32_t>& hits) {
    if (first == last) {
        hits[static_cast<std::size_t>(first)] = probe(first * step);
        return;
    }
    if (probe.surely_free(0.5 * (first + last) * step, 0.5 * (last - first) * step)) return;
    const int middle = first + (last - first) / 2;
    probe_samples(probe, step, first, middle, hits);
    probe_samples(probe, step, middle + 1, last, hits);
}

// Samples of one revolution: one per degree, more for a long tool. Between two samples the end of the
// handle moves by at most the thickness of the tool, so that no obstacle is skipped.
int sample_count(const Bvh& tool) {
    const Aabb box = tool.box();
    const double thickness = std::max(2.0 * box.half().y, 1e-3);
    return std::max(360, static_cast<int>(std::ceil(2.0 * pi * box.high.x / thickness)));
}

// Bisects between a free and a blocked angle. Returns the last free angle; `part` receives the part that
// blocks it.
double find_edge(const SwingProbe& probe, double free, double blocked, std::uint32_t& part) {
    while (std::abs(blocked - free) > resolution) {
        const double middle = 0.5 * (free + blocked);
        const std::uint32_t hit = probe(middle);
        if (hit == no_part) {
            free = middle;
        } else {
            blocked = middle;
            part = hit;
        }
    }
    return free;
}

// Joins neighbouring samples of one revolution that collide with the same part.
std::vector<BlockedArc> find_blocked(const std::vector<std::uint32_t>& hits) {
    const auto samples = static_cast<int>(hits.size());
    const double step = 2.0 * pi / samples;
    const auto at = [&](int i) { return hits[static_cast<std::size_t>((i + samples) % samples)]; };
    std::vector<BlockedArc> blocked;
    for (int i = 0; i < samples; ++i) {
        if (at(i) == no_part || at(i - 1) == at(i)) continue;
        int last = i;
        while (at(last + 1) == at(i)) ++last;
        blocked.push_back({(i - 0.5) * step, (last + 0.5) * step, at(i)});
    }
    if (blocked.empty() && at(0) != no_part) blocked.push_back({0.0, 2.0 * pi, at(0)});
    return blocked;
}

}  // namespace

const Arc* FreeSwing::widest() const {
    const auto it = std::max_element(arcs.begin(), arcs.end(),
                                     [](const Arc& a, const Arc& b) { return a.width() < b.width(); });
    return it == arcs.end() ? nullptr : &*it;
}

double FreeSwing::width() const {
    const Arc* arc = widest();
    return arc != nullptr ? arc->width() : 0.0;
}

FreeSwing find_free_swing(const Obstacles& surroundings, const Bvh& tool, double height) {
    const Obstacles near = surroundings.in_swing_of(tool, height);
    const SwingProbe probe{near, tool, height};
    const int samples = sample_count(tool);
    const double step = 2.0 * pi / samples;
    std::vector<std::uint32_t> hits(static_cast<std::size_t>(samples), no_part);
    probe_samples(probe, step, 0, samples - 1, hits);
    std::map<std::uint32_t, int> counts;
    for (const std::uint32_t hit : hits)
        if (hit != no_part) ++counts[hit];
    FreeSwing swing;
    if (counts.empty()) {
        swing.arcs.push_back({0.0, 2.0 * pi, no_part, no_part});
        return swing;
    }
    const auto most = std::max_element(counts.begin(), counts.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    swing.blocking = most->first;
    const auto at = [&](int i) { return hits[static_cast<std::size_t>((i + samples) % samples)]; };
    swing.blocked = find_blocked(hits);
    for (int i = 0; i < samples; ++i) {
        if (at(i) != no_part || at(i - 1) == no_part) continue;
        int last = i;
        while (at(last + 1) == no_part) ++last;
        Arc arc;
        arc.before = at(i - 1);
        arc.after = at(last + 1);
        arc.from = find_edge(probe, i * step, (i - 1) * step, arc.before);
        arc.to = find_edge(probe, last * step, (last + 1) * step, arc.after);
        swing.arcs.push_back(arc);
    }
    return swing;
}

bool covers_period(std::vector<std::pair<double, double>> intervals, double period) {
    std::vector<std::pair<double, double>> parts;
    for (const auto& [from, to] : intervals) {
        if (to - from >= period) return true;
        const double start = from - period * std::floor(from / period), end = start + (to - from);
        parts.emplace_back(start, std::min(end, period));
        if (end > period) parts.emplace_back(0.0, end - period);
    }
    std::sort(parts.begin(), parts.end());
    double reached = 0.0;
    for (const auto& [from, to] : parts) {
        if (from > reached) return false;
        reached = std::max(reached, to);
    }
    return reached >= period;
}

}  // namespace bolt::geometry
