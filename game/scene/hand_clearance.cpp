#include "game/scene/hand_clearance.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

namespace bolt::scene {

namespace {

constexpr double margin = 2.5e-3;     // m, distance that the search keeps
constexpr double follow_s = 0.12;     // s, time constant of `shown`
constexpr double stuck_depth = 1e-3;  // m, depth from which other starting points are tried
constexpr double good_enough = 3.0;   // mm², cost below which no other starting point is tried
constexpr double cuff_begin = 0.012, cuff_end = 0.064;  // m behind the wrist
constexpr double min_cuff = 0.1;                        // fraction of the cuff's length
constexpr double better = 0.8;  // cost ratio at which the result of another starting point becomes the goal
constexpr int steps_per_frame = 2, steps_per_start = 12;

constexpr std::size_t parameters = std::tuple_size_v<HandDeparture>;
// Limits of the departure. `scale`: the departure that costs as much as one point 1 mm within the margin.
struct DepartureRange {
    HandDeparture low, high, scale;
};
constexpr DepartureRange on_handle{{-1.3, -0.12, -0.12, -0.035, -0.9, -0.45},
                                   {1.3, 0.12, 0.12, 0.035, 0.9, 0.45},
                                   {0.35, 0.05, 0.05, 0.012, 0.35, 0.2}};
constexpr DepartureRange at_nut{{-0.7, -0.9, -1.7, 0.0, -0.9, -0.45},
                                {0.7, 0.9, 1.7, 0.012, 0.9, 0.45},
                                {0.3, 0.3, 0.5, 0.004, 0.35, 0.2}};

const DepartureRange& range_of(HandTask task) { return task == HandTask::on_handle ? on_handle : at_nut; }

Vec3 slide_axis(HandTask task) { return task == HandTask::on_handle ? Vec3(1, 0, 0) : Vec3(0, 0, 1); }

Quat turn_by(const HandDeparture& by) {
    const Vec3 vector(by[0], by[1], by[2]);
    const double angle = glm::length(vector);
    return angle < 1e-12 ? Quat(1, 0, 0, 0) : glm::angleAxis(angle, vector / angle);
}

using Matrices = std::array<glm::mat4, hand::joint_count>;

Matrices skin_matrices(const Pose& at, const hand::Skeleton& skeleton,
                       std::span<const glm::mat4> inverse_bind) {
    Matrices matrices{};
    for (std::size_t i = 0; i < std::min(inverse_bind.size(), matrices.size()); ++i) {
        const Pose joint = at * Pose{skeleton.position[i], skeleton.rotation[i]};
        matrices[i] =
            glm::mat4(glm::translate(glm::dmat4(1.0), joint.position) * glm::mat4_cast(joint.orientation)) *
            inverse_bind[i];
    }
    return matrices;
}

struct Evaluation {
    double cost = 0.0;            // mm²
    double depth = -margin;       // m, of the deepest point
    double hand_depth = -margin;  // m, without the cuff
    double cuff_free = cuff_end;  // m behind the wrist where the cuff enters a solid
    std::array<std::array<double, parameters>, parameters> normal{};
    std::array<double, parameters> gradient{};
};

class ClearanceSearch {
  public:
    ClearanceSearch(const HandSurroundings& around, const hand::Skeleton& posture)
        : around_(around), posture_(posture), range_(range_of(around.task)) {}

    [[nodiscard]] Evaluation evaluate(const HandDeparture& by) const {
        const hand::Skeleton skeleton = apply_departure(posture_, by, around_.task, around_.pivot);
        const Matrices matrices = skin_matrices(around_.at, skeleton, around_.inverse_bind);
        const Vec3 pivot = around_.at * around_.pivot;
        const Vec3 wrist = around_.at * skeleton.position[hand::wrist];
        const Quat wrist_turn = around_.at.orientation * skeleton.rotation[hand::wrist];
        const Vec3 slide = around_.at.orientation * slide_axis(around_.task);
        Evaluation found;
        for (const SkinPoint& point : around_.skin) {
            glm::vec3 skinned(0.0F);
            double wrist_weight = 0.0;
            for (int k = 0; k < 4; ++k) {
                if (point.weights[k] == 0.0F || point.joints[k] >= hand::joint_count) continue;
                skinned +=
                    point.weights[k] * glm::vec3(matrices[point.joints[k]] * glm::vec4(point.position, 1.0F));
                if (point.joints[k] == hand::wrist) wrist_weight += static_cast<double>(point.weights[k]);
            }
            const Vec3 at(skinned);
            Vec3 out(0.0);
            const double depth = penetration_depth(*around_.solids, at, margin, out);
            found.depth = std::max(found.depth, depth);
            const double behind_wrist = static_cast<double>(point.position.z);
            if (behind_wrist < cuff_begin)
                found.hand_depth = std::max(found.hand_depth, depth);
            else if (depth > 0.0)
                found.cuff_free = std::min(found.cuff_free, behind_wrist);
            if (depth <= -margin) continue;
            const double residual = 1e3 * (depth + margin);
            found.cost += residual * residual;
            std::array<double, parameters> slope{};
            for (int axis = 0; axis < 3; ++axis) {
                Vec3 unit(0.0);
                unit[axis] = 1.0;
                slope[static_cast<std::size_t>(axis)] =
                    glm::dot(out, glm::cross(around_.at.orientation * unit, at - pivot));
            }
            slope[3] = glm::dot(out, slide);
            slope[4] = wrist_weight * glm::dot(out, glm::cross(wrist_turn * Vec3(1, 0, 0), at - wrist));
            slope[5] = wrist_weight * glm::dot(out, glm::cross(wrist_turn * Vec3(0, 1, 0), at - wrist));
            for (std::size_t i = 0; i < parameters; ++i) slope[i] *= 1e3 * range_.scale[i];
            for (std::size_t i = 0; i < parameters; ++i) {
                found.gradient[i] += slope[i] * residual;
                for (std::size_t j = 0; j < parameters; ++j) found.normal[i][j] += slope[i] * slope[j];
            }
        }
        for (std::size_t i = 0; i < parameters; ++i) {
            const double u = by[i] / range_.scale[i];
            found.cost += u * u;
            found.gradient[i] -= u;
            found.normal[i][i] += 1.0;
        }
        return found;
    }

    // Improves `by` in place; the cost never increases.
    Evaluation improve(HandDeparture& by, int steps) const {
        Evaluation now = evaluate(by);
        double damping = 0.03;
        for (int step = 0; step < steps; ++step) {
            const HandDeparture next = stepped(by, now, damping);
            if (next == by) break;
            const Evaluation then = evaluate(next);
            if (then.cost < now.cost) {
                const bool done = now.cost - then.cost < 1e-4 * now.cost;
                by = next;
                now = then;
                damping = std::max(1e-3, 0.3 * damping);
                if (done) break;
            } else {
                damping = 8.0 * damping;
                if (damping > 1e3) break;
            }
        }
        return now;
    }

  private:
    [[nodiscard]] HandDeparture stepped(const HandDeparture& by, const Evaluation& at, double damping) const {
        auto a = at.normal;
        auto b = at.gradient;
        for (std::size_t i = 0; i < parameters; ++i) a[i][i] *= 1.0 + damping;
        // Gaussian elimination; the matrix is positive definite.
        for (std::size_t i = 0; i < parameters; ++i)
            for (std::size_t j = i + 1; j < parameters; ++j) {
                const double share = a[j][i] / a[i][i];
                for (std::size_t k = i; k < parameters; ++k) a[j][k] -= share * a[i][k];
                b[j] -= share * b[i];
            }
        HandDeparture next = by;
        for (std::size_t i = parameters; i-- > 0;) {
            for (std::size_t k = i + 1; k < parameters; ++k) b[i] -= a[i][k] * b[k];
            b[i] /= a[i][i];
        }
        for (std::size_t i = 0; i < parameters; ++i)
            next[i] = std::clamp(by[i] + b[i] * range_.scale[i], range_.low[i], range_.high[i]);
        return next;
    }

    const HandSurroundings& around_;
    const hand::Skeleton& posture_;
    const DepartureRange& range_;
};

constexpr std::array<HandDeparture, 7> starts_on_handle{{{},
                                                         {0.6, 0, 0, 0, 0, 0},
                                                         {-0.6, 0, 0, 0, 0, 0},
                                                         {1.1, 0, 0, 0, 0, 0},
                                                         {-1.1, 0, 0, 0, 0, 0},
                                                         {0, 0, 0, 0, 0.6, 0},
                                                         {0, 0, 0, 0, -0.6, 0}}};
constexpr std::array<HandDeparture, 12> starts_at_nut{{{},
                                                       {0, -0.6, 0, 0, 0, 0},
                                                       {0, 0, 0.8, 0, 0, 0},
                                                       {0, 0, -0.8, 0, 0, 0},
                                                       {0, -0.6, 0.8, 0, 0, 0},
                                                       {0, -0.6, -0.8, 0, 0, 0},
                                                       {0, 0, 1.5, 0, 0, 0},
                                                       {0, 0, -1.5, 0, 0, 0},
                                                       {0, -0.6, 1.5, 0, 0, 0},
                                                       {0, -0.6, -1.5, 0, 0, 0},
                                                       {0.5, -0.3, 0, 0, 0, 0},
                                                       {-0.5, -0.3, 0, 0, 0, 0}}};

std::span<const HandDeparture> starts_of(HandTask task) {
    if (task == HandTask::on_handle) return starts_on_handle;
    return starts_at_nut;
}

// The best result of all starting points; stops at the first that is good enough.
HandDeparture search_all_starts(const ClearanceSearch& search, HandTask task) {
    HandDeparture best{};
    double least = std::numeric_limits<double>::infinity();
    for (const HandDeparture& start : starts_of(task)) {
        HandDeparture by = start;
        const double cost = search.improve(by, steps_per_start).cost;
        if (cost < least) best = by;
        least = std::min(least, cost);
        if (least < good_enough) break;
    }
    return best;
}

// Refines the current starting point by one step. Its result becomes the goal if it is clearly better.
void refine_next_start(HandClearance& clearance, const ClearanceSearch& search, double cost) {
    if (clearance.start_steps == 0) clearance.candidate = starts_of(clearance.task)[clearance.start];
    const double found = search.improve(clearance.candidate, 1).cost;
    if (found < better * cost) clearance.goal = clearance.candidate;
    if (++clearance.start_steps < steps_per_start && found >= better * cost) return;
    clearance.start_steps = 0;
    clearance.start = (clearance.start + 1) % starts_of(clearance.task).size();
}

// The largest remaining departure from `shown` to the goal, in units of its scale.
double remaining(const HandClearance& clearance) {
    double furthest = 0.0;
    for (std::size_t i = 0; i < parameters; ++i)
        furthest = std::max(
            furthest, std::abs(clearance.goal[i] - clearance.shown[i]) / range_of(clearance.task).scale[i]);
    return furthest;
}

bool inputs_changed(const HandClearance& clearance, const HandSurroundings& around,
                    const hand::Skeleton& posture) {
    return clearance.task != around.task || clearance.at.position != around.at.position ||
           clearance.at.orientation != around.at.orientation ||
           clearance.posture.position != posture.position || clearance.posture.rotation != posture.rotation;
}

}  // namespace

std::vector<SkinPoint> sample_skin(const assets::Model& hand, std::size_t count) {
    std::vector<SkinPoint> all;
    for (const assets::Mesh& mesh : hand.meshes)
        for (const assets::Primitive& p : mesh.primitives) {
            if (p.joints.size() != p.positions.size() || p.weights.size() != p.positions.size()) continue;
            for (std::size_t i = 0; i < p.positions.size(); ++i)
                all.push_back({p.positions[i], p.joints[i], p.weights[i]});
        }
    if (all.size() <= count) return all;
    // Farthest-point sampling.
    std::vector<SkinPoint> chosen;
    std::vector<float> nearest(all.size(), std::numeric_limits<float>::infinity());
    std::size_t next = 0;
    while (chosen.size() < count) {
        chosen.push_back(all[next]);
        const glm::vec3 at = all[next].position;
        for (std::size_t i = 0; i < all.size(); ++i) {
            const glm::vec3 away = all[i].position - at;
            nearest[i] = std::min(nearest[i], glm::dot(away, away));
        }
        next = static_cast<std::size_t>(std::max_element(nearest.begin(), nearest.end()) - nearest.begin());
    }
    return chosen;
}

double penetration_depth(const collision::CollisionWorld& solids, const Vec3& point, double margin,
                         Vec3& out) {
    double deepest = -margin;
    for (const collision::Body& body : solids.bodies) {
        if (!body.enabled) continue;
        const collision::CollisionShape& shape = solids.shapes[body.shape];
        const Vec3 local = inverse(body.pose) * point;
        const Vec3 beside = glm::max(shape.solid.box.low - local, local - shape.solid.box.high);
        if (std::max({beside.x, beside.y, beside.z}) >= -deepest) continue;
        const collision::OctreeQuery bounds = collision::query(shape.octree, local);
        if (bounds.lower >= -deepest) continue;
        std::array<collision::SeparatingPlane, 1> plane;
        const collision::PointQueryResult near =
            collision::query_point(shape.solid, local, bounds.upper, margin, plane);
        if (near.planes == 0 || -near.distance <= deepest) continue;
        deepest = -near.distance;
        out = body.pose.orientation * plane[0].normal;
    }
    return deepest;
}

hand::Skeleton apply_departure(const hand::Skeleton& posture, const HandDeparture& by, HandTask task,
                               const Vec3& pivot) {
    if (by == HandDeparture{}) return posture;
    const Pose moved = Pose{pivot + by[3] * slide_axis(task), turn_by(by)} * Pose{-pivot};
    hand::Skeleton skeleton;
    for (std::size_t i = 0; i < hand::joint_count; ++i) {
        skeleton.position[i] = moved * posture.position[i];
        skeleton.rotation[i] = moved.orientation * posture.rotation[i];
    }
    Quat& wrist = skeleton.rotation[hand::wrist];
    wrist = wrist * glm::angleAxis(by[4], Vec3(1, 0, 0)) * glm::angleAxis(by[5], Vec3(0, 1, 0));
    return skeleton;
}

void advance(HandClearance& clearance, const HandSurroundings& around, const hand::Skeleton& posture,
             double seconds) {
    const bool changed = inputs_changed(clearance, around, posture);
    if (clearance.started && clearance.settled && !changed) return;
    const bool first = !clearance.started, other_task = clearance.task != around.task;
    clearance.started = true;
    clearance.task = around.task;
    clearance.at = around.at;
    clearance.posture = posture;
    const ClearanceSearch search(around, posture);
    const HandDeparture before = clearance.goal;
    bool stuck = false;
    if (first) {
        clearance.goal = clearance.shown = search_all_starts(search, around.task);
    } else {
        if (other_task) clearance.goal = {};
        if (other_task || changed) clearance.start_steps = 0;
        const Evaluation found = search.improve(clearance.goal, steps_per_frame);
        stuck = found.depth > stuck_depth;
        if (stuck) refine_next_start(clearance, search, found.cost);
    }
    const double share = 1.0 - std::exp(-seconds / follow_s);
    if (remaining(clearance) < 1e-3) {
        clearance.shown = clearance.goal;
    } else {
        for (std::size_t i = 0; i < parameters; ++i)
            clearance.shown[i] += share * (clearance.goal[i] - clearance.shown[i]);
    }
    const Evaluation drawn = search.evaluate(clearance.shown);
    clearance.depth = drawn.hand_depth;
    const double cuff = std::clamp((drawn.cuff_free - cuff_begin) / (cuff_end - cuff_begin), min_cuff, 1.0);
    clearance.cuff += (first ? 1.0 : share) * (cuff - clearance.cuff);
    if (std::abs(cuff - clearance.cuff) < 1e-3) clearance.cuff = cuff;
    clearance.settled = clearance.goal == before && clearance.shown == clearance.goal &&
                        clearance.cuff == cuff && !(stuck && clearance.start != 0);
}

}  // namespace bolt::scene
