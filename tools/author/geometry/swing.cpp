#include "tools/author/geometry/swing.hpp"

#include <algorithm>
#include <map>

namespace bolt::geometry {

namespace {

constexpr double resolution = to_radians(0.01);

struct Probe {
    const Bvh& surroundings;
    const Bvh& wrench;
    double height;

    // What the wrench touches at this angle.
    [[nodiscard]] std::uint32_t operator()(double angle) const {
        const auto hit = first_crossing(surroundings, wrench, Pose::turned(angle, Vec3{0.0, height, 0.0}));
        return hit ? surroundings.triangles()[*hit].part : no_part;
    }
};

// A degree, or less for a wrench so long that something could slip through between two samples: the end of
// its handle moves by no more than the wrench is thick, and it is wider than thick.
int sample_count(const Bvh& wrench) {
    const Box box = wrench.box();
    const double thickness = std::max(2.0 * box.half().y, 1e-3);
    return std::max(360, static_cast<int>(std::ceil(2.0 * pi * box.high.x / thickness)));
}

// The end of what is free between a free angle and one that is not, and what stands there.
double find_edge(const Probe& probe, double free, double blocked, std::uint32_t& part) {
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

}  // namespace

const Arc* Swing::widest() const {
    const auto it = std::max_element(arcs.begin(), arcs.end(),
                                     [](const Arc& a, const Arc& b) { return a.width() < b.width(); });
    return it == arcs.end() ? nullptr : &*it;
}

Swing free_swing(const Bvh& surroundings, const Bvh& wrench, double height) {
    const Probe probe{surroundings, wrench, height};
    const int samples = sample_count(wrench);
    const double step = 2.0 * pi / samples;
    std::vector<std::uint32_t> hits;
    std::map<std::uint32_t, int> counts;
    for (int i = 0; i < samples; ++i) {
        hits.push_back(probe(i * step));
        if (hits.back() != no_part) ++counts[hits.back()];
    }
    Swing swing;
    if (counts.empty()) {
        swing.arcs.push_back({0.0, 2.0 * pi, no_part, no_part});
        return swing;
    }
    const auto most = std::max_element(counts.begin(), counts.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    swing.blocking = most->first;
    const auto at = [&](int i) { return hits[static_cast<std::size_t>((i + samples) % samples)]; };
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

bool cover(std::vector<std::pair<double, double>> intervals, double period) {
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
