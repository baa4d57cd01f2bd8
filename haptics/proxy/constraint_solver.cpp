#include "haptics/proxy/constraint_solver.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace bolt::proxy {

// Augmented Lagrangian outside, semismooth Newton with an exact line search inside: six unknowns however
// many contacts, a Hessian that is never singular (identity plus the contacts), so redundant rows do no harm.
// Of the method: Li, Sun and Toh, SIAM J. Optim. 28(1), 2018; of friction cones as projections in such a
// Newton method: Castro, Permenter and Han, IEEE T-RO 39(2), 2023. Coulomb's law is not the optimum of a
// convex problem: a cone alone would let a slipping contact rise by friction × slip. De Saxcé's correction
// (de Saxcé and Feng, Math. Comput. Modelling 28, 1998) gives that rise back as slack, from the slip of the
// last round. That is a fixed point, and between two jaws one that is run away from: what one side rises by,
// the other slips by, times a lever. Irons and Tuck's relaxation (Int. J. Numer. Methods Eng. 1, 1969, as
// "Aitken's" in Küttler and Wall, Comput. Mech. 43, 2008) finds it. Rows that contradict each other push
// against each other ever more while the motion has long come to rest: that ends it, not the forces.
//
// Forces are in metres (divided by the linear stiffness), turns in metres (times the metric's length).

namespace {

// Of a contact's violation, against 1 for the deviation. From far away it grows tenfold a round, as the way
// to the answer is shorter where the cost is smooth.
constexpr double first_penalty = 10.0, penalty_afar = 1e3, penalty_near = 1e4;
constexpr int rounds = 8;         // with the full penalty, in which multiplier and rise are renewed
constexpr int newton_steps = 16;  // in a round at most
constexpr int searches = 16;      // along a Newton direction at most
constexpr double enough = 1e-9;   // m
constexpr double nearly = 1e-6;   // m, while the penalty grows
constexpr double at_rest = 1e-7;  // m, from round to round: of the stiffest coupling less than a millinewton
constexpr double first_relaxation = 0.7, least_relaxation = 0.3;  // of the rise

using Six = std::array<double, 6>;

struct Row {
    Vec3 arm{0.0};  // in lengths of the metric
    Vec3 normal{0.0};
    double slack = 0.0;
    double friction = 0.0;
    double rise = 0.0;      // m of slack for slipping
    double short_of = 0.0;  // m, by what its slip asked for more in the last round
    Vec3 force{0.0};        // the multiplier
    Vec3 pull{0.0};         // force - penalty × room at the current motion
    Vec3 borne{0.0};        // of the pull, what the contact can bear
    Vec3 pull_rate{0.0};
    Vec3 borne_ahead{0.0};  // at the end of the Newton direction
};

struct Problem {
    std::array<Row, most_constraints> rows;
    std::size_t count = 0;
    double penalty = first_penalty;
    Six wanted{};
    Six motion{};
};

Vec3 point_motion(const Row& row, const Six& y) {
    return Vec3(y[0], y[1], y[2]) + glm::cross(Vec3(y[3], y[4], y[5]), row.arm);
}

// Onto the cone of the forces that a contact can bear: |tangential| ≤ friction × normal.
Vec3 bearable(const Row& row, const Vec3& pull) {
    const double a = glm::dot(pull, row.normal);
    if (row.friction <= 0.0) return std::max(a, 0.0) * row.normal;
    const Vec3 tangential = pull - a * row.normal;
    const double b = glm::length(tangential);
    if (b <= row.friction * a) return pull;
    if (row.friction * b <= -a) return Vec3(0.0);
    const double s = (a + row.friction * b) / (1.0 + square(row.friction));
    return s * row.normal + (row.friction * s / b) * tangential;
}

// Adds the derivative of what a contact bears to the Hessian.
void add_stiffness(double penalty, const Row& row, double hessian[6][6]) {
    const double a = glm::dot(row.pull, row.normal);
    const Vec3 tangential = row.pull - a * row.normal;
    const double b = glm::length(tangential);
    const double mu = row.friction;
    double along = 0.0, across = 0.0;  // on the (first, second) direction
    Vec3 first = row.normal, t(0.0);
    bool whole = false;
    if (mu <= 0.0) {
        if (a <= 0.0) return;
        along = 1.0;
    } else if (b <= mu * a) {
        whole = true;
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
            P[i][j] = whole ? unit
                            : along * first[i] * first[j] +
                                  across * (unit - row.normal[i] * row.normal[j] - t[i] * t[j]);
            P[i][j] *= penalty;
        }
    // Of the point's motion v + w × r: the blocks P, [r] P and [r] P [r]ᵀ, column by column.
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

// Cholesky on the lower triangle, in place; the right side becomes the solution. Pivots are ≥ 1 but for
// rounding, as the Hessian is the identity plus what is not negative.
void solve(double hessian[6][6], Six& side) {
    for (int j = 0; j < 6; ++j) {
        for (int k = 0; k < j; ++k) hessian[j][j] -= square(hessian[j][k]);
        hessian[j][j] = std::sqrt(std::max(hessian[j][j], 0.5));
        for (int i = j + 1; i < 6; ++i) {
            for (int k = 0; k < j; ++k) hessian[i][j] -= hessian[i][k] * hessian[j][k];
            hessian[i][j] /= hessian[j][j];
        }
    }
    for (std::size_t i = 0; i < 6; ++i) {
        for (std::size_t k = 0; k < i; ++k) side[i] -= hessian[i][k] * side[k];
        side[i] /= hessian[i][i];
    }
    for (std::size_t i = 6; i-- > 0;) {
        for (std::size_t k = i + 1; k < 6; ++k) side[i] -= hessian[k][i] * side[k];
        side[i] /= hessian[i][i];
    }
}

double dot(const Six& a, const Six& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < 6; ++i) sum += a[i] * b[i];
    return sum;
}

void pull_at_motion(Problem& p) {
    for (std::size_t k = 0; k < p.count; ++k) {
        Row& row = p.rows[k];
        const Vec3 room = point_motion(row, p.motion) + (row.slack + row.rise) * row.normal;
        row.pull = row.force - p.penalty * room;
        row.borne = bearable(row, row.pull);
    }
}

// Downhill from the current motion: minus the gradient.
Six descent(const Problem& p) {
    Vec3 force(0.0), moment(0.0);
    for (std::size_t k = 0; k < p.count; ++k) {
        force += p.rows[k].borne;
        moment += glm::cross(p.rows[k].arm, p.rows[k].borne);
    }
    Six side{force.x, force.y, force.z, moment.x, moment.y, moment.z};
    for (std::size_t i = 0; i < 6; ++i) side[i] += p.wanted[i] - p.motion[i];
    return side;
}

// The slope of the cost, t of the way along a direction; `start` and `bend` are of its part without contacts.
double slope(Problem& p, double start, double bend, double t) {
    double sum = start + bend * t;
    for (std::size_t k = 0; k < p.count; ++k) {
        Row& row = p.rows[k];
        row.borne_ahead = bearable(row, row.pull + t * row.pull_rate);
        sum += glm::dot(row.borne_ahead, row.pull_rate) / p.penalty;
    }
    return sum;
}

// How far to go along a Newton direction: where the slope has (nearly) vanished, by false position
// (Illinois) on the convex cost. 1 unless the direction overshoots. `at_start` is the slope there.
double search(Problem& p, const Six& direction, double at_start) {
    for (std::size_t k = 0; k < p.count; ++k)
        p.rows[k].pull_rate = -p.penalty * point_motion(p.rows[k], direction);
    Six off;
    for (std::size_t i = 0; i < 6; ++i) off[i] = p.motion[i] - p.wanted[i];
    const double start = dot(off, direction), bend = dot(direction, direction);
    double low = 0.0, at_low = at_start;
    double high = 1.0, at_high = slope(p, start, bend, 1.0);
    const double small = 0.1 * std::abs(at_low);
    if (at_high <= small) return 1.0;
    double t = 1.0;
    for (int i = 0; i < searches; ++i) {
        t = (low * at_high - high * at_low) / (at_high - at_low);
        const double here = slope(p, start, bend, t);
        if (std::abs(here) <= small) break;
        if (here < 0.0) {
            low = t;
            at_low = here;
            at_high *= 0.5;
        } else {
            high = t;
            at_high = here;
            at_low *= 0.5;
        }
    }
    return t;
}

// Minimises the augmented cost until its gradient is less than `to`; returns the steps taken.
int descend(Problem& p, double to) {
    pull_at_motion(p);
    for (int step = 0; step < newton_steps; ++step) {
        const Six down = descent(p);
        double largest = 0.0;
        for (const double x : down) largest = std::max(largest, std::abs(x));
        if (largest <= to) return step;
        double hessian[6][6] = {};
        for (int i = 0; i < 6; ++i) hessian[i][i] = 1.0;
        for (std::size_t k = 0; k < p.count; ++k) add_stiffness(p.penalty, p.rows[k], hessian);
        Six direction = down;
        solve(hessian, direction);
        const double t = search(p, direction, -dot(down, direction));
        for (std::size_t i = 0; i < 6; ++i) p.motion[i] += t * direction[i];
        for (std::size_t k = 0; k < p.count; ++k) {
            Row& row = p.rows[k];
            row.pull += t * row.pull_rate;
            row.borne = row.borne_ahead;
        }
    }
    return newton_steps;
}

Six six_of(const Twist& twist, double length) {
    const Vec3 turn = twist.angular * length;
    return {twist.linear.x, twist.linear.y, twist.linear.z, turn.x, turn.y, turn.z};
}

double furthest(const Six& a, const Six& b) {
    double most = 0.0;
    for (std::size_t i = 0; i < 6; ++i) most = std::max(most, std::abs(a[i] - b[i]));
    return most;
}

// The slack that a contact is to have for how far it slips.
double rise_for(const Row& row, const Six& motion) {
    if (row.friction <= 0.0) return 0.0;
    const Vec3 u = point_motion(row, motion);
    return row.friction * glm::length(u - glm::dot(u, row.normal) * row.normal);
}

// The multipliers become what the contacts bear; returns the greatest change, in m of violation.
double renew_forces(Problem& p) {
    double change = 0.0;
    for (std::size_t k = 0; k < p.count; ++k) {
        Row& row = p.rows[k];
        change = std::max(change, glm::length(row.borne - row.force) / p.penalty);
        row.force = row.borne;
    }
    return change;
}

// Every rise goes a share of the way to what the slip asks for; returns the furthest, m. The share is such
// that the last two rounds' shortages of those that bear something, drawn out in a straight line, end at
// none.
double renew_rises(Problem& p, bool first, double& relaxation) {
    double along = 0.0, across = 0.0;
    for (std::size_t k = 0; k < p.count; ++k) {
        Row& row = p.rows[k];
        const double before = row.short_of;
        const bool bears = row.borne != Vec3(0.0);
        row.short_of = rise_for(row, p.motion) - row.rise;
        const double counted = bears ? row.short_of - before : 0.0;
        along += before * counted;
        across += square(counted);
    }
    if (!first && across > 0.0) relaxation = std::clamp(-relaxation * along / across, least_relaxation, 1.0);
    double risen = 0.0;
    for (std::size_t k = 0; k < p.count; ++k) {
        const double by = relaxation * p.rows[k].short_of;
        p.rows[k].rise += by;
        risen = std::max(risen, std::abs(by));
    }
    return risen;
}

// Rounds until motion and rises rest, so many with the full penalty at most. What Newton's method does not
// end in `newton_steps` is left there if there is another way: false.
bool settle(Problem& p, double full_penalty, bool other_way, int& factorisations) {
    double relaxation = first_relaxation;
    for (int round = 0, full_rounds = 0; full_rounds < rounds; ++round) {
        const bool full = p.penalty >= full_penalty;
        const Six before = p.motion;
        const int steps = descend(p, full ? enough : nearly);
        factorisations += steps;
        if (other_way && steps == newton_steps) return false;
        const double change = renew_forces(p);
        const double risen = renew_rises(p, round == 0, relaxation);
        const bool rests = change <= enough || (round > 0 && furthest(p.motion, before) <= at_rest);
        if (full && rests && risen <= at_rest) break;
        p.penalty = std::min(full_penalty, 10.0 * p.penalty);
        full_rounds += full ? 1 : 0;
    }
    return true;
}

bool from_near(Problem& p, const Six& expected, int& factorisations) {
    p.motion = expected;
    p.penalty = penalty_near;
    for (std::size_t k = 0; k < p.count; ++k) p.rows[k].rise = rise_for(p.rows[k], expected);
    return settle(p, penalty_near, true, factorisations);
}

void from_afar(Problem& p, int& factorisations) {
    p.motion = p.wanted;
    p.penalty = first_penalty;
    for (std::size_t k = 0; k < p.count; ++k) {
        Row& row = p.rows[k];
        row.force = Vec3(0.0);
        row.rise = row.short_of = 0.0;
    }
    (void)settle(p, penalty_afar, false, factorisations);
}

}  // namespace

ConstrainedMotion constrain(const Metric& metric, const Twist& wanted,
                            std::span<const Constraint> constraints, std::span<Vec3> forces,
                            const std::optional<Twist>& expected) {
    const double length = std::sqrt(metric.angular / metric.linear);
    Problem p;
    p.count = std::min(constraints.size(), most_constraints);
    for (std::size_t k = 0; k < p.count; ++k) {
        const Constraint& c = constraints[k];
        Row& row = p.rows[k];
        row.arm = c.arm / length;
        row.normal = c.normal;
        row.slack = c.slack;
        row.friction = c.friction;
    }
    p.wanted = six_of(wanted, length);

    ConstrainedMotion result;
    if (!expected || !from_near(p, six_of(*expected, length), result.factorisations))
        from_afar(p, result.factorisations);
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
