#include "haptics/proxy/god_object.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "haptics/proxy/constraint_solver.hpp"

namespace bolt::proxy {

namespace {

constexpr double negligible_motion = 1e-7;  // m; a shorter motion counts as none
// m; a motion that nothing stopped and that is shorter than this ends the tick. Sliding that new contacts
// would permit waits for the next one.
constexpr double min_motion_to_continue = 50e-6;
// m; a further motion shorter than this waits for the next tick. It would change the force by less than 0.5 %
// of the greatest.
constexpr double min_further_motion = 25e-6;
// Share of the coupling's energy. The energy grows with the square of the force, so this is a change of the
// force by 0.05 %.
constexpr double imperceptible_energy = 1e-3;
constexpr double query_margin = 50e-6;       // m, margin of the query's band beyond the skin
constexpr double min_clearance_share = 0.2;  // of the skin; a motion that ends nearer is rejected
// m; a feature may overlap by up to this before the finder first reports it.
constexpr double finder_tolerance = 250e-6;
// m; a greater violation (ConstrainedMotion) means that constraints contradict each other.
constexpr double contradiction = 1e-6;
constexpr int max_attempts = 4;  // motions tried from a pose
constexpr int search_iterations = 24;

struct ContactQuery {
    std::array<collision::Contact, max_contacts> contacts;
    std::size_t count = 0;
    double nearest = 0.0;
    double limit = 0.0;  // m; nothing except the contacts is nearer
    std::uint32_t cost = 0;
};

struct ConstraintSet {
    std::array<Constraint, max_constraints> rows;
    std::size_t count = 0;

    void add(const Constraint& row) {
        if (count < rows.size()) rows[count++] = row;
    }
    // Relaxes the constraints that `motion` violates, so that it satisfies them with `margin` (m) to spare.
    void relax_to(const Twist& motion, double margin) {
        for (Constraint& row : std::span(rows).first(count)) {
            const double away = glm::dot(row.normal, motion.linear + glm::cross(motion.angular, row.arm));
            if (away + row.slack < 0.0) row.slack = margin - away;
        }
    }
};

bool finite(const Pose& p) {
    const Quat& q = p.orientation;
    const double sum = p.position.x + p.position.y + p.position.z + q.w + q.x + q.y + q.z;
    return std::isfinite(sum) && std::abs(glm::dot(q, q) - 1.0) < 1e-3;
}

ContactQuery query_contacts(ContactFinder finder, const Pose& pose, double band) {
    ContactQuery query;
    const collision::ContactQueryResult found = finder(pose, band, query.contacts);
    query.count = std::min(found.count, query.contacts.size());
    query.limit = query.nearest = found.complete_within;
    query.cost = found.query_cost;
    for (std::size_t i = 0; i < query.count; ++i)
        query.nearest = std::min(query.nearest, query.contacts[i].distance);
    return query;
}

// Computes one step.
class Stepper {
  public:
    Stepper(const GodObjectParameters& parameters, const GodObjectState& before, const Pose& commanded_tool,
            ContactFinder finder, double dt)
        : p_(parameters),
          before_(before),
          commanded_tool_(commanded_tool),
          finder_(finder),
          dt_(dt),
          pose_(before.constrained_tool),
          guess_(before.first_motion),
          recovery_left_(parameters.recovery_speed * dt) {}

    GodObjectStep run() {
        const double displacement = travel_bound(twist_between(before_.commanded_tool, commanded_tool_));
        current_query_ = query(pose_, std::min(displacement, before_.nearest_contact));
        recovering_ = current_query_.nearest < 0.0;
        set_change_limits();
        bool rate_limited = false, arrived = false;
        while (!rate_limited && !arrived) {
            const AdvanceResult advance = advance_once();
            rate_limited = advance == AdvanceResult::rate_limited;
            arrived = advance == AdvanceResult::arrived;
            if (advance == AdvanceResult::cut_short) break;
        }
        step_.cut_short = !rate_limited && !arrived;
        step_.rate_limited = rate_limited;
        step_.nearest = current_query_.nearest;
        step_.contacts = current_query_.count;
        return step_;
    }

    [[nodiscard]] const Pose& pose() const { return pose_; }
    [[nodiscard]] Twist first_motion() const { return first_motion_.value_or(Twist{}); }
    [[nodiscard]] force::OutputCommand tool_change_of(const force::OutputCommand& rendered) const {
        return {force_.tool_change_of(rendered.force - before_.rendered.force),
                torque_.tool_change_of(rendered.torque - before_.rendered.torque)};
    }

  private:
    enum class AdvanceResult { moved, rate_limited, arrived, cut_short };

    // Upper bound (m) of the distance that any point of the tool travels in a motion from the current pose.
    [[nodiscard]] double travel_bound(const Twist& motion) const {
        return p_.box ? travel(motion, p_.radius, pose_.orientation, *p_.box) : travel(motion, p_.radius);
    }
    [[nodiscard]] bool is_shorter(const Twist& part, const Twist& motion) const {
        return travel(part, p_.radius) < travel(motion, p_.radius) * (1.0 - 1e-12);
    }

    // Queries the contacts at a pose. A wide band is expensive, so it is wider than a stride only if the
    // surroundings may be free that far; one query then suffices for the whole tick.
    ContactQuery query(const Pose& pose, double free = 0.0) {
        const double band = std::clamp(free, p_.stride, p_.max_band);
        const ContactQuery found = query_contacts(finder_, pose, band + p_.skin + query_margin);
        // The first query, at the pose where the last tick ended, is not charged if its band is one stride. A
        // finder with a cache answers it without cost, and the motion must not depend on whether the finder
        // has a cache. A wider band is charged, because it replaces later queries.
        if (++step_.queries > 1 || band > p_.stride) charged_cost_ += found.cost;
        step_.query_cost += found.cost;
        return found;
    }

    // Before the first motion of a tick the cost is unlimited, because obstacles found by rejected motions
    // are not remembered in the next tick.
    [[nodiscard]] bool may_query() const {
        return step_.queries < p_.max_queries && (charged_cost_ < p_.max_query_cost || !has_moved_);
    }

    ConstrainedMotion constrain_once(const Twist& wanted, const ConstraintSet& rows) {
        const Metric metric{p_.coupling.stiffness, p_.coupling.torsion};
        ++step_.solves;
        return constrain(metric, wanted, std::span(rows.rows).first(rows.count), {}, guess_);
    }

    Twist solve(const Twist& wanted, ConstraintSet& rows) {
        Twist motion = wanted;
        if (rows.count > 0) {
            ConstrainedMotion found = constrain_once(wanted, rows);
            if (p_.allows_narrow_gaps && found.violation > contradiction) {
                // The motion with the least violation goes to the middle of the gap.
                rows.relax_to(found.motion, contradiction);
                found = constrain_once(wanted, rows);
            }
            motion = found.motion;
        }
        if (!first_motion_) first_motion_ = motion;
        guess_ = motion;
        return motion;
    }

    [[nodiscard]] ConstraintSet constraints_at_pose() const {
        ConstraintSet rows;
        for (std::size_t i = 0; i < current_query_.count; ++i) {
            const collision::Contact& c = current_query_.contacts[i];
            const Vec3& normal = c.smooth == Vec3(0.0) ? c.normal : c.smooth;
            rows.add({c.on_tool - pose_.position, normal, std::max(c.distance - p_.skin, -recovery_left_),
                      p_.friction_coefficient});
        }
        return rows;
    }

    // Returns how far (m) the contact's point on the tool moves along the contact normal when the tool moves
    // from the current pose to the pose at which the contact was found. `arm`: as arm_at_pose() returns.
    [[nodiscard]] double displacement_along_normal(const collision::Contact& c, const Vec3& arm) const {
        return glm::dot(c.normal, c.on_tool - (pose_.position + arm));
    }
    // Returns the vector (m) from the tool's origin to the contact's point on the tool, with the tool at the
    // current pose. The contact was found at the pose `at`.
    [[nodiscard]] Vec3 arm_at_pose(const collision::Contact& c, const Pose& at) const {
        return pose_.orientation * (glm::conjugate(at.orientation) * (c.on_tool - at.position));
    }

    // Returns true if the motion to `at` brings the tool too near to an obstacle. Contacts that are
    // no nearer at `at` than at the current pose are exempt: the query at the current pose, which has a
    // tolerance, missed them. Rejecting the motion because of them would only trap the god-object.
    [[nodiscard]] bool too_near(const ContactQuery& query, const Pose& at) const {
        const double least = std::min(min_clearance_share * p_.skin, current_query_.nearest);
        if (query.nearest >= least) return false;
        if (query.limit < least) return true;
        const auto contacts = std::span(query.contacts).first(query.count);
        return std::any_of(contacts.begin(), contacts.end(), [&](const collision::Contact& c) {
            const double by = displacement_along_normal(c, arm_at_pose(c, at));
            return c.distance < least && (by < 0.0 || c.distance - by < -finder_tolerance);
        });
    }

    // Converts the contacts of `query` into constraints on the motion from the current pose. Standing still
    // satisfies them unless the tool is within the skin already; then the tool must retreat by at most the
    // missing part of the skin.
    void add_blocking_constraints(const ContactQuery& query, const Pose& at, ConstraintSet& rows) const {
        for (std::size_t i = 0; i < query.count; ++i) {
            const collision::Contact& c = query.contacts[i];
            if (c.distance >= p_.skin) continue;
            const Vec3 arm = arm_at_pose(c, at);
            rows.add({arm, c.normal,
                      std::max(c.distance - p_.skin - displacement_along_normal(c, arm),
                               std::min(0.0, current_query_.nearest - p_.skin)),
                      p_.friction_coefficient});
        }
    }

    // Limits of the change of the rendered force or torque in this tick. The permitted change is the sum of
    // three parts:
    //   - the change due to the hand's motion, or a projection of it, because contacts constrain some
    //     directions only. By Thales the projections lie in the ball whose diameter is that change;
    //   - up to `any_direction` in every direction;
    //   - a part along the trend of the last tick.
    struct ForceChangeLimit {
        Vec3 hand{0.0};              // change due to the hand's motion with the tool held
        Vec3 trend{0.0};             // permitted change along the tool's part of the last tick's change
        double any_direction = 0.0;  // permitted change in any direction
        double total_limit = 0.0;    // limit of the whole change

        // Size of the part of a change that neither the hand's motion nor the trend explains.
        [[nodiscard]] double excess(const Vec3& change) const {
            const Vec3 from = change - 0.5 * hand;
            const double along = glm::dot(trend, trend);
            const double t = along > 0.0 ? std::clamp(glm::dot(from, trend) / along, 0.0, 1.0) : 0.0;
            return glm::length(from - t * trend) - 0.5 * glm::length(hand);
        }
        [[nodiscard]] double utilisation(const Vec3& change, bool recovering) const {
            if (recovering) return glm::length(change) / std::max(total_limit, 1e-9);
            return std::max(excess(change) / std::max(any_direction, 1e-9),
                            glm::length(change) / std::max(total_limit, 1e-9));
        }
        [[nodiscard]] Vec3 tool_change_of(const Vec3& change) const {
            const Vec3 from = change - 0.5 * hand;
            const double size = glm::length(from), own = 0.5 * glm::length(hand);
            return size > own ? from * (1.0 - own / size) : Vec3(0.0);
        }
    };
    [[nodiscard]] ForceChangeLimit change_limit(const Vec3& hand, const Vec3& before, double present,
                                                double greatest) const {
        const double ms = dt_ / 1e-3;
        const double tool_change = ms * std::max(p_.rate_limits.tool_share_of_rendered * present,
                                                 p_.rate_limits.tool_share_of_maximum * greatest);
        // While the tool is pushed out of an obstacle only the total limit applies.
        const double most = p_.rate_limits.total_share_of_maximum * greatest * ms;
        const double any_direction = p_.rate_limits.any_direction_share * tool_change,
                     along = tool_change - any_direction;
        const double was = glm::length(before);
        return {hand, was > along ? before * (along / was) : before, any_direction,
                recovering_ ? most : std::min(most, tool_change + glm::length(hand))};
    }

    void set_change_limits() {
        const proxy::Coupling& c = p_.coupling;
        // The change that the hand's motion would cause with the tool held in place.
        const force::OutputCommand if_held = proxy::coupling_force(
            c, proxy::offset_between(commanded_tool_, before_.constrained_tool), before_.offset, dt_);
        force_ = change_limit(if_held.force - before_.rendered.force, before_.tool_change.force,
                              glm::length(before_.rendered.force), c.max_force);
        torque_ = change_limit(if_held.torque - before_.rendered.torque, before_.tool_change.torque,
                               glm::length(before_.rendered.torque), c.max_torque);
    }

    [[nodiscard]] force::OutputCommand change(const Twist& motion) const {
        const force::OutputCommand rendered = proxy::coupling_force(
            p_.coupling, proxy::offset_between(commanded_tool_, moved(pose_, motion)), before_.offset, dt_);
        return {rendered.force - before_.rendered.force, rendered.torque - before_.rendered.torque};
    }

    // The largest share ≤ `share` with `utilisation` ≤ 1; if there is none, the share with the smallest
    // `utilisation`, which must have a single minimum (ternary search, then bisection).
    template <class Utilisation>
    static double largest_allowed_share(double share, const Utilisation& utilisation) {
        if (utilisation(share) <= 1.0) return share;
        double low = 0.0, high = share;
        for (int i = 0; i < search_iterations; ++i) {
            const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
            if (utilisation(a) <= utilisation(b))
                high = b;
            else
                low = a;
        }
        const double best = 0.5 * (low + high);
        if (utilisation(best) > 1.0) return best;
        low = best;
        high = share;
        for (int i = 0; i < search_iterations; ++i) {
            const double s = 0.5 * (low + high);
            (utilisation(s) <= 1.0 ? low : high) = s;
        }
        return low;
    }

    // The part of a motion, at most `share` of it, that keeps the changes of force and torque within their
    // limits. Translation and rotation are limited separately if the constraints permit that, so that a
    // limited rotation does not hold back the translation.
    [[nodiscard]] Twist rate_limited_part(const Twist& motion, double share,
                                          const ConstraintSet& rows) const {
        const auto force = [&](double s) {
            return force_.utilisation(change(s * motion).force, recovering_);
        };
        const auto torque = [&](double s) {
            return torque_.utilisation(change(s * motion).torque, recovering_);
        };
        if (std::max(force(share), torque(share)) <= 1.0) return share * motion;
        const Twist separate{largest_allowed_share(share, force) * motion.linear,
                             largest_allowed_share(share, torque) * motion.angular};
        const auto all = std::span(rows.rows).first(rows.count);
        const bool allowed = std::all_of(all.begin(), all.end(), [&](const Constraint& row) {
            return glm::dot(row.normal, separate.linear + glm::cross(separate.angular, row.arm)) >=
                   -std::max(row.slack, 0.0);
        });
        if (allowed) return separate;
        return largest_allowed_share(share, [&](double s) { return std::max(force(s), torque(s)); }) * motion;
    }

    [[nodiscard]] double energy_at(const Pose& pose) const {
        return proxy::stored_energy(p_.coupling, proxy::offset_between(commanded_tool_, pose));
    }
    // Returns true if the motion reverses the last one with an imperceptible change of energy. The finder
    // returns the nearest of adjacent points, between which the tool would otherwise rock until the query
    // budget is exhausted.
    [[nodiscard]] bool oscillates(const Twist& motion) const {
        const double back = p_.coupling.stiffness * glm::dot(motion.linear, last_motion_.linear) +
                            p_.coupling.torsion * glm::dot(motion.angular, last_motion_.angular);
        if (back >= 0.0) return false;
        const double energy = energy_at(pose_);
        return std::abs(energy_at(moved(pose_, motion)) - energy) < imperceptible_energy * energy;
    }

    // Returns true if the remaining motion is not worth another query.
    [[nodiscard]] bool is_negligible(const Twist& motion, double length) const {
        return !recovering_ && ((has_moved_ && length < min_further_motion) || oscillates(motion));
    }

    void accept(const Pose& pose, const Twist& motion) {
        last_motion_ = motion;
        has_moved_ = true;
        // The remaining motion.
        guess_ = {guess_.linear - motion.linear, guess_.angular - motion.angular};
        recovery_left_ -= std::clamp(p_.skin - current_query_.nearest, 0.0, recovery_left_);
        pose_ = pose;
    }

    // Performs one motion from the current pose towards the commanded pose.
    AdvanceResult advance_once() {
        ConstraintSet rows = constraints_at_pose();
        const Twist wanted = twist_between(pose_, commanded_tool_);
        const double certified = current_query_.nearest - p_.skin;
        double longest = std::max(p_.stride, certified);
        for (int attempt = 0; attempt < max_attempts; ++attempt) {
            const Twist motion = solve(wanted, rows);
            const double length = travel_bound(motion);
            if (length < negligible_motion || (attempt == 0 && is_negligible(motion, length)))
                return AdvanceResult::arrived;
            const double share = std::min(1.0, longest / length);
            const Twist part = rate_limited_part(motion, share, rows);
            const double displacement = travel_bound(part);
            const bool rate_limited = is_shorter(part, share * motion);
            const Pose next = moved(pose_, part);
            const bool at_commanded_pose =
                travel_bound(twist_between(next, commanded_tool_)) < negligible_motion;
            if (displacement <= certified) {
                accept(next, part);
                current_query_.nearest -= displacement;
                if (rate_limited) return AdvanceResult::rate_limited;
                if (at_commanded_pose) return AdvanceResult::arrived;
                if (!may_query()) return AdvanceResult::cut_short;
                current_query_ = query(pose_);
                return AdvanceResult::moved;
            }
            if (!may_query()) return AdvanceResult::cut_short;
            const ContactQuery next_query = query(next);
            if (!too_near(next_query, next)) {
                accept(next, part);
                current_query_ = next_query;
                const bool near_enough = !rate_limited && share == 1.0 && length < min_motion_to_continue;
                return rate_limited                       ? AdvanceResult::rate_limited
                       : at_commanded_pose || near_enough ? AdvanceResult::arrived
                                                          : AdvanceResult::moved;
            }
            add_blocking_constraints(next_query, next, rows);
            longest *= 0.5;
        }
        return AdvanceResult::cut_short;
    }

    const GodObjectParameters& p_;
    const GodObjectState& before_;
    const Pose& commanded_tool_;
    ContactFinder finder_;
    double dt_;
    ForceChangeLimit force_, torque_;
    Pose pose_;
    ContactQuery current_query_;
    bool recovering_ = false;
    Twist last_motion_;  // the last motion of this tick
    Twist guess_;        // initial guess of the next solve
    std::optional<Twist> first_motion_;
    bool has_moved_ = false;
    std::uint32_t charged_cost_ = 0;  // cost charged to this tick's budget
    double recovery_left_ = 0.0;      // m of recovery left in this tick
    GodObjectStep step_;
};

}  // namespace

GodObjectState start_god_object(const Pose& pose) {
    GodObjectState state;
    state.constrained_tool = pose;
    state.commanded_tool = pose;
    return state;
}

GodObjectStep step_god_object(const GodObjectParameters& parameters, GodObjectState& state,
                              const Pose& commanded_tool, ContactFinder finder, double dt) {
    if (!finite(commanded_tool)) return {};
    Stepper stepper(parameters, state, commanded_tool, finder, dt);
    const GodObjectStep step = stepper.run();
    state.constrained_tool = stepper.pose();
    state.first_motion = stepper.first_motion();
    const proxy::Offset offset = proxy::offset_between(commanded_tool, state.constrained_tool);
    const force::OutputCommand rendered =
        proxy::coupling_force(parameters.coupling, offset, state.offset, dt);
    state.tool_change = stepper.tool_change_of(rendered);
    state.rendered = rendered;
    state.offset = offset;
    state.commanded_tool = commanded_tool;
    state.nearest_contact = step.contacts == 0 ? std::numeric_limits<double>::infinity() : step.nearest;
    return step;
}

}  // namespace bolt::proxy
