#include "tools/author/geometry/wrench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace bolt::geometry {

namespace {

Vec3 jaw_direction(double angle) { return {std::cos(angle), std::sin(angle), 0.0}; }

// Measured with rays from the middle of the jaw: two across it that must hit, one out of the mouth that must
// not.
struct MeasuredJaw {
    double opening = 0.0, off_middle = 0.0;  // m
    bool found = false;
};

MeasuredJaw measure_jaw(const Bvh& bvh, double head_angle, double reach) {
    MeasuredJaw jaw;
    const Vec3 across = jaw_direction(head_angle + 0.5 * pi), mouth = -jaw_direction(head_angle);
    const auto left = first_hit(bvh, Vec3{0.0}, across, reach),
               right = first_hit(bvh, Vec3{0.0}, -across, reach);
    if (!left || !right || first_hit(bvh, Vec3{0.0}, mouth, reach)) return jaw;
    jaw.opening = left->distance + right->distance;
    jaw.off_middle = 0.5 * (left->distance - right->distance);
    jaw.found = true;
    return jaw;
}

tl::unexpected<Error> wrench_error(std::string what, std::string expected) {
    return fail(ErrorCode::bad_content, std::move(what), std::move(expected));
}

}  // namespace

Result<WrenchShape> wrench_from_model(const FlattenedModel& scene, const content::WrenchDesign& design,
                                      ModelFrame frame) {
    WrenchShape wrench;
    Aabb box;
    for (const ModelPart& part : scene.parts) {
        wrench.triangles.insert(wrench.triangles.end(), part.triangles.begin(), part.triangles.end());
        for (const Vec3& p : {part.box.low, part.box.high})
            if (!part.box.empty()) box.add(p);
    }
    if (wrench.triangles.empty()) return wrench_error("the wrench has no triangles", "a mesh");
    const bool lies = frame == ModelFrame::found && box.half().y < box.half().z;
    for (Triangle& t : wrench.triangles) {
        for (Vec3* p : {&t.a, &t.b, &t.c}) {
            if (lies) *p = {p->x, -p->z, p->y};
            wrench.reach = std::max(wrench.reach, std::hypot(p->x, p->y));
        }
        t.part = 0;
    }
    if (wrench.reach > 5.0 || wrench.reach < 0.02)
        return wrench_error(fmt::format("the wrench is {:.4g} mm long", wrench.reach / mm),
                            wrench.reach > 5.0 ? "metres: it looks like millimetres" : "metres, as in glTF");
    const Bvh bvh(wrench.triangles);
    // The head may point to either side, because the wrench can be turned over.
    const MeasuredJaw left = measure_jaw(bvh, design.head_angle, wrench.reach);
    const MeasuredJaw right = measure_jaw(bvh, -design.head_angle, wrench.reach);
    if (!left.found && !right.found)
        return wrench_error(
            "the wrench has no jaw about its origin that opens at -X, turned by the head angle",
            "the middle of the jaw at the origin, the handle along +X");
    const bool is_left = left.found && (!right.found || left.opening <= right.opening);
    const MeasuredJaw& jaw = is_left ? left : right;
    wrench.head_angle = is_left ? design.head_angle : -design.head_angle;
    if (std::abs(jaw.opening - design.jaw) > 0.05 * mm)
        return wrench_error(
            fmt::format("the jaw of the wrench measures {:.2f} mm in its model, and jaw_mm is {:g}",
                        jaw.opening / mm, design.jaw / mm),
            "both within 0.05 mm");
    if (std::abs(jaw.off_middle) > 0.05 * mm)
        return wrench_error(
            fmt::format("the middle of the jaw is {:.2f} mm beside the origin of the wrench's model",
                        std::abs(jaw.off_middle) / mm),
            "the middle of the jaw at the origin");
    const double near_head = 1.3 * design.jaw;
    for (const Triangle& t : wrench.triangles)
        for (const Vec3& p : {t.a, t.b, t.c})
            if (std::hypot(p.x, p.y) < near_head) {
                wrench.half_thickness = std::max(wrench.half_thickness, std::abs(p.z));
                wrench.head_size = std::max(wrench.head_size, std::hypot(p.x, p.y));
            }
    return wrench;
}

Bvh place_on_nut(const WrenchShape& wrench, bool turned_over) {
    std::vector<Triangle> triangles = wrench.triangles;
    const double side = turned_over ? -1.0 : 1.0;
    for (Triangle& t : triangles)
        for (Vec3* p : {&t.a, &t.b, &t.c}) *p = {p->x, side * p->z, -side * p->y};
    return Bvh(std::move(triangles));
}

namespace {

constexpr double resolution = to_radians(0.01);

struct SwingProbe {
    const Bvh& surroundings;
    const Bvh& wrench;
    double height;

    // Returns the part that the wrench collides with at this handle angle, or no_part.
    [[nodiscard]] std::uint32_t operator()(double angle) const {
        const auto hit =
            first_crossing(surroundings, wrench, TurnAboutY::turned(angle, Vec3{0.0, height, 0.0}));
        return hit ? surroundings.triangles()[*hit].part : no_part;
    }
};

// Samples of one revolution: one per degree, more for a long wrench. Between two samples the end of the
// handle moves by at most the thickness of the wrench, so that no obstacle is skipped.
int sample_count(const Bvh& wrench) {
    const Aabb box = wrench.box();
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

FreeSwing find_free_swing(const Bvh& surroundings, const Bvh& wrench, double height) {
    const SwingProbe probe{surroundings, wrench, height};
    const int samples = sample_count(wrench);
    const double step = 2.0 * pi / samples;
    std::vector<std::uint32_t> hits;
    std::map<std::uint32_t, int> counts;
    for (int i = 0; i < samples; ++i) {
        hits.push_back(probe(i * step));
        if (hits.back() != no_part) ++counts[hits.back()];
    }
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

namespace {

constexpr double step = 3e-3;                   // m, smaller than the thickness of any modelled wrench
constexpr double turn_step = to_radians(10.0);  // between the handle angles that are tried
constexpr double max_lift = 2.0;                // m, beyond which obstacles are ignored
constexpr double jaw_to_tip = 1.7;              // travel that frees the jaw from a hexagon / head size

// Moves the wrench along a straight line at a fixed handle angle and tests it for collisions.
struct PathProbe {
    const Bvh& surroundings;
    const Bvh& wrench;
    double angle;
    std::uint32_t hit = no_part;  // the part that blocks the path

    bool free(const Vec3& from, const Vec3& direction, double distance) {
        for (double travelled = 0.0; travelled < distance + step; travelled += step) {
            const Vec3 shift = from + std::min(travelled, distance) * direction;
            const auto found = first_crossing(surroundings, wrench, TurnAboutY::turned(angle, shift));
            if (!found) continue;
            hit = surroundings.triangles()[*found].part;
            return false;
        }
        return true;
    }
};

}  // namespace

std::uint32_t find_obstruction(const Bvh& surroundings, const Bvh& wrench, const FreeSwing& swing,
                               const ExitPaths& paths) {
    if (surroundings.nodes().empty()) return no_part;
    const Vec3 start{0.0, paths.height, 0.0}, up{0.0, 1.0, 0.0};
    const double lift = std::clamp(surroundings.box().high.y - paths.height, 0.0, max_lift) + 2.0 * step;
    std::uint32_t hit = swing.blocking;
    for (const Arc& arc : swing.arcs) {
        const int tries = 1 + static_cast<int>(arc.width() / turn_step);
        for (int i = 0; i < tries; ++i) {
            const double angle = arc.from + (i + 0.5) / tries * arc.width();
            PathProbe path{surroundings, wrench, angle};
            if (path.free(start, up, lift)) return no_part;
            // Sideways off the nut: the wrench moves towards the bottom of its jaw, along its handle.
            const double away = angle + paths.jaw_angle, off = jaw_to_tip * paths.head_size;
            const Vec3 direction{std::cos(away), 0.0, -std::sin(away)};
            PathProbe sideways{surroundings, wrench, angle};
            if (sideways.free(start, direction, off) &&
                (sideways.free(start + off * direction, up, lift) ||
                 sideways.free(start + off * direction, direction, 2.0 * paths.reach)))
                return no_part;
            hit = sideways.hit;
        }
    }
    return hit;
}

}  // namespace bolt::geometry
