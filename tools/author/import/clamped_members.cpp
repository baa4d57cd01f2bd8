#include "tools/author/import/clamped_members.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace bolt::step_import {

namespace {

struct MemberSpan {
    int node = -1;
    double from = 0.0, to = 0.0;  // m, heights along the bolt
    double solid = 0.0;           // m, thickness without cavities
};

// Diameters of holes, as shares of the bolt's diameter.
struct HoleRange {
    double least, most;
};
constexpr HoleRange clearance_hole{0.98, 1.5};
constexpr HoleRange tapped_hole{0.75, 1.01};  // the core (0.78 for M4), or the nominal diameter

// Radius of the part's hole around the bolt, m; 0 without a hole.
double hole_around(const PartGeometry& part, const ScaledPose& pose, const InstalledBolt& bolt,
                   const HoleRange& range) {
    double hole = 0.0;
    for (const Hole& one : part.holes) {
        const double radius = one.radius * std::abs(pose.scale);
        if (2.0 * radius < range.least * bolt.diameter || 2.0 * radius > range.most * bolt.diameter) continue;
        if (coaxial(bolt.origin, bolt.axis, pose.point(one.point), pose.direction(one.axis)))
            hole = std::max(hole, radius);
    }
    return hole;
}

// Measures the part along eight lines parallel to the bolt at `radius`, clear of the hole's chamfer, and
// returns the median; nullopt below 0.2 mm of material.
std::optional<MemberSpan> measure(const PartGeometry& part, const ScaledPose& pose, const InstalledBolt& bolt,
                                  double radius) {
    const ScaledPose local = inverse(pose);
    const Vec3 aside = std::abs(bolt.axis.y) < 0.9 ? Vec3{0.0, 1.0, 0.0} : Vec3{1.0, 0.0, 0.0};
    const Vec3 u = glm::normalize(glm::cross(bolt.axis, aside)), v = glm::cross(bolt.axis, u);
    std::array<MemberSpan, 8> spans;
    for (std::size_t i = 0; i < spans.size(); ++i) {
        // The offset avoids the seams that CAD programs put at round angles.
        const double angle = (static_cast<double>(i) + 0.37) * pi / 4.0;
        const Vec3 start = bolt.origin + radius * (std::cos(angle) * u + std::sin(angle) * v);
        const auto cuts = crossings(part.mesh, local.point(start), local.direction(bolt.axis));
        MemberSpan& span = spans[i];
        span.from = bolt.end;
        span.to = bolt.head;
        for (std::size_t c = 0; c + 1 < cuts.size(); c += 2) {
            const double low = std::max(cuts[c] * std::abs(pose.scale), bolt.head - touching);
            const double high = std::min(cuts[c + 1] * std::abs(pose.scale), bolt.end + touching);
            if (high <= low) continue;
            span.solid += high - low;
            span.from = std::min(span.from, low);
            span.to = std::max(span.to, high);
        }
    }
    std::nth_element(spans.begin(), spans.begin() + 4, spans.end(),
                     [](const MemberSpan& a, const MemberSpan& b) { return a.solid < b.solid; });
    if (spans[4].solid < 0.2 * mm) return std::nullopt;
    return spans[4];
}

// Lowest and highest point of the whole part along the bolt, m.
std::pair<double, double> extent(const PartGeometry& part, const ScaledPose& pose,
                                 const InstalledBolt& bolt) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec3& point : part.mesh.points) {
        const double height = glm::dot(pose.point(point) - bolt.origin, bolt.axis);
        low = std::min(low, height);
        high = std::max(high, height);
    }
    return {low, high};
}

// Closes the gap between two members that do not touch at the bolt: first extends both to their raised faces,
// then appends a part that fills the rest.
void close_gap(const std::vector<const PartGeometry*>& parts, const std::vector<ScaledPose>& poses,
               const InstalledBolt& bolt, MemberSpan& below, MemberSpan& above,
               std::vector<MemberSpan>& spans) {
    const auto extent_of = [&](int node) {
        const auto n = static_cast<std::size_t>(node);
        return extent(*parts[n], poses[n], bolt);
    };
    const double top = extent_of(below.node).second, bottom = extent_of(above.node).first;
    if (top > below.to && bottom < above.from && top <= bottom + touching) {
        below.solid += top - below.to;
        above.solid += above.from - bottom;
        below.to = top;
        above.from = bottom;
    }
    if (above.from - below.to < touching) return;
    for (std::size_t n = 0; n < parts.size(); ++n) {
        if (parts[n] == nullptr) continue;
        const auto [low, high] = extent(*parts[n], poses[n], bolt);
        if (std::abs(low - below.to) > touching || std::abs(high - above.from) > touching) continue;
        spans.push_back({static_cast<int>(n), low, high, high - low});
        return;
    }
}

}  // namespace

bool coaxial(const Vec3& p, const Vec3& a, const Vec3& q, const Vec3& b) {
    constexpr double turn = 4e-5;  // 1 − cos of 0.5°
    return std::abs(glm::dot(a, b)) > 1.0 - turn && glm::length(glm::cross(q - p, a)) < coaxial_distance;
}

std::vector<ClampedMember> find_members(const std::vector<const PartGeometry*>& parts,
                                        const std::vector<ScaledPose>& poses, const InstalledBolt& bolt) {
    std::vector<MemberSpan> spans;
    for (std::size_t n = 0; n < parts.size(); ++n) {
        if (parts[n] == nullptr) continue;
        const double hole = hole_around(*parts[n], poses[n], bolt, clearance_hole);
        if (hole == 0.0) continue;
        if (auto span = measure(*parts[n], poses[n], bolt, 0.5 * (hole + 0.8 * bolt.diameter))) {
            span->node = static_cast<int>(n);
            spans.push_back(*span);
        }
    }
    const auto sort_spans = [&] {
        std::stable_sort(spans.begin(), spans.end(),
                         [](const MemberSpan& a, const MemberSpan& b) { return a.from < b.from; });
    };
    sort_spans();
    std::vector<MemberSpan> fillers;
    for (std::size_t i = 0; i + 1 < spans.size(); ++i)
        if (spans[i + 1].from - spans[i].to > touching)
            close_gap(parts, poses, bolt, spans[i], spans[i + 1], fillers);
    spans.insert(spans.end(), fillers.begin(), fillers.end());
    sort_spans();
    std::vector<ClampedMember> members;
    for (const MemberSpan& span : spans) members.push_back({span.node, span.solid});
    return members;
}

std::optional<TappedPart> find_tapped_part(const std::vector<const PartGeometry*>& parts,
                                           const std::vector<ScaledPose>& poses, const InstalledBolt& bolt) {
    std::optional<TappedPart> last;
    for (std::size_t n = 0; n < parts.size(); ++n) {
        if (parts[n] == nullptr) continue;
        const double hole = hole_around(*parts[n], poses[n], bolt, tapped_hole);
        if (hole == 0.0) continue;
        const auto span = measure(*parts[n], poses[n], bolt, 0.65 * bolt.diameter);
        const double least = 0.5 * bolt.diameter;
        if (!span || std::min(bolt.end, span->to) - span->from < least) continue;
        const bool nominal = 2.0 * hole > clearance_hole.least * bolt.diameter;
        if (nominal && bolt.end - span->to > 0.3 * bolt.diameter) continue;
        if (!last || span->from > last->face)
            last = TappedPart{static_cast<int>(n), 2.0 * hole, span->from, span->to, nominal};
    }
    return last;
}

}  // namespace bolt::step_import
