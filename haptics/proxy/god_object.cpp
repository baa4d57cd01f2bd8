#include "haptics/proxy/god_object.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "haptics/proxy/constraint_solver.hpp"

namespace bolt::proxy {

namespace {

constexpr double negligible_motion = 1e-7;  // m: less motion than this is none
constexpr double fine = 50e-6;  // m: what is left after so short a motion can wait for the next tick
// m: so short a motion can wait itself, once there was another; of the greatest force it is less than half a
// per cent.
constexpr double finest = 25e-6;
// Of the energy of the coupling, which is twice the share of the force.
constexpr double imperceptible = 1e-3;
constexpr double beyond_skin = 50e-6;  // m: so much more is looked at than can hold it
constexpr double least_share = 0.2;    // of the skin: nearer than this is a penetration to be
constexpr double unseen = 250e-6;      // m: a feature is found before it is deeper than this
constexpr int attempts = 4;            // motions tried from a pose
constexpr int halvings = 24;

struct ContactQuery {
    std::array<collision::Contact, most_contacts> contacts;
    std::size_t count = 0;
    double nearest = 0.0;
    double limit = 0.0;  // nothing but the contacts is nearer
    std::uint32_t work = 0;
};

struct Rows {
    std::array<Constraint, most_constraints> rows;
    std::size_t count = 0;

    void add(const Constraint& row) {
        if (count < rows.size()) rows[count++] = row;
    }
};

bool finite(const Pose& p) {
    const Quat& q = p.orientation;
    const double sum = p.position.x + p.position.y + p.position.z + q.w + q.x + q.y + q.z;
    return std::isfinite(sum) && std::abs(glm::dot(q, q) - 1.0) < 1e-3;
}

ContactQuery query_contacts(ContactFinder finder, const Pose& pose, double band) {
    ContactQuery l;
    const collision::ContactQueryResult found = finder(pose, band, l.contacts);
    l.count = std::min(found.count, l.contacts.size());
    l.limit = l.nearest = found.clearance;
    l.work = found.work;
    for (std::size_t i = 0; i < l.count; ++i) l.nearest = std::min(l.nearest, l.contacts[i].distance);
    return l;
}

// One step in the making.
class Stepper {
  public:
    Stepper(const GodObjectParameters& parameters, const GodObjectState& before, const Pose& device,
            ContactFinder finder, double dt)
        : p_(parameters),
          before_(before),
          device_(device),
          finder_(finder),
          dt_(dt),
          pose_(before.tool),
          expected_(before.first_motion),
          recovery_left_(parameters.recovery * dt) {}

    GodObjectStep run() {
        const double way = travelled(twist_between(before_.device, device_));
        here_ = query(pose_, std::min(way, before_.free));
        recovering_ = here_.nearest < 0.0;
        set_change_limits();
        bool settled = false, arrived = false;
        while (!settled && !arrived) {
            const Advance advance = advance_once();
            settled = advance == Advance::held;
            arrived = advance == Advance::nowhere;
            if (advance == Advance::spent) break;
        }
        step_.spent = !settled && !arrived;
        step_.settled = settled;
        step_.nearest = here_.nearest;
        step_.contacts = here_.count;
        return step_;
    }

    [[nodiscard]] const Pose& pose() const { return pose_; }
    [[nodiscard]] Twist first_motion() const { return first_motion_.value_or(Twist{}); }
    [[nodiscard]] force::OutputCommand event_of(const force::OutputCommand& felt) const {
        return {force_.event_of(felt.force - before_.felt.force),
                torque_.event_of(felt.torque - before_.felt.torque)};
    }

  private:
    enum class Advance { moved, held, nowhere, spent };

    // How far a motion from here takes any point of the tool.
    [[nodiscard]] double travelled(const Twist& motion) const {
        return p_.box ? travel(motion, p_.radius, pose_.orientation, *p_.box) : travel(motion, p_.radius);
    }
    [[nodiscard]] bool is_less(const Twist& part, const Twist& motion) const {
        return travel(part, p_.radius) < travel(motion, p_.radius) * (1.0 - 1e-12);
    }

    // Wide bands are dear: one wider than a stride is asked only where it may be free, as far as the device
    // came in this tick. Then one query does.
    ContactQuery query(const Pose& pose, double free = 0.0) {
        const double band = std::clamp(free, p_.stride, p_.reach);
        const ContactQuery found = query_contacts(finder_, pose, band + p_.skin + beyond_skin);
        // Where the tick before ended is known to who remembers, and costs those who do not no motion.
        if (++step_.queries > 1 || band > p_.stride) charged_ += found.work;
        step_.work += found.work;
        return found;
    }

    // Before it has moved in this tick it may cost what it may: what is in the way is learnt by trying, and
    // forgotten by the next tick.
    [[nodiscard]] bool may_query() const {
        return step_.queries < p_.queries && (charged_ < p_.work || !has_moved_);
    }

    Twist solve(const Twist& wanted, const Rows& rows) {
        Twist motion = wanted;
        if (rows.count > 0) {
            const Metric metric{p_.coupling.stiffness, p_.coupling.torsion};
            const auto all = std::span(rows.rows).first(rows.count);
            motion = constrain(metric, wanted, all, {}, expected_).motion;
            ++step_.solves;
        }
        if (!first_motion_) first_motion_ = motion;
        expected_ = motion;
        return motion;
    }

    [[nodiscard]] Rows rows_here() const {
        Rows rows;
        for (std::size_t i = 0; i < here_.count; ++i) {
            const collision::Contact& c = here_.contacts[i];
            const Vec3& normal = c.smooth == Vec3(0.0) ? c.normal : c.smooth;
            rows.add({c.on_tool - pose_.position, normal, std::max(c.distance - p_.skin, -recovery_left_),
                      p_.friction});
        }
        return rows;
    }

    // How far the tool's point of a contact seen at another pose has come along its normal, from here to
    // there.
    [[nodiscard]] double approach(const collision::Contact& c, const Vec3& arm) const {
        return glm::dot(c.normal, c.on_tool - (pose_.position + arm));
    }
    // Where the tool's point of a contact seen at another pose is here, from the tool's origin.
    [[nodiscard]] Vec3 arm_here(const collision::Contact& c, const Pose& at) const {
        return pose_.orientation * (glm::conjugate(at.orientation) * (c.on_tool - at.position));
    }

    // Whether the motion there brings the tool too near. What it did not come nearer to was as near here,
    // unseen by a finder that knows features to a tolerance only: staying would not help, and the god-object
    // would be caught by what is not there to be got away from.
    [[nodiscard]] bool too_near(const ContactQuery& there, const Pose& at) const {
        const double least = std::min(least_share * p_.skin, here_.nearest);
        if (there.nearest >= least) return false;
        if (there.limit < least) return true;
        const auto contacts = std::span(there.contacts).first(there.count);
        return std::any_of(contacts.begin(), contacts.end(), [&](const collision::Contact& c) {
            const double by = approach(c, arm_here(c, at));
            return c.distance < least && (by < 0.0 || c.distance - by < -unseen);
        });
    }

    // What would be too near at `there` becomes a constraint on the motion from here: its plane, where it
    // stood in the way. From here every motion but standing still may be forbidden, never that.
    void cut(const ContactQuery& there, const Pose& at, Rows& rows) const {
        for (std::size_t i = 0; i < there.count; ++i) {
            const collision::Contact& c = there.contacts[i];
            if (c.distance >= p_.skin) continue;
            const Vec3 arm = arm_here(c, at);
            rows.add(
                {arm, c.normal,
                 std::max(c.distance - p_.skin - approach(c, arm), std::min(0.0, here_.nearest - p_.skin)),
                 p_.friction});
        }
    }

    // How the felt force or torque may change in this tick: by what the hand's own motion changes, or by any
    // part of it (contacts that take some directions and leave others bring its projections, which lie in the
    // ball over it: Thales), a little in any direction besides, and more where it has been going.
    struct ForceChangeLimit {
        Vec3 hand{0.0};
        Vec3 going{0.0};
        double event = 0.0;
        double whole = 0.0;

        // What of a change is neither the hand's own nor on the way that the force is going.
        [[nodiscard]] double beyond(const Vec3& change) const {
            const Vec3 from = change - 0.5 * hand;
            const double along = glm::dot(going, going);
            const double t = along > 0.0 ? std::clamp(glm::dot(from, going) / along, 0.0, 1.0) : 0.0;
            return glm::length(from - t * going) - 0.5 * glm::length(hand);
        }
        [[nodiscard]] double used(const Vec3& change, bool recovering) const {
            if (recovering) return glm::length(change) / std::max(whole, 1e-9);
            return std::max(beyond(change) / std::max(event, 1e-9),
                            glm::length(change) / std::max(whole, 1e-9));
        }
        [[nodiscard]] Vec3 event_of(const Vec3& change) const {
            const Vec3 from = change - 0.5 * hand;
            const double way = glm::length(from), own = 0.5 * glm::length(hand);
            return way > own ? from * (1.0 - own / way) : Vec3(0.0);
        }
    };
    [[nodiscard]] ForceChangeLimit change_limit(const Vec3& hand, const Vec3& before, double present,
                                                double greatest) const {
        const double ms = dt_ / 1e-3;
        const double event =
            ms * std::max(p_.rate_limits.of_rendered * present, p_.rate_limits.of_maximum * greatest);
        // Out of what has moved into the tool it goes as fast as what is felt may change at all.
        const double most = p_.rate_limits.maximum * greatest * ms;
        const double at_once = p_.rate_limits.at_once * event, along = event - at_once;
        const double was = glm::length(before);
        return {hand, was > along ? before * (along / was) : before, at_once,
                recovering_ ? most : std::min(most, event + glm::length(hand))};
    }

    void set_change_limits() {
        const proxy::Coupling& c = p_.coupling;
        // What the hand alone would change, were the tool held where it is.
        const force::OutputCommand held =
            proxy::coupling_force(c, proxy::offset_between(device_, before_.tool), before_.offset, dt_);
        force_ = change_limit(held.force - before_.felt.force, before_.event.force,
                              glm::length(before_.felt.force), c.force);
        torque_ = change_limit(held.torque - before_.felt.torque, before_.event.torque,
                               glm::length(before_.felt.torque), c.torque);
    }

    [[nodiscard]] force::OutputCommand change(const Twist& motion) const {
        const force::OutputCommand felt = proxy::coupling_force(
            p_.coupling, proxy::offset_between(device_, moved(pose_, motion)), before_.offset, dt_);
        return {felt.force - before_.felt.force, felt.torque - before_.felt.torque};
    }

    // The largest share that is not loud; if there is none, the quietest. Loudness has one valley.
    template <class Excess>
    static double largest_allowed_share(double share, const Excess& excess) {
        if (excess(share) <= 1.0) return share;
        double low = 0.0, high = share;
        for (int i = 0; i < halvings; ++i) {
            const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
            if (excess(a) <= excess(b))
                high = b;
            else
                low = a;
        }
        const double quietest = 0.5 * (low + high);
        if (excess(quietest) > 1.0) return quietest;
        low = quietest;
        high = share;
        for (int i = 0; i < halvings; ++i) {
            const double s = 0.5 * (low + high);
            (excess(s) <= 1.0 ? low : high) = s;
        }
        return low;
    }

    // The part of a motion, at most `share` of it, after which neither force nor torque has leapt. Way and
    // turn each go as far as they may where contacts let them: what a turn holds back would pull at the hand.
    [[nodiscard]] Twist rate_limited_part(const Twist& motion, double share, const Rows& rows) const {
        const auto force = [&](double s) { return force_.used(change(s * motion).force, recovering_); };
        const auto torque = [&](double s) { return torque_.used(change(s * motion).torque, recovering_); };
        if (std::max(force(share), torque(share)) <= 1.0) return share * motion;
        const Twist apart{largest_allowed_share(share, force) * motion.linear,
                          largest_allowed_share(share, torque) * motion.angular};
        const auto all = std::span(rows.rows).first(rows.count);
        const bool allowed = std::all_of(all.begin(), all.end(), [&](const Constraint& row) {
            return glm::dot(row.normal, apart.linear + glm::cross(apart.angular, row.arm)) >=
                   -std::max(row.slack, 0.0);
        });
        if (allowed) return apart;
        return largest_allowed_share(share, [&](double s) { return std::max(force(s), torque(s)); }) * motion;
    }

    [[nodiscard]] double energy_at(const Pose& pose) const {
        return proxy::stored_energy(p_.coupling, proxy::offset_between(device_, pose));
    }
    // Back whence it came, and nothing of it would be felt: of points beside each other the finder tells the
    // nearer, and the tool would rock between them until the queries are spent.
    [[nodiscard]] bool oscillates(const Twist& motion) const {
        const double back = p_.coupling.stiffness * glm::dot(motion.linear, last_motion_.linear) +
                            p_.coupling.torsion * glm::dot(motion.angular, last_motion_.angular);
        if (back >= 0.0) return false;
        const double energy = energy_at(pose_);
        return std::abs(energy_at(moved(pose_, motion)) - energy) < imperceptible * energy;
    }

    // Whether so little is left that another query is not worth it.
    [[nodiscard]] bool can_wait(const Twist& motion, double length) const {
        return !recovering_ && ((has_moved_ && length < finest) || oscillates(motion));
    }

    void arrive(const Pose& there, const Twist& by) {
        last_motion_ = by;
        has_moved_ = true;
        // What is left of it.
        expected_ = {expected_.linear - by.linear, expected_.angular - by.angular};
        recovery_left_ -= std::clamp(p_.skin - here_.nearest, 0.0, recovery_left_);
        pose_ = there;
    }

    // From here towards the device, once.
    Advance advance_once() {
        Rows rows = rows_here();
        const Twist wanted = twist_between(pose_, device_);
        const double certified = here_.nearest - p_.skin;
        double longest = std::max(p_.stride, certified);
        for (int attempt = 0; attempt < attempts; ++attempt) {
            const Twist motion = solve(wanted, rows);
            const double length = travelled(motion);
            if (length < negligible_motion || (attempt == 0 && can_wait(motion, length)))
                return Advance::nowhere;
            const double share = std::min(1.0, longest / length);
            const Twist part = rate_limited_part(motion, share, rows);
            const double way = travelled(part);
            const bool held = is_less(part, share * motion);
            const Pose there = moved(pose_, part);
            const bool with_device = travelled(twist_between(there, device_)) < negligible_motion;
            if (way <= certified) {
                arrive(there, part);
                here_.nearest -= way;
                if (held) return Advance::held;
                if (with_device) return Advance::nowhere;
                if (!may_query()) return Advance::spent;
                here_ = query(pose_);
                return Advance::moved;
            }
            if (!may_query()) return Advance::spent;
            const ContactQuery seen = query(there);
            if (!too_near(seen, there)) {
                arrive(there, part);
                here_ = seen;
                const bool close = !held && share == 1.0 && length < fine;
                return held ? Advance::held : with_device || close ? Advance::nowhere : Advance::moved;
            }
            cut(seen, there, rows);
            longest *= 0.5;
        }
        return Advance::spent;
    }

    const GodObjectParameters& p_;
    const GodObjectState& before_;
    const Pose& device_;
    ContactFinder finder_;
    double dt_;
    ForceChangeLimit force_, torque_;
    Pose pose_;
    ContactQuery here_;
    bool recovering_ = false;
    Twist last_motion_;  // the last motion of this tick
    Twist expected_;     // about what will be solved for next
    std::optional<Twist> first_motion_;
    bool has_moved_ = false;
    std::uint32_t charged_ = 0;   // of the work in this tick
    double recovery_left_ = 0.0;  // m in this tick
    GodObjectStep step_;
};

}  // namespace

GodObjectState start_god_object(const Pose& pose) {
    GodObjectState state;
    state.tool = pose;
    state.device = pose;
    return state;
}

GodObjectStep step_god_object(const GodObjectParameters& parameters, GodObjectState& state,
                              const Pose& device, ContactFinder finder, double dt) {
    if (!finite(device)) return {};
    Stepper stepper(parameters, state, device, finder, dt);
    const GodObjectStep step = stepper.run();
    state.tool = stepper.pose();
    state.first_motion = stepper.first_motion();
    const proxy::Offset offset = proxy::offset_between(device, state.tool);
    const force::OutputCommand felt = proxy::coupling_force(parameters.coupling, offset, state.offset, dt);
    state.event = stepper.event_of(felt);
    state.felt = felt;
    state.offset = offset;
    state.device = device;
    state.free = step.contacts == 0 ? std::numeric_limits<double>::infinity() : step.nearest;
    return step;
}

}  // namespace bolt::proxy
