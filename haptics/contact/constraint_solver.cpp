#include "haptics/contact/constraint_solver.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace bolt::contact {

// Augmented Lagrangian outside, semismooth Newton with an exact line search inside: six unknowns however
// many contacts, a Hessian that is never singular (identity plus the contacts), so redundant rows do no harm.
// Of the method: Li, Sun and Toh, SIAM J. Optim. 28(1), 2018; of friction cones as projections in such a
// Newton method: Castro, Permenter and Han, IEEE T-RO 39(2), 2023. Coulomb's law is not the optimum of a
// convex problem: a cone alone would let a slipping contact rise by friction × slip. De Saxcé's correction
// (de Saxcé and Feng, Math. Comput. Modelling 28, 1998) gives that rise back as slack, from the slip of the
// last round.
//
// Forces are in metres (divided by the linear stiffness), turns in metres (times the metric's length).

namespace {

constexpr double penalty = 1e3;   // of a contact's violation, against 1 for the deviation
constexpr int rounds = 8;         // multiplier and slip are renewed this often at most
constexpr int newton_steps = 16;  // in a round at most
constexpr int searches = 8;       // along a Newton direction at most
constexpr double enough = 1e-10;  // m

using Six = std::array<double, 6>;

struct Row {
    Vec3 arm{0.0};
    Vec3 normal{0.0};
    double slack = 0.0;
    double friction = 0.0;
    double rise = 0.0;  // m of slack for slipping
    Vec3 force{0.0};    // the multiplier
    Vec3 pull{0.0};     // force + penalty × violation at the current motion, before it is projected
    Vec3 pull_rate{0.0};
};

struct Problem {
    std::array<Row, most_constraints> rows;
    std::size_t count = 0;
    double length = 0.1;  // m
    Six wanted{};
    Six motion{};
};

Vec3 point_motion(const Problem& p, const Row& row, const Six& y) {
    return Vec3(y[0], y[1], y[2]) + glm::cross(Vec3(y[3], y[4], y[5]), row.arm) / p.length;
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
void add_stiffness(const Problem& p, const Row& row, double hessian[6][6]) {
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
    const Vec3 r = row.arm / p.length;
    const double G[3][6] = {{1, 0, 0, 0, r.z, -r.y}, {0, 1, 0, -r.z, 0, r.x}, {0, 0, 1, r.y, -r.x, 0}};
    double PG[3][6];
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 6; ++j) PG[i][j] = P[i][0] * G[0][j] + P[i][1] * G[1][j] + P[i][2] * G[2][j];
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j <= i; ++j)
            hessian[i][j] += G[0][i] * PG[0][j] + G[1][i] * PG[1][j] + G[2][i] * PG[2][j];
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
        const Vec3 gap = point_motion(p, row, p.motion) + (row.slack + row.rise) * row.normal;
        row.pull = row.force - penalty * gap;
    }
}

// Downhill from the current motion: minus the gradient.
Six descent(const Problem& p) {
    Six side;
    for (std::size_t i = 0; i < 6; ++i) side[i] = p.wanted[i] - p.motion[i];
    for (std::size_t k = 0; k < p.count; ++k) {
        const Vec3 force = bearable(p.rows[k], p.rows[k].pull);
        const Vec3 moment = glm::cross(p.rows[k].arm, force) / p.length;
        for (int i = 0; i < 3; ++i) {
            side[static_cast<std::size_t>(i)] += force[i];
            side[static_cast<std::size_t>(i) + 3] += moment[i];
        }
    }
    return side;
}

// The slope of the cost along a direction, t of the way.
double slope(const Problem& p, double start, double bend, double t) {
    double sum = start + bend * t;
    for (std::size_t k = 0; k < p.count; ++k) {
        const Row& row = p.rows[k];
        sum += glm::dot(bearable(row, row.pull + t * row.pull_rate), row.pull_rate) / penalty;
    }
    return sum;
}

// How far to go along a Newton direction: where the slope has (nearly) vanished, by false position
// (Illinois) on the convex cost. 1 unless the direction overshoots.
double search(Problem& p, const Six& direction) {
    for (std::size_t k = 0; k < p.count; ++k)
        p.rows[k].pull_rate = -penalty * point_motion(p, p.rows[k], direction);
    Six off;
    for (std::size_t i = 0; i < 6; ++i) off[i] = p.motion[i] - p.wanted[i];
    const double start = dot(off, direction), bend = dot(direction, direction);
    double low = 0.0, at_low = slope(p, start, bend, 0.0);
    double high = 1.0, at_high = slope(p, start, bend, 1.0);
    const double small = 0.01 * std::abs(at_low);
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

// Minimises the augmented cost; returns the steps taken.
int descend(Problem& p) {
    for (int step = 0; step < newton_steps; ++step) {
        pull_at_motion(p);
        Six direction = descent(p);
        double largest = 0.0;
        for (const double x : direction) largest = std::max(largest, std::abs(x));
        if (largest <= enough) return step;
        double hessian[6][6] = {};
        for (int i = 0; i < 6; ++i) hessian[i][i] = 1.0;
        for (std::size_t k = 0; k < p.count; ++k) add_stiffness(p, p.rows[k], hessian);
        solve(hessian, direction);
        const double t = search(p, direction);
        for (std::size_t i = 0; i < 6; ++i) p.motion[i] += t * direction[i];
    }
    return newton_steps;
}

}  // namespace

ConstrainedMotion constrain(const Metric& metric, const Twist& wanted,
                            std::span<const Constraint> constraints, std::span<Vec3> forces) {
    Problem p;
    p.length = std::sqrt(metric.angular / metric.linear);
    p.count = std::min(constraints.size(), most_constraints);
    for (std::size_t k = 0; k < p.count; ++k) {
        const Constraint& c = constraints[k];
        p.rows[k] = {c.arm, c.normal, c.slack, c.friction, 0.0, Vec3(0.0), Vec3(0.0), Vec3(0.0)};
    }
    const Vec3 turn = wanted.angular * p.length;
    p.wanted = {wanted.linear.x, wanted.linear.y, wanted.linear.z, turn.x, turn.y, turn.z};
    p.motion = p.wanted;

    ConstrainedMotion result;
    for (int round = 0; round < rounds; ++round) {
        result.factorisations += descend(p);
        pull_at_motion(p);
        double change = 0.0;
        for (std::size_t k = 0; k < p.count; ++k) {
            Row& row = p.rows[k];
            const Vec3 force = bearable(row, row.pull);
            change = std::max(change, glm::length(force - row.force) / penalty);
            row.force = force;
            if (row.friction <= 0.0) continue;
            const Vec3 u = point_motion(p, row, p.motion);
            const double rise = row.friction * glm::length(u - glm::dot(u, row.normal) * row.normal);
            change = std::max(change, std::abs(rise - row.rise));
            row.rise = rise;
        }
        if (change <= 10.0 * enough) break;
    }
    for (std::size_t k = 0; k < p.count; ++k) {
        const double normal = glm::dot(point_motion(p, p.rows[k], p.motion), p.rows[k].normal);
        result.violation = std::max(result.violation, -normal - p.rows[k].slack);
        if (k < forces.size()) forces[k] = p.rows[k].force * metric.linear;
    }
    result.motion.linear = {p.motion[0], p.motion[1], p.motion[2]};
    result.motion.angular = Vec3(p.motion[3], p.motion[4], p.motion[5]) / p.length;
    return result;
}

}  // namespace bolt::contact
