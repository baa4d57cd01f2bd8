#include "tools/author/geometry/joint_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace bolt::geometry {

namespace {

constexpr double hexagon_play = 0.5 * mm;  // ISO 4032 lets the width across flats be smaller by up to 2 %

}  // namespace

double JointCheck::grip() const {
    double sum = 0.0;
    for (const joint::Member& member : joint.design.members) sum += member.thickness;
    return sum;
}

std::optional<RayHit> JointCheck::ray(const Vec3& origin, const Vec3& direction, double reach) const {
    return first_hit(everything, Vec3(parts.to_assembly * glm::dvec4(origin, 1.0)),
                     glm::normalize(Vec3(parts.to_assembly * glm::dvec4(direction, 0.0))), reach,
                     [this](std::uint32_t part) { return parts.owns(part); });
}

std::array<Vec3, 3> JointCheck::corners_of(const RayHit& hit) const {
    const Triangle& t = everything.triangles()[hit.triangle];
    const auto in_joint = [&](const Vec3& p) { return Vec3(parts.to_joint * glm::dvec4(p, 1.0)); };
    return {in_joint(t.a), in_joint(t.b), in_joint(t.c)};
}

std::optional<double> check_hexagon(const JointCheck& s, const Fastener& fastener, double across_flats,
                                    const char* noun) {
    const std::string name = content::in_quotes(fastener.name);
    const auto hexagon = measure_hexagon(fastener.triangles);
    if (!hexagon || hexagon->unevenness > 0.1 * mm) {
        s.error(fmt::format("{} is not a hexagon about the joint's axis", name),
                fmt::format("a hexagon {}, {:g} mm across flats", noun, across_flats / mm));
        return std::nullopt;
    }
    const double flats = hexagon->across_flats, off = std::hypot(hexagon->centre.x, hexagon->centre.z);
    if (off > offset_tolerance)
        s.error(fmt::format("{} is {:.3g} mm beside the joint's axis", name, off / mm), "at most 0.01 mm");
    if (flats > across_flats + contact_tolerance || flats < across_flats - hexagon_play)
        s.error(fmt::format("{} measures {:.2f} mm across flats", name, flats / mm),
                fmt::format("{:g} mm for {}", across_flats / mm, s.size().name));
    return flats;
}

void check_seat(const JointCheck& s, const std::string& upper, double bottom, const std::string& lower,
                double level) {
    const double gap = bottom - level;
    if (std::abs(gap) <= contact_tolerance) return;
    if (gap < 0.0)
        s.error(fmt::format("{} is {:.2f} mm deep in {}", content::in_quotes(upper), -gap / mm, lower),
                "the two faces in contact");
    else
        s.error(fmt::format("{} is {:.2f} mm away from {}", content::in_quotes(upper), gap / mm, lower),
                "the two faces in contact");
}

std::optional<FaceHit> find_face(const JointCheck& s, double radius, double height, double direction,
                                 double reach) {
    constexpr int rays = 24;
    std::vector<FaceHit> hits;
    for (int i = 0; i < rays; ++i) {
        const double angle = (i + 0.5) * 2.0 * pi / rays;
        const Vec3 origin{radius * std::cos(angle), height, radius * std::sin(angle)};
        if (const auto hit = s.ray(origin, {0.0, direction, 0.0}, reach))
            hits.push_back({hit->distance, s.part_of(*hit)});
    }
    if (hits.size() < rays / 2) return std::nullopt;
    std::sort(hits.begin(), hits.end(),
              [](const FaceHit& a, const FaceHit& b) { return a.distance < b.distance; });
    return hits[hits.size() / 2];
}

std::optional<CircleFit> fit_circle(const std::vector<Vec3>& points) {
    glm::dmat3 m(0.0);
    Vec3 right(0.0);
    for (const Vec3& p : points) {
        const Vec3 row{p.x, p.z, 1e-2};  // the constant is scaled to the size of a hole
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k) m[k][i] += row[i] * row[k];
        right -= (p.x * p.x + p.z * p.z) * row;
    }
    if (points.size() < 6 || std::abs(glm::determinant(m)) < 1e-30) return std::nullopt;
    const Vec3 abc = glm::inverse(m) * right;
    CircleFit circle;
    circle.x = -0.5 * abc.x;
    circle.z = -0.5 * abc.y;
    circle.radius = std::sqrt(std::max(circle.x * circle.x + circle.z * circle.z - 1e-2 * abc.z, 0.0));
    for (const Vec3& p : points)
        circle.residual =
            std::max(circle.residual, std::abs(std::hypot(p.x - circle.x, p.z - circle.z) - circle.radius));
    return circle;
}

bool report_hole_off_axis(const JointCheck& s, std::uint32_t part, const CircleFit& hole, const char* noun) {
    const double off = std::hypot(hole.x, hole.z);
    if (off <= offset_tolerance) return false;
    s.error(fmt::format("the {} in {} is {:.3g} mm beside the joint's axis", noun, s.name_of(part), off / mm),
            "at most 0.01 mm");
    return true;
}

}  // namespace bolt::geometry
