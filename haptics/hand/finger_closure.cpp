#include "haptics/hand/finger_closure.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "haptics/hand/kinematics.hpp"

namespace bolt::hand {
namespace {

// True if the line to the other contact lies in the friction cone of this one.
bool pushes_at(const FingertipContact& one, const FingertipContact& other) {
    const Vec3 between = other.point - one.point;
    return glm::dot(between, -one.normal) >= std::cos(friction_angle) * glm::length(between);
}

}  // namespace

FingertipGrasp fingertip_grasp(const collision::ToolShape& tool, const Fingertips& tips) {
    FingertipGrasp made;
    for (std::size_t i = 0; i < fingers; ++i) {
        FingertipContact& tip = made.tips[i];
        std::array<collision::SeparatingPlane, 1> side;
        const double far =
            std::abs(collision::query_point(tool.solid, tips.at[i], sight + tips.radius, 0.0, {}).distance);
        if (far > sight + tips.radius) continue;
        // A margin, so that the closest side is among the candidates.
        if (collision::query_point(tool.solid, tips.at[i], far + 1e-6, far + 1e-6, side).planes == 0)
            continue;
        tip = {side[0].distance - tips.radius, side[0].point, side[0].normal};
    }
    const FingertipContact& thumb = made.tips[0];
    for (std::size_t i = 1; i < fingers; ++i) {
        const FingertipContact& finger = made.tips[i];
        made.held = made.held || (thumb.distance <= touching && finger.distance <= touching &&
                                  pushes_at(thumb, finger) && pushes_at(finger, thumb));
    }
    return made;
}

namespace {

using collision::infinite_distance;
using collision::query_point;
using hand::Angles;
using hand::Capsule;
using hand::digits;

constexpr std::size_t links = 3;        // parts that the three joints move
constexpr std::size_t most_balls = 12;  // of a link
constexpr double leap = 0.1e-3;         // m that a ball may be in an edge that it passes by
constexpr double sight = 60e-3;         // m: what is further from a ball is taken to be that far
constexpr double careful = 3e-3;        // m: a link nearer than this is looked at ball by ball
constexpr double sure = 5e-3;           // m: a ball that is surely this far is not looked at anew
constexpr double exact = 1e-6;          // m from where a digit stops; or after so many guesses:
constexpr int most_guesses = 12;

// The cached distance of one sphere, with the closure fraction at which it was computed.
struct Known {
    double deep = -infinite_distance, share = 0.0;
};

struct Three {
    std::array<double*, 3> at;
};
Three joints_of(Angles& angles, std::size_t digit) {
    if (digit == 0) return {{&angles.thumb.abduction, &angles.thumb.mcp, &angles.thumb.ip}};
    hand::FingerAngles& finger = angles.fingers[digit - 1];
    return {{&finger.mcp, &finger.pip, &finger.dip}};
}

// Distance of a point to the tool; a lower bound is returned if it exceeds `enough`.
double signed_distance(const collision::ToolShape& tool, const Vec3& at, double enough) {
    const collision::OctreeQuery seen = collision::query(tool.octree, at);
    if (seen.lower > enough) return seen.lower;
    const double distance = query_point(tool.solid, at, std::min(sight, seen.upper + 1e-6), 0.0, {}).distance;
    return distance == infinite_distance ? sight : distance;
}

std::size_t balls_of(const Capsule& tube) {
    const double length = glm::length(tube.to - tube.from);
    return std::min(most_balls, static_cast<std::size_t>(std::ceil(length / ball_spacing)) + 1);
}

struct Ball {
    Vec3 at;
    double radius;
};
Ball ball_of(const Capsule& tube, std::size_t i, std::size_t balls) {
    const double t = static_cast<double>(i) / static_cast<double>(balls - 1);
    return {tube.from + t * (tube.to - tube.from),
            tube.radius_from + t * (tube.radius_to - tube.radius_from)};
}

// Lower bound (m) of the distance of all spheres of a capsule; it may be loose beyond `enough`.
double clearance(const collision::ToolShape& tool, const Capsule& tube, double enough) {
    const double around = 0.5 * glm::length(tube.to - tube.from) + std::max(tube.radius_from, tube.radius_to);
    return signed_distance(tool, 0.5 * (tube.from + tube.to), around + enough) - around;
}

struct MovingDigit {
    const collision::ToolShape& tool;
    const hand::Hand& hand;
    const Pose& wrist;
    std::size_t number;
    std::array<double, 3> from{}, to{};  // rad, of its joints
    Angles angles;                       // the others' as measured
    hand::Skeleton joints;
    // Penetration of each sphere with the digit open (m, negative); it does not stop the digit.
    std::array<std::array<double, most_balls>, links> before{};
    std::array<std::array<Known, most_balls>, links> known{};  // on the way that it is on now

    // Of a link: its tube. The thumb's metacarpal, the first, is in the flesh of the palm and touches
    // nothing.
    [[nodiscard]] bool bare(std::size_t link) const { return number != 0 || link != 0; }
    [[nodiscard]] Capsule tube_of(std::size_t link) const {
        return hand::tube(hand, joints, number, link + (number == 0 ? 0 : 1));
    }

    void bend(const std::array<double, 3>& share) {
        const Three joint = joints_of(angles, number);
        for (std::size_t k = 0; k < 3; ++k) *joint.at[k] = from[k] + share[k] * (to[k] - from[k]);
        place_digit(hand, angles, wrist, number, joints);
    }

    [[nodiscard]] Vec3 joint_at(std::size_t k) const {
        return joints.position[digits[number].first + k + (number == 0 ? 0 : 1)];
    }

    // Upper bound (m) of the path of a point of a link while the fractions of the joints from `first` on grow
    // by 1.
    [[nodiscard]] double speed(std::size_t link, std::size_t first, const Vec3& at) const {
        double speed = 0.0;
        // The distance of a joint to the point is at most the length of the bones between them.
        double reach = glm::length(at - joint_at(link));
        for (std::size_t k = link + 1; k-- > 0;) {
            if (k < link) reach += glm::length(joint_at(k + 1) - joint_at(k));
            if (k >= first) speed += std::abs(to[k] - from[k]) * reach;
        }
        return speed;
    }
};

struct Room {
    double step = 1.0;                   // the share that may be added before anything can be `leap` deep
    bool free = true;                    // nothing is deeper than the tolerance
    std::size_t link = 0;                // that is deepest
    double deepest = infinite_distance;  // m, signed, beyond what was before
};

// At this share of the way, with the digit bent so. A ball that is surely further than `enough` from touching
// is not looked at again.
Room look(MovingDigit& digit, std::size_t first, double share, double enough) {
    Room room;
    const auto found = [&](std::size_t link, double deep, double speed) {
        room.step = std::min(room.step, std::max(deep + leap, 0.0) / std::max(speed, 1e-9));
        if (deep >= room.deepest) return;
        room.deepest = deep;
        room.link = link;
    };
    for (std::size_t link = 0; link < links; ++link) {
        if (!digit.bare(link)) continue;
        const Capsule tube = digit.tube_of(link);
        const double clear = clearance(digit.tool, tube, careful);
        if (clear > careful) {
            found(link, clear, digit.speed(link, first, tube.to));
            continue;
        }
        const std::size_t balls = balls_of(tube);
        for (std::size_t i = 0; i < balls; ++i) {
            const Ball ball = ball_of(tube, i, balls);
            const double speed = digit.speed(link, first, ball.at);
            Known& known = digit.known[link][i];
            const double surely = known.deep - speed * std::abs(share - known.share);
            if (surely > enough) {
                found(link, surely, speed);
                continue;
            }
            const double distance = signed_distance(digit.tool, ball.at, ball.radius + sure);
            known = {distance - ball.radius - digit.before[link][i], share};
            found(link, known.deep, speed);
        }
    }
    room.free = room.deepest >= -stop_tolerance;
    return room;
}

void remember_open(MovingDigit& digit) {
    digit.bend({0.0, 0.0, 0.0});
    for (std::size_t link = 0; link < links; ++link) {
        if (!digit.bare(link)) continue;
        const Capsule tube = digit.tube_of(link);
        if (clearance(digit.tool, tube, 0.0) > 0.0) continue;
        const std::size_t balls = balls_of(tube);
        for (std::size_t i = 0; i < balls; ++i) {
            const Ball ball = ball_of(tube, i, balls);
            digit.before[link][i] =
                std::min(0.0, signed_distance(digit.tool, ball.at, ball.radius) - ball.radius);
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
    for (auto& balls : digit.known) balls.fill({});
    bend_to(share);
    Room room = look(digit, first, share, sure);
    for (; share < 1.0 && stop.steps < max_steps; ++stop.steps) {
        double free = share, hit = std::min(1.0, share + room.step), above = room.deepest + stop_tolerance;
        bend_to(hit);
        room = look(digit, first, hit, sure);
        if (room.free) {
            share = hit;
            continue;
        }
        // Root finding for the contact: regula falsi with occasional bisection.
        double below = room.deepest + stop_tolerance;
        std::size_t link = room.link;
        for (int i = 0; i < most_guesses && above > exact; ++i) {
            const double part = i % 3 == 2 ? 0.5 : std::clamp(above / (above - below), 0.1, 0.9);
            const double guess = free + part * (hit - free);
            bend_to(guess);
            room = look(digit, first, guess, stop_tolerance);
            if (!room.free) link = room.link;
            (room.free ? free : hit) = guess;
            (room.free ? above : below) = room.deepest + stop_tolerance;
        }
        bend_to(free);
        return link;
    }
    return std::nullopt;
}

hand::FingertipContact nearest_of(const MovingDigit& digit) {
    hand::FingertipContact best;
    for (std::size_t link = 1; link < links; ++link) {
        const Capsule tube = digit.tube_of(link);
        const std::size_t balls = balls_of(tube);
        for (std::size_t i = 0; i < balls; ++i) {
            const Ball ball = ball_of(tube, i, balls);
            const collision::OctreeQuery seen = collision::query(digit.tool.octree, ball.at);
            if (seen.lower - ball.radius >= best.distance) continue;
            const double centre = signed_distance(digit.tool, ball.at, sight);
            if (centre >= sight || centre - ball.radius >= best.distance) continue;
            std::array<collision::SeparatingPlane, 1> side;
            const double band = std::abs(centre) + 1e-6;
            if (query_point(digit.tool.solid, ball.at, band, band, side).planes == 0) continue;
            best = {side[0].distance - ball.radius, side[0].point, side[0].normal};
        }
    }
    return best;
}

// True if the tool is out of reach of the whole hand.
bool out_of_reach(const collision::ToolShape& tool, const hand::Hand& hand, const Pose& wrist) {
    constexpr double reach = 0.24;  // m, of a hand of scale 1 with its flesh
    return glm::length(wrist.position - tool.solid.middle) > tool.solid.radius + hand.scale * reach;
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
        const Three joint = joints_of(digit.angles, number);
        for (std::size_t k = 0; k < 3; ++k) {
            digit.to[k] = *joint.at[k];
            digit.from[k] = std::min(digit.to[k], 0.0);  // bent back beyond straight: it stays there
        }
        if (number == 0) digit.from[0] = std::max(digit.to[0], hand::thumb_abduction_span.high);
        remember_open(digit);
        stop.share = {0.0, 0.0, 0.0};
        for (std::size_t first = 0; first < links;) {
            const auto link = advance(digit, first, stop);
            if (!link) break;
            stop.touches = true;
            first = std::max(first, *link) + 1;  // what is between the wrist and the part that touches stays
        }
        stop.nearest = nearest_of(digit);
        const Three shown = joints_of(closure.angles, number);
        for (std::size_t k = 0; k < 3; ++k) *shown.at[k] = *joint.at[k];
    }
    return closure;
}

}  // namespace bolt::hand
