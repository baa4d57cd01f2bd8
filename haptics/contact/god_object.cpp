#include "haptics/contact/god_object.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "haptics/contact/constraint_solver.hpp"

namespace bolt::contact {

namespace {

constexpr double still = 1e-7;       // m: less motion than this is none
constexpr double fine = 50e-6;       // m: what is left after so short a motion can wait for the next tick
constexpr double least_share = 0.2;  // of the skin: nearer than this is a penetration to be
constexpr double unseen = 250e-6;    // m: a feature is found before it is deeper than this
constexpr int attempts = 4;          // motions tried from a pose
constexpr int halvings = 24;

struct Look {
    std::array<Contact, most_contacts> contacts;
    std::size_t count = 0;
    double nearest = 0.0;
    double limit = 0.0;  // nothing but the contacts is nearer
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

Look look(Finder finder, const Pose& pose, double band) {
    Look l;
    const Found found = finder(pose, band, l.contacts);
    l.count = std::min(found.count, l.contacts.size());
    l.limit = l.nearest = found.clearance;
    for (std::size_t i = 0; i < l.count; ++i) l.nearest = std::min(l.nearest, l.contacts[i].distance);
    return l;
}

// One step in the making.
class Stepper {
  public:
    Stepper(const GodObjectParameters& parameters, const GodObjectState& before, const Pose& device,
            Finder finder, double dt)
        : p_(parameters),
          before_(before),
          device_(device),
          finder_(finder),
          dt_(dt),
          pose_(before.tool),
          recovery_left_(parameters.recovery * dt) {
        const Twist own = twist_between(before.device, device);
        // As far as the device came in this tick: where nothing is near, one query does. Wide bands are dear.
        band_ = std::clamp(travel(own, p_.radius), p_.stride, p_.reach) + 2.0 * p_.skin;
        const double ms = dt / 1e-3;
        const auto limit = [&](double present, double greatest, double hand) {
            const double event = std::max(p_.quiet.of_present * present, p_.quiet.of_greatest * greatest);
            return std::min(p_.quiet.at_most * greatest * ms, event * ms + hand);
        };
        const force::Coupling& c = p_.coupling;
        force_limit_ = limit(glm::length(before.felt.force), c.force, c.stiffness * glm::length(own.linear));
        torque_limit_ =
            limit(glm::length(before.felt.torque), c.torque, c.torsion * glm::length(own.angular));
    }

    GodObjectStep run() {
        here_ = ask(pose_);
        recovering_ = here_.nearest < 0.0;
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

  private:
    enum class Advance { moved, held, nowhere, spent };

    Look ask(const Pose& pose) {
        ++step_.queries;
        return look(finder_, pose, band_);
    }

    [[nodiscard]] bool may_ask() const { return step_.queries < p_.queries; }

    Twist solve(const Twist& wanted, const Rows& rows) {
        if (rows.count == 0) return wanted;
        ++step_.solves;
        const Metric metric{p_.coupling.stiffness, p_.coupling.torsion};
        return constrain(metric, wanted, std::span(rows.rows.data(), rows.count)).motion;
    }

    [[nodiscard]] Rows rows_here() const {
        Rows rows;
        for (std::size_t i = 0; i < here_.count; ++i) {
            const Contact& c = here_.contacts[i];
            rows.add({c.on_tool - pose_.position, c.normal, std::max(c.distance - p_.skin, -recovery_left_),
                      p_.friction});
        }
        return rows;
    }

    // How far the tool's point of a contact seen at another pose has come along its normal, from here to
    // there.
    [[nodiscard]] double came(const Contact& c, const Vec3& arm) const {
        return glm::dot(c.normal, c.on_tool - (pose_.position + arm));
    }
    // Where the tool's point of a contact seen at another pose is here, from the tool's origin.
    [[nodiscard]] Vec3 arm_here(const Contact& c, const Pose& at) const {
        return pose_.orientation * (glm::conjugate(at.orientation) * (c.on_tool - at.position));
    }

    // Whether the motion there brings the tool too near. What it did not come nearer to was as near here,
    // unseen by a finder that knows features to a tolerance only: staying would not help, and the god-object
    // would be caught by what is not there to be got away from.
    [[nodiscard]] bool too_near(const Look& there, const Pose& at) const {
        const double least = std::min(least_share * p_.skin, here_.nearest);
        if (there.nearest >= least) return false;
        if (there.limit < least) return true;
        const auto contacts = std::span(there.contacts).first(there.count);
        return std::any_of(contacts.begin(), contacts.end(), [&](const Contact& c) {
            const double by = came(c, arm_here(c, at));
            return c.distance < least && (by < 0.0 || c.distance - by < -unseen);
        });
    }

    // What would be too near at `there` becomes a constraint on the motion from here: its plane, where it
    // stood in the way. From here every motion but standing still may be forbidden, never that.
    void cut(const Look& there, const Pose& at, Rows& rows) const {
        for (std::size_t i = 0; i < there.count; ++i) {
            const Contact& c = there.contacts[i];
            if (c.distance >= p_.skin) continue;
            const Vec3 arm = arm_here(c, at);
            rows.add({arm, c.normal,
                      std::max(c.distance - p_.skin - came(c, arm), std::min(0.0, here_.nearest - p_.skin)),
                      p_.friction});
        }
    }

    [[nodiscard]] double too_loud(const Pose& tool) const {
        const force::OutputCommand felt =
            force::coupling_force(p_.coupling, force::offset_between(device_, tool), before_.offset, dt_);
        const double force = glm::length(felt.force - before_.felt.force) / std::max(force_limit_, 1e-9);
        const double torque = glm::length(felt.torque - before_.felt.torque) / std::max(torque_limit_, 1e-9);
        return std::max(force, torque);
    }

    // The largest share of the motion after which the force has not leapt; if there is none, the quietest.
    [[nodiscard]] double quiet_share(const Twist& motion, double share) const {
        const auto loud = [&](double s) { return too_loud(moved(pose_, s * motion)); };
        if (recovering_ || loud(share) <= 1.0) return share;
        double low = 0.0, high = share;
        for (int i = 0; i < halvings; ++i) {
            const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
            if (loud(a) <= loud(b))
                high = b;
            else
                low = a;
        }
        const double quietest = 0.5 * (low + high);
        if (loud(quietest) > 1.0) return quietest;
        low = quietest;
        high = share;
        for (int i = 0; i < halvings; ++i) {
            const double s = 0.5 * (low + high);
            (loud(s) <= 1.0 ? low : high) = s;
        }
        return low;
    }

    void arrive(const Pose& there) {
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
            const double length = travel(motion, p_.radius);
            if (length < still) return Advance::nowhere;
            const double share = std::min(1.0, longest / length);
            const double quiet = quiet_share(motion, share);
            const bool held = quiet < share;
            const Pose there = moved(pose_, quiet * motion);
            const bool with_device = travel(twist_between(there, device_), p_.radius) < still;
            if (quiet * length <= certified) {
                arrive(there);
                here_.nearest -= quiet * length;
                if (held) return Advance::held;
                if (with_device) return Advance::nowhere;
                if (!may_ask()) return Advance::spent;
                here_ = ask(pose_);
                return Advance::moved;
            }
            if (!may_ask()) return Advance::spent;
            const Look seen = ask(there);
            if (!too_near(seen, there)) {
                arrive(there);
                here_ = seen;
                const bool close = quiet == 1.0 && length < fine;
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
    Finder finder_;
    double dt_;
    double band_ = 0.0;
    double force_limit_ = 0.0;
    double torque_limit_ = 0.0;
    Pose pose_;
    Look here_;
    bool recovering_ = false;
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
                              const Pose& device, Finder finder, double dt) {
    if (!finite(device)) return {};
    Stepper stepper(parameters, state, device, finder, dt);
    const GodObjectStep step = stepper.run();
    state.tool = stepper.pose();
    const force::Offset offset = force::offset_between(device, state.tool);
    state.felt = force::coupling_force(parameters.coupling, offset, state.offset, dt);
    state.offset = offset;
    state.device = device;
    return step;
}

}  // namespace bolt::contact
