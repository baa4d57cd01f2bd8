#include "haptics/hand/finger_closure.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "haptics/hand/kinematics.hpp"

namespace bolt::hand {
namespace {

// True if the line to the other contact lies in the friction cone of this one.
bool pushes_towards(const FingertipContact& one, const FingertipContact& other) {
    const Vec3 between = other.point - one.point;
    return glm::dot(between, -one.normal) >= std::cos(friction_angle) * glm::length(between);
}

}  // namespace

FingertipGrasp fingertip_grasp(const collision::ToolShape& tool, const Fingertips& tips) {
    FingertipGrasp grasp;
    for (std::size_t i = 0; i < digit_count; ++i) {
        FingertipContact& tip = grasp.tips[i];
        std::array<collision::SeparatingPlane, 1> planes;
        const double distance = std::abs(
            collision::query_point(tool.solid, tips.at[i], contact_query_range + tips.radius, 0.0, {})
                .distance);
        if (distance > contact_query_range + tips.radius) continue;
        // The margin ensures that the closest plane is among the candidates.
        if (collision::query_point(tool.solid, tips.at[i], distance + 1e-6, distance + 1e-6, planes).planes ==
            0)
            continue;
        tip = {planes[0].distance - tips.radius, planes[0].point, planes[0].normal};
    }
    const FingertipContact& thumb = grasp.tips[0];
    for (std::size_t i = 1; i < digit_count; ++i) {
        const FingertipContact& finger = grasp.tips[i];
        grasp.held = grasp.held || (thumb.distance <= touch_distance && finger.distance <= touch_distance &&
                                    pushes_towards(thumb, finger) && pushes_towards(finger, thumb));
    }
    return grasp;
}

namespace {

using collision::infinite_distance;
using collision::query_point;
using hand::Angles;
using hand::Capsule;
using hand::digits;

constexpr std::size_t links = 3;                // bones that the three joints move
constexpr std::size_t max_spheres = 12;         // per link
constexpr double edge_tolerance = 0.1e-3;       // m by which a sphere may pass through an edge
constexpr double query_range = 60e-3;           // m; greater distances count as this
constexpr double sphere_query_distance = 3e-3;  // m; a nearer link is queried sphere by sphere
constexpr double exact_distance = 5e-3;         // m; a sphere whose bound exceeds this is not queried again
constexpr double root_tolerance = 1e-6;         // m, tolerance of the position at which a digit stops
constexpr int max_guesses = 12;

// The cached distance of one sphere, with the closure fraction at which it was computed.
struct CachedDistance {
    double distance = -infinite_distance, share = 0.0;
};

struct JointAngles {
    std::array<double*, 3> at;
};
JointAngles joints_of(Angles& angles, std::size_t digit) {
    if (digit == 0) return {{&angles.thumb.abduction, &angles.thumb.mcp, &angles.thumb.ip}};
    hand::FingerAngles& finger = angles.fingers[digit - 1];
    return {{&finger.mcp, &finger.pip, &finger.dip}};
}

// Distance of a point to the tool; a lower bound is returned if it exceeds `enough`.
double signed_distance(const collision::ToolShape& tool, const Vec3& at, double enough) {
    const collision::OctreeQuery octree_query = collision::query(tool.octree, at);
    if (octree_query.lower > enough) return octree_query.lower;
    const double distance =
        query_point(tool.solid, at, std::min(query_range, octree_query.upper + 1e-6), 0.0, {}).distance;
    return distance == infinite_distance ? query_range : distance;
}

std::size_t sphere_count(const Capsule& capsule) {
    const double length = glm::length(capsule.to - capsule.from);
    return std::min(max_spheres, static_cast<std::size_t>(std::ceil(length / sphere_spacing)) + 1);
}

struct Sphere {
    Vec3 at;
    double radius;
};
Sphere sphere_of(const Capsule& capsule, std::size_t i, std::size_t spheres) {
    const double t = static_cast<double>(i) / static_cast<double>(spheres - 1);
    return {capsule.from + t * (capsule.to - capsule.from),
            capsule.radius_from + t * (capsule.radius_to - capsule.radius_from)};
}

// Lower bound (m) of the distance of all spheres of a capsule; it may be loose beyond `enough`.
double capsule_clearance(const collision::ToolShape& tool, const Capsule& capsule, double enough) {
    const double around =
        0.5 * glm::length(capsule.to - capsule.from) + std::max(capsule.radius_from, capsule.radius_to);
    return signed_distance(tool, 0.5 * (capsule.from + capsule.to), around + enough) - around;
}

struct MovingDigit {
    const collision::ToolShape& tool;
    const hand::Hand& hand;
    const Pose& wrist;
    std::size_t number;
    std::array<double, 3> from{}, to{};  // rad, of its joints
    Angles angles;                       // of all digits; the others' as measured
    hand::Skeleton joints;
    // Penetration of each sphere with the digit open (m, negative); it does not stop the digit.
    std::array<std::array<double, max_spheres>, links> open_penetration{};
    std::array<std::array<CachedDistance, max_spheres>, links> cached{};  // during the current motion

    // False for the thumb's metacarpal, which is inside the flesh of the palm and touches nothing.
    [[nodiscard]] bool collides(std::size_t link) const { return number != 0 || link != 0; }
    [[nodiscard]] Capsule capsule_of(std::size_t link) const {
        return hand::bone_capsule(hand, joints, number, link + (number == 0 ? 0 : 1));
    }

    void bend(const std::array<double, 3>& share) {
        const JointAngles joint = joints_of(angles, number);
        for (std::size_t k = 0; k < 3; ++k) *joint.at[k] = from[k] + share[k] * (to[k] - from[k]);
        place_digit(hand, angles, wrist, number, joints);
    }

    [[nodiscard]] Vec3 joint_at(std::size_t k) const {
        return joints.position[digits[number].first + k + (number == 0 ? 0 : 1)];
    }

    // Upper bound (m) of the distance that a point of a link travels while the fractions of the joints from
    // `first` on grow by 1.
    [[nodiscard]] double travel_bound(std::size_t link, std::size_t first, const Vec3& at) const {
        double bound = 0.0;
        // The distance of a joint to the point is at most the length of the bones between them.
        double reach = glm::length(at - joint_at(link));
        for (std::size_t k = link + 1; k-- > 0;) {
            if (k < link) reach += glm::length(joint_at(k + 1) - joint_at(k));
            if (k >= first) bound += std::abs(to[k] - from[k]) * reach;
        }
        return bound;
    }
};

struct DigitQuery {
    double step = 1.0;                   // largest safe increase of the fraction
    bool free = true;                    // no sphere is deeper than stop_tolerance
    std::size_t link = 0;                // the deepest link
    double deepest = infinite_distance;  // m, signed, relative to the penetration with the digit open
};

// Queries the spheres of a digit that is bent to the fraction `share`. A sphere whose cached bound exceeds
// `enough` (m) is not queried again.
DigitQuery query_digit(MovingDigit& digit, std::size_t first, double share, double enough) {
    DigitQuery result;
    const auto found = [&](std::size_t link, double distance, double travel) {
        result.step =
            std::min(result.step, std::max(distance + edge_tolerance, 0.0) / std::max(travel, 1e-9));
        if (distance >= result.deepest) return;
        result.deepest = distance;
        result.link = link;
    };
    for (std::size_t link = 0; link < links; ++link) {
        if (!digit.collides(link)) continue;
        const Capsule capsule = digit.capsule_of(link);
        const double clear = capsule_clearance(digit.tool, capsule, sphere_query_distance);
        if (clear > sphere_query_distance) {
            found(link, clear, digit.travel_bound(link, first, capsule.to));
            continue;
        }
        const std::size_t spheres = sphere_count(capsule);
        for (std::size_t i = 0; i < spheres; ++i) {
            const Sphere sphere = sphere_of(capsule, i, spheres);
            const double travel = digit.travel_bound(link, first, sphere.at);
            CachedDistance& cached = digit.cached[link][i];
            const double bound = cached.distance - travel * std::abs(share - cached.share);
            if (bound > enough) {
                found(link, bound, travel);
                continue;
            }
            const double distance = signed_distance(digit.tool, sphere.at, sphere.radius + exact_distance);
            cached = {distance - sphere.radius - digit.open_penetration[link][i], share};
            found(link, cached.distance, travel);
        }
    }
    result.free = result.deepest >= -stop_tolerance;
    return result;
}

void record_open_penetration(MovingDigit& digit) {
    digit.bend({0.0, 0.0, 0.0});
    for (std::size_t link = 0; link < links; ++link) {
        if (!digit.collides(link)) continue;
        const Capsule capsule = digit.capsule_of(link);
        if (capsule_clearance(digit.tool, capsule, 0.0) > 0.0) continue;
        const std::size_t spheres = sphere_count(capsule);
        for (std::size_t i = 0; i < spheres; ++i) {
            const Sphere sphere = sphere_of(capsule, i, spheres);
            digit.open_penetration[link][i] =
                std::min(0.0, signed_distance(digit.tool, sphere.at, sphere.radius) - sphere.radius);
        }
    }
}

// Increases the fractions of the joints from `first` on together until a link touches. Returns that link;
// nullopt if the measured angles or max_steps are reached.
std::optional<std::size_t> advance(MovingDigit& digit, std::size_t first, DigitStop& stop) {
    double share = stop.share[first];
    const auto bend_to = [&](double s) {
        for (std::size_t k = first; k < 3; ++k) stop.share[k] = s;
        digit.bend(stop.share);
    };
    for (auto& spheres : digit.cached) spheres.fill({});
    bend_to(share);
    DigitQuery result = query_digit(digit, first, share, exact_distance);
    for (; share < 1.0 && stop.steps < max_steps; ++stop.steps) {
        double free = share, hit = std::min(1.0, share + result.step),
               above = result.deepest + stop_tolerance;
        bend_to(hit);
        result = query_digit(digit, first, hit, exact_distance);
        if (result.free) {
            share = hit;
            continue;
        }
        // Root finding for the contact: regula falsi with occasional bisection.
        double below = result.deepest + stop_tolerance;
        std::size_t link = result.link;
        for (int i = 0; i < max_guesses && above > root_tolerance; ++i) {
            const double part = i % 3 == 2 ? 0.5 : std::clamp(above / (above - below), 0.1, 0.9);
            const double guess = free + part * (hit - free);
            bend_to(guess);
            result = query_digit(digit, first, guess, stop_tolerance);
            if (!result.free) link = result.link;
            (result.free ? free : hit) = guess;
            (result.free ? above : below) = result.deepest + stop_tolerance;
        }
        bend_to(free);
        return link;
    }
    return std::nullopt;
}

hand::FingertipContact nearest_of(const MovingDigit& digit) {
    hand::FingertipContact best;
    for (std::size_t link = 1; link < links; ++link) {
        const Capsule capsule = digit.capsule_of(link);
        const std::size_t spheres = sphere_count(capsule);
        for (std::size_t i = 0; i < spheres; ++i) {
            const Sphere sphere = sphere_of(capsule, i, spheres);
            const collision::OctreeQuery octree_query = collision::query(digit.tool.octree, sphere.at);
            if (octree_query.lower - sphere.radius >= best.distance) continue;
            const double centre = signed_distance(digit.tool, sphere.at, query_range);
            if (centre >= query_range || centre - sphere.radius >= best.distance) continue;
            std::array<collision::SeparatingPlane, 1> planes;
            const double band = std::abs(centre) + 1e-6;
            if (query_point(digit.tool.solid, sphere.at, band, band, planes).planes == 0) continue;
            best = {planes[0].distance - sphere.radius, planes[0].point, planes[0].normal};
        }
    }
    return best;
}

// True if the tool is out of reach of the whole hand.
bool out_of_reach(const collision::ToolShape& tool, const hand::Hand& hand, const Pose& wrist) {
    constexpr double hand_length = 0.24;  // m, of a hand of scale 1 with its flesh
    return glm::length(wrist.position - tool.solid.middle) > tool.solid.radius + hand.scale * hand_length;
}

}  // namespace

FingerClosure close_fingers(const collision::ToolShape& tool, const hand::Hand& hand, const Angles& measured,
                            const Pose& wrist) {
    FingerClosure closure;
    closure.angles = measured;
    if (out_of_reach(tool, hand, wrist)) return closure;
    for (std::size_t number = 0; number < hand::digit_count; ++number) {
        MovingDigit digit{tool, hand, wrist, number, {}, {}, measured, {}, {}, {}};
        DigitStop& stop = closure.digits[number];
        const JointAngles joint = joints_of(digit.angles, number);
        for (std::size_t k = 0; k < 3; ++k) {
            digit.to[k] = *joint.at[k];
            digit.from[k] = std::min(digit.to[k], 0.0);  // a joint bent back beyond straight stays there
        }
        if (number == 0) digit.from[0] = std::max(digit.to[0], hand::thumb_abduction_range.high);
        record_open_penetration(digit);
        stop.share = {0.0, 0.0, 0.0};
        for (std::size_t first = 0; first < links;) {
            const auto link = advance(digit, first, stop);
            if (!link) break;
            stop.touches = true;
            first = std::max(first, *link) + 1;  // joints between the wrist and the touching bone stop
        }
        stop.nearest = nearest_of(digit);
        const JointAngles shown = joints_of(closure.angles, number);
        for (std::size_t k = 0; k < 3; ++k) *shown.at[k] = *joint.at[k];
    }
    return closure;
}

}  // namespace bolt::hand
