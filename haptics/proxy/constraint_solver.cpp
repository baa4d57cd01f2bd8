#include "haptics/proxy/constraint_solver.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace bolt::proxy {

// Augmented Lagrangian method; each subproblem is solved by a semismooth Newton method with an exact line
// search. There are six unknowns for any number of contacts, and the Hessian (identity plus the contacts) is
// never singular, so redundant rows do no harm. Sources: Li, Sun and Toh, SIAM J. Optim. 28(1), 2018 for the
// method; Castro, Permenter and Han, IEEE T-RO 39(2), 2023 for friction cones as projections in such a Newton
// method.
//
// Coulomb's law is not the optimum of a convex problem: with the cone alone a slipping contact would lift off
// by friction × slip. De Saxcé's correction (de Saxcé and Feng, Math. Comput. Modelling 28, 1998) compensates
// this lift as slack, computed from the slip of the last round. This fixed-point iteration diverges for
// a part between two jaws: the lift at one side, amplified by a lever arm, is slip at the other. Irons and
// Tuck's relaxation (Int. J. Numer. Methods Eng. 1, 1969; "Aitken" in Küttler and Wall, Comput. Mech. 43,
// 2008) makes it converge.
//
// The forces of contradicting rows grow without bound while the motion converges, so convergence is judged by
// the motion and not by the forces.
//
// Units: forces in metres (divided by the linear stiffness), rotations in metres (times the metric's length).

namespace {

// Penalty of a contact's violation relative to the weight 1 of the deviation. Without a warm start it grows
// tenfold per round, because Newton's method converges faster on a smoother cost.
constexpr double first_penalty = 10.0, penalty_cold = 1e3, penalty_warm = 1e4;
constexpr int max_full_rounds = 8;         // updates of multipliers and slip slacks at the full penalty
constexpr int max_newton_steps = 16;       // per round
constexpr int max_search_steps = 16;       // steps of the line search
constexpr double final_tolerance = 1e-9;   // m
constexpr double coarse_tolerance = 1e-6;  // m, gradient while the penalty grows
constexpr double motion_tolerance = 1e-7;  // m, < 1 mN with the stiffest coupling; between two rounds
constexpr double initial_relaxation = 0.7, min_relaxation = 0.3;  // of the slip slack

using Vec6 = std::array<double, 6>;

struct Row {
    Vec3 arm{0.0};  // in units of the metric's length
    Vec3 normal{0.0};
    double slack = 0.0;
    double friction_coefficient = 0.0;
    double slip_slack = 0.0;     // m, slack that compensates the lift of a slipping contact
    double slack_deficit = 0.0;  // m by which `slip_slack` was too small in the last round
    Vec3 force{0.0};             // the multiplier
    Vec3 trial_force{0.0};       // multiplier − penalty × gap at the current motion
    Vec3 projected_force{0.0};   // `trial_force` projected to the friction cone
    Vec3 trial_force_rate{0.0};
    Vec3 projected_force_ahead{0.0};  // at the end of the Newton direction
};

struct ConstraintProblem {
    std::array<Row, max_constraints> rows;
    std::size_t count = 0;
    double penalty = first_penalty;
    Vec6 wanted{};
    Vec6 motion{};
};

Vec3 point_motion(const Row& row, const Vec6& y) {
    return Vec3(y[0], y[1], y[2]) + glm::cross(Vec3(y[3], y[4], y[5]), row.arm);
}

// Projects a force to the friction cone |tangential| ≤ friction × normal.
Vec3 project_to_cone(const Row& row, const Vec3& trial_force) {
    const double a = glm::dot(trial_force, row.normal);
    if (row.friction_coefficient <= 0.0) return std::max(a, 0.0) * row.normal;
    const Vec3 tangential = trial_force - a * row.normal;
    const double b = glm::length(tangential);
    if (b <= row.friction_coefficient * a) return trial_force;
    if (row.friction_coefficient * b <= -a) return Vec3(0.0);
    const double s = (a + row.friction_coefficient * b) / (1.0 + square(row.friction_coefficient));
    return s * row.normal + (row.friction_coefficient * s / b) * tangential;
}

// Adds the derivative of a contact's projected force to the Hessian.
void add_stiffness(double penalty, const Row& row, double hessian[6][6]) {
    const double a = glm::dot(row.trial_force, row.normal);
    const Vec3 tangential = row.trial_force - a * row.normal;
    const double b = glm::length(tangential);
    const double mu = row.friction_coefficient;
    double along = 0.0, across = 0.0;  // factors of the projector's two terms
    Vec3 first = row.normal, t(0.0);
    bool inside_cone = false;
    if (mu <= 0.0) {
        if (a <= 0.0) return;
        along = 1.0;
    } else if (b <= mu * a) {
        inside_cone = true;
    } else if (mu * b <= -a) {
        return;
    } else {
        const double c = 1.0 / (1.0 + mu * mu);
        t = tangential / b;
        first = row.normal + mu * t;
        along = c;
        across = mu * (a + mu * b) * c / b;
    }
    double P[3][3];
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const double unit = i == j ? 1.0 : 0.0;
            P[i][j] = inside_cone ? unit
                                  : along * first[i] * first[j] +
                                        across * (unit - row.normal[i] * row.normal[j] - t[i] * t[j]);
            P[i][j] *= penalty;
        }
    // For the point's motion v + w × r the blocks are P, [r] P and [r] P [r]ᵀ, column by column.
    const Vec3 r = row.arm;
    Vec3 turning[3];
    for (int j = 0; j < 3; ++j) turning[j] = glm::cross(r, Vec3(P[0][j], P[1][j], P[2][j]));
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j <= i; ++j) hessian[i][j] += P[i][j];
        for (int j = 0; j < 3; ++j) hessian[i + 3][j] += turning[j][i];
        const Vec3 both = glm::cross(r, Vec3(turning[0][i], turning[1][i], turning[2][i]));
        for (int j = 0; j <= i; ++j) hessian[i + 3][j + 3] += both[j];
    }
}

// Cholesky factorisation of the lower triangle, in place; the right-hand side becomes the solution. Pivots
// are ≥ 1 except for rounding, because the Hessian is the identity plus a positive semidefinite matrix.
void solve(double hessian[6][6], Vec6& rhs) {
    for (int j = 0; j < 6; ++j) {
        for (int k = 0; k < j; ++k) hessian[j][j] -= square(hessian[j][k]);
        hessian[j][j] = std::sqrt(std::max(hessian[j][j], 0.5));
        for (int i = j + 1; i < 6; ++i) {
            for (int k = 0; k < j; ++k) hessian[i][j] -= hessian[i][k] * hessian[j][k];
            hessian[i][j] /= hessian[j][j];
        }
    }
    for (std::size_t i = 0; i < 6; ++i) {
        for (std::size_t k = 0; k < i; ++k) rhs[i] -= hessian[i][k] * rhs[k];
        rhs[i] /= hessian[i][i];
    }
    for (std::size_t i = 6; i-- > 0;) {
        for (std::size_t k = i + 1; k < 6; ++k) rhs[i] -= hessian[k][i] * rhs[k];
        rhs[i] /= hessian[i][i];
    }
}

double dot(const Vec6& a, const Vec6& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < 6; ++i) sum += a[i] * b[i];
    return sum;
}

void update_trial_forces(ConstraintProblem& p) {
    for (std::size_t k = 0; k < p.count; ++k) {
        Row& row = p.rows[k];
        const Vec3 room = point_motion(row, p.motion) + (row.slack + row.slip_slack) * row.normal;
        row.trial_force = row.force - p.penalty * room;
        row.projected_force = project_to_cone(row, row.trial_force);
    }
}

// The negative gradient of the cost at the current motion.
Vec6 negative_gradient(const ConstraintProblem& p) {
    Vec3 force(0.0), moment(0.0);
    for (std::size_t k = 0; k < p.count; ++k) {
        force += p.rows[k].projected_force;
        moment += glm::cross(p.rows[k].arm, p.rows[k].projected_force);
    }
    Vec6 rhs{force.x, force.y, force.z, moment.x, moment.y, moment.z};
    for (std::size_t i = 0; i < 6; ++i) rhs[i] += p.wanted[i] - p.motion[i];
    return rhs;
}

// Derivative of the cost along a direction, at the fraction t of it: slope_at_start + curvature · t, plus the
// contributions of the contacts.
double slope(ConstraintProblem& p, double slope_at_start, double curvature, double t) {
    double sum = slope_at_start + curvature * t;
    for (std::size_t k = 0; k < p.count; ++k) {
        Row& row = p.rows[k];
        row.projected_force_ahead = project_to_cone(row, row.trial_force + t * row.trial_force_rate);
        sum += glm::dot(row.projected_force_ahead, row.trial_force_rate) / p.penalty;
    }
    return sum;
}

// Step length along a Newton direction: the point where the derivative of the convex cost has nearly
// vanished, found by false position (Illinois). 1 unless the direction overshoots. `at_start` is the
// derivative at 0.
double line_search(ConstraintProblem& p, const Vec6& direction, double at_start) {
    for (std::size_t k = 0; k < p.count; ++k)
        p.rows[k].trial_force_rate = -p.penalty * point_motion(p.rows[k], direction);
    Vec6 deviation;
    for (std::size_t i = 0; i < 6; ++i) deviation[i] = p.motion[i] - p.wanted[i];
    const double start = dot(deviation, direction), bend = dot(direction, direction);
    double low = 0.0, at_low = at_start;
    double high = 1.0, at_high = slope(p, start, bend, 1.0);
    const double small = 0.1 * std::abs(at_low);
    if (at_high <= small) return 1.0;
    double t = 1.0;
    for (int i = 0; i < max_search_steps; ++i) {
        t = (low * at_high - high * at_low) / (at_high - at_low);
        const double slope_at_t = slope(p, start, bend, t);
        if (std::abs(slope_at_t) <= small) break;
        if (slope_at_t < 0.0) {
            low = t;
            at_low = slope_at_t;
            at_high *= 0.5;
        } else {
            high = t;
            at_high = slope_at_t;
            at_low *= 0.5;
        }
    }
    return t;
}

// Minimises the augmented cost until its gradient is less than `tolerance`. Returns the number of Newton
// steps.
int minimise(ConstraintProblem& p, double tolerance) {
    update_trial_forces(p);
    for (int step = 0; step < max_newton_steps; ++step) {
        const Vec6 down = negative_gradient(p);
        double largest = 0.0;
        for (const double x : down) largest = std::max(largest, std::abs(x));
        if (largest <= tolerance) return step;
        double hessian[6][6] = {};
        for (int i = 0; i < 6; ++i) hessian[i][i] = 1.0;
        for (std::size_t k = 0; k < p.count; ++k) add_stiffness(p.penalty, p.rows[k], hessian);
        Vec6 direction = down;
        solve(hessian, direction);
        const double t = line_search(p, direction, -dot(down, direction));
        for (std::size_t i = 0; i < 6; ++i) p.motion[i] += t * direction[i];
        for (std::size_t k = 0; k < p.count; ++k) {
            Row& row = p.rows[k];
            row.trial_force += t * row.trial_force_rate;
            row.projected_force = row.projected_force_ahead;
        }
    }
    return max_newton_steps;
}

Vec6 to_vec6(const Twist& twist, double length) {
    const Vec3 turn = twist.angular * length;
    return {twist.linear.x, twist.linear.y, twist.linear.z, turn.x, turn.y, turn.z};
}

double max_difference(const Vec6& a, const Vec6& b) {
    double most = 0.0;
    for (std::size_t i = 0; i < 6; ++i) most = std::max(most, std::abs(a[i] - b[i]));
    return most;
}

// The slack that compensates the lift of a contact which slips in this motion.
double slack_for_slip(const Row& row, const Vec6& motion) {
    if (row.friction_coefficient <= 0.0) return 0.0;
    const Vec3 u = point_motion(row, motion);
    return row.friction_coefficient * glm::length(u - glm::dot(u, row.normal) * row.normal);
}

// Sets the multipliers to the projected forces. Returns the greatest change, in m of violation.
double update_multipliers(ConstraintProblem& p) {
    double change = 0.0;
    for (std::size_t k = 0; k < p.count; ++k) {
        Row& row = p.rows[k];
        change = std::max(change, glm::length(row.projected_force - row.force) / p.penalty);
        row.force = row.projected_force;
    }
    return change;
}

// Moves every slip slack by a fraction of its deficit (Aitken's relaxation). The fraction is chosen so that
// the deficits of the bearing contacts, extrapolated linearly from the last two rounds, vanish. Returns the
// greatest change, m.
double update_slip_slacks(ConstraintProblem& p, bool first, double& relaxation) {
    double correlation = 0.0, change_squared = 0.0;
    for (std::size_t k = 0; k < p.count; ++k) {
        Row& row = p.rows[k];
        const double before = row.slack_deficit;
        const bool bears = row.projected_force != Vec3(0.0);
        row.slack_deficit = slack_for_slip(row, p.motion) - row.slip_slack;
        const double counted = bears ? row.slack_deficit - before : 0.0;
        correlation += before * counted;
        change_squared += square(counted);
    }
    if (!first && change_squared > 0.0)
        relaxation = std::clamp(-relaxation * correlation / change_squared, min_relaxation, 1.0);
    double largest_change = 0.0;
    for (std::size_t k = 0; k < p.count; ++k) {
        const double change_of_slack = relaxation * p.rows[k].slack_deficit;
        p.rows[k].slip_slack += change_of_slack;
        largest_change = std::max(largest_change, std::abs(change_of_slack));
    }
    return largest_change;
}

// Iterates until motion and slip slacks have converged, with at most max_full_rounds rounds at the full
// penalty. Returns false if `has_fallback` and Newton's method does not converge in max_newton_steps.
bool iterate(ConstraintProblem& p, double full_penalty, bool has_fallback, int& factorisations) {
    double relaxation = initial_relaxation;
    for (int round = 0, full_rounds = 0; full_rounds < max_full_rounds; ++round) {
        const bool full = p.penalty >= full_penalty;
        const Vec6 before = p.motion;
        const int steps = minimise(p, full ? final_tolerance : coarse_tolerance);
        factorisations += steps;
        if (has_fallback && steps == max_newton_steps) return false;
        const double change = update_multipliers(p);
        const double largest_change = update_slip_slacks(p, round == 0, relaxation);
        const bool converged =
            change <= final_tolerance || (round > 0 && max_difference(p.motion, before) <= motion_tolerance);
        if (full && converged && largest_change <= motion_tolerance) break;
        p.penalty = std::min(full_penalty, 10.0 * p.penalty);
        full_rounds += full ? 1 : 0;
    }
    return true;
}

bool solve_warm(ConstraintProblem& p, const Vec6& initial_guess, int& factorisations) {
    p.motion = initial_guess;
    p.penalty = penalty_warm;
    for (std::size_t k = 0; k < p.count; ++k) p.rows[k].slip_slack = slack_for_slip(p.rows[k], initial_guess);
    return iterate(p, penalty_warm, true, factorisations);
}

void solve_cold(ConstraintProblem& p, int& factorisations) {
    p.motion = p.wanted;
    p.penalty = first_penalty;
    for (std::size_t k = 0; k < p.count; ++k) {
        Row& row = p.rows[k];
        row.force = Vec3(0.0);
        row.slip_slack = row.slack_deficit = 0.0;
    }
    (void)iterate(p, penalty_cold, false, factorisations);
}

}  // namespace

ConstrainedMotion constrain(const Metric& metric, const Twist& wanted,
                            std::span<const Constraint> constraints, std::span<Vec3> forces,
                            const std::optional<Twist>& initial_guess) {
    const double length = std::sqrt(metric.angular / metric.linear);
    ConstraintProblem p;
    p.count = std::min(constraints.size(), max_constraints);
    for (std::size_t k = 0; k < p.count; ++k) {
        const Constraint& c = constraints[k];
        Row& row = p.rows[k];
        row.arm = c.arm / length;
        row.normal = c.normal;
        row.slack = c.slack;
        row.friction_coefficient = c.friction_coefficient;
    }
    p.wanted = to_vec6(wanted, length);

    ConstrainedMotion result;
    if (!initial_guess || !solve_warm(p, to_vec6(*initial_guess, length), result.factorisations))
        solve_cold(p, result.factorisations);
    for (std::size_t k = 0; k < p.count; ++k) {
        const double normal = glm::dot(point_motion(p.rows[k], p.motion), p.rows[k].normal);
        result.violation = std::max(result.violation, -normal - p.rows[k].slack);
        if (k < forces.size()) forces[k] = p.rows[k].force * metric.linear;
    }
    result.motion.linear = {p.motion[0], p.motion[1], p.motion[2]};
    result.motion.angular = Vec3(p.motion[3], p.motion[4], p.motion[5]) / length;
    return result;
}

}  // namespace bolt::proxy
