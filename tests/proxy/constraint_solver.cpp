#include "haptics/proxy/constraint_solver.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "engine/base/random.hpp"

namespace proxy_constraint_solver_test {

using namespace bolt;
using namespace bolt::proxy;

namespace {

using Six = std::array<double, 6>;

Vec3 any_direction(Random& random) {
    return glm::normalize(Vec3(random.normal(), random.normal(), random.normal()) + Vec3(1e-9, 0, 0));
}

double cost(const Metric& metric, const Twist& wanted, const Twist& u) {
    const Vec3 a = u.linear - wanted.linear, b = u.angular - wanted.angular;
    return 0.5 * metric.linear * glm::dot(a, a) + 0.5 * metric.angular * glm::dot(b, b);
}

double approach(const Constraint& c, const Twist& u) {
    return glm::dot(c.normal, u.linear + glm::cross(u.angular, c.arm));
}

// Gaussian elimination with full pivoting. Returns false for a singular matrix.
bool solve(std::vector<std::vector<double>> a, std::vector<double> b, std::vector<double>& x) {
    const std::size_t n = b.size();
    std::vector<std::size_t> column(n);
    for (std::size_t i = 0; i < n; ++i) column[i] = i;
    for (std::size_t k = 0; k < n; ++k) {
        std::size_t pi_row = k, pi_col = k;
        for (std::size_t i = k; i < n; ++i)
            for (std::size_t j = k; j < n; ++j)
                if (std::abs(a[i][j]) > std::abs(a[pi_row][pi_col])) pi_row = i, pi_col = j;
        if (std::abs(a[pi_row][pi_col]) < 1e-13) return false;
        std::swap(a[k], a[pi_row]);
        std::swap(b[k], b[pi_row]);
        for (auto& row : a) std::swap(row[k], row[pi_col]);
        std::swap(column[k], column[pi_col]);
        for (std::size_t i = k + 1; i < n; ++i) {
            const double f = a[i][k] / a[k][k];
            for (std::size_t j = k; j < n; ++j) a[i][j] -= f * a[k][j];
            b[i] -= f * b[k];
        }
    }
    x.assign(n, 0.0);
    for (std::size_t k = n; k-- > 0;) {
        double sum = b[k];
        for (std::size_t j = k + 1; j < n; ++j) sum -= a[k][j] * x[column[j]];
        x[column[k]] = sum / a[k][k];
    }
    return true;
}

// Reference for the frictionless optimum: tries every set of up to six contacts as the active set.
Twist by_enumeration(const Metric& metric, const Twist& wanted, const std::vector<Constraint>& rows) {
    const double scale[6] = {1, 1, 1, std::sqrt(metric.linear / metric.angular), 0, 0};
    const double turn = scale[3];
    std::vector<Six> g;
    std::vector<double> side;
    for (const Constraint& c : rows) {
        const Vec3 m = glm::cross(c.arm, c.normal) * turn;
        g.push_back({c.normal.x, c.normal.y, c.normal.z, m.x, m.y, m.z});
        side.push_back(-c.slack - approach(c, wanted));
    }
    Twist best;
    double least = 1e300;
    for (unsigned set = 0; set < (1U << rows.size()); ++set) {
        std::vector<std::size_t> in;
        for (std::size_t i = 0; i < rows.size(); ++i)
            if ((set >> i & 1U) != 0) in.push_back(i);
        if (in.size() > 6) continue;
        std::vector<std::vector<double>> a(in.size(), std::vector<double>(in.size(), 0.0));
        std::vector<double> b, force;
        for (std::size_t i = 0; i < in.size(); ++i) {
            for (std::size_t j = 0; j < in.size(); ++j)
                for (std::size_t k = 0; k < 6; ++k) a[i][j] += g[in[i]][k] * g[in[j]][k];
            b.push_back(side[in[i]]);
        }
        if (!solve(a, b, force)) continue;
        Twist u = wanted;
        bool bears = true;
        for (std::size_t i = 0; i < in.size(); ++i) {
            bears = bears && force[i] >= -1e-12;
            const Six& r = g[in[i]];
            u.linear += force[i] * Vec3(r[0], r[1], r[2]);
            u.angular += force[i] * turn * Vec3(r[3], r[4], r[5]);
        }
        for (const Constraint& c : rows) bears = bears && approach(c, u) >= -c.slack - 1e-10;
        if (bears && cost(metric, wanted, u) < least) {
            least = cost(metric, wanted, u);
            best = u;
        }
    }
    REQUIRE(least < 1e300);
    return best;
}

// Random contacts around a body that penetrates none of them: every slack is ≥ 0. `tilt`: deviation (rad,
// approximate) of nearly parallel normals.
std::vector<Constraint> random_contacts(Random& random, std::size_t count, double friction,
                                        double tilt = 1e-6) {
    std::vector<Constraint> rows;
    for (std::size_t i = 0; i < count; ++i) {
        Constraint c;
        c.arm = random.uniform(0.0, 0.2) * any_direction(random);
        c.normal = any_direction(random);
        c.slack = random.chance(0.5) ? 0.0 : random.uniform(0.0, 2e-3);
        c.friction_coefficient = friction;
        const double kind = random.uniform();
        if (i > 0 && kind < 0.15) c = rows.back();                               // a duplicate
        if (i > 0 && kind >= 0.15 && kind < 0.3) c.normal = rows.back().normal;  // a face
        if (i > 0 && kind >= 0.3 && kind < 0.4) c.normal = -rows.back().normal;  // a gap
        if (i > 0 && kind >= 0.4 && kind < 0.5)                                  // nearly parallel
            c.normal = glm::normalize(rows.back().normal + tilt * c.normal);
        rows.push_back(c);
    }
    return rows;
}

Twist random_motion(Random& random) {
    const double size = std::pow(10.0, random.uniform(-5.0, -1.7));
    return {size * any_direction(random), 10.0 * size * any_direction(random)};
}

}  // namespace

TEST_CASE("Constraint solver: without contacts the motion equals the desired one") {
    const Twist wanted{Vec3(1e-3, -2e-3, 3e-3), Vec3(0.01, 0.02, -0.03)};
    const ConstrainedMotion result = constrain({}, wanted, {});
    CHECK(glm::length(result.motion.linear - wanted.linear) == 0.0);
    CHECK(glm::length(result.motion.angular - wanted.angular) < 1e-15);
}

TEST_CASE("Constraint solver: one, two and three planes give the projection onto the remaining directions") {
    const Twist wanted{Vec3(1e-3, -2e-3, -3e-3), Vec3(0.0)};
    std::vector<Constraint> rows{{Vec3(0.0), Vec3(0, 0, 1), 0.0, 0.0}};
    CHECK(glm::length(constrain({}, wanted, rows).motion.linear - Vec3(1e-3, -2e-3, 0)) < 1e-10);
    rows.push_back({Vec3(0.0), Vec3(0, 1, 0), 1e-3, 0.0});
    CHECK(glm::length(constrain({}, wanted, rows).motion.linear - Vec3(1e-3, -1e-3, 0)) < 1e-10);
    rows.push_back({Vec3(0.0), Vec3(-1, 0, 0), 0.0, 0.0});
    CHECK(glm::length(constrain({}, wanted, rows).motion.linear - Vec3(0, -1e-3, 0)) < 1e-10);
}

TEST_CASE("Constraint solver: at a lever the metric distributes the motion over translation and rotation") {
    // Pressed down by d against a stop at arm r: u_z + θ r ≥ 0 with k u' = f, κ θ = f r, so
    // f = d / (1/k + r²/κ).
    const Metric metric{800.0, 5.0};
    const double d = 2e-3, r = 0.15;
    const std::vector<Constraint> rows{{Vec3(0, r, 0), Vec3(0, 0, 1), 0.0, 0.0}};
    std::array<Vec3, 1> force;
    const Twist u = constrain(metric, {Vec3(0, 0, -d), Vec3(0.0)}, rows, force).motion;
    const double f = d / (1.0 / 800.0 + r * r / 5.0);
    CHECK(force[0].z == doctest::Approx(f).epsilon(1e-6));
    CHECK(u.linear.z == doctest::Approx(-d + f / 800.0).epsilon(1e-6));
    CHECK(u.angular.x == doctest::Approx(f * r / 5.0).epsilon(1e-6));
}

TEST_CASE("Constraint solver: without friction the result equals brute force over all active sets") {
    Random random(5);
    std::vector<double> offs;
    int most = 0;
    for (int trial = 0; trial < 3000; ++trial) {
        const auto rows = random_contacts(random, 1 + random.bits() % 9, 0.0, 0.05);
        const Metric metric{random.uniform(200.0, 4000.0), random.uniform(0.5, 40.0)};
        const Twist wanted = random_motion(random);
        const Twist truth = by_enumeration(metric, wanted, rows);
        const ConstrainedMotion found = constrain(metric, wanted, rows);
        const double length = std::sqrt(metric.angular / metric.linear);
        const double size = glm::length(wanted.linear) + length * glm::length(wanted.angular);
        const double off = glm::length(found.motion.linear - truth.linear) +
                           length * glm::length(found.motion.angular - truth.angular);
        offs.push_back(off / size);
        most = std::max(most, found.factorisations);
        CHECK(found.violation < 1e-6);
    }
    std::sort(offs.begin(), offs.end());
    MESSAGE("off by, of the wanted motion: median " << offs[1500] << ", of 99 % below " << offs[2970]
                                                    << ", greatest " << offs.back()
                                                    << "; most factorisations " << most);
    CHECK(offs[1500] < 1e-7);
    CHECK(offs[2970] < 1e-4);
    // In wedges of a few degrees a residual violation below 1 µm corresponds to a longer motion along the
    // wedge.
    CHECK(offs.back() < 0.02);
    CHECK(most <= 96);
}

TEST_CASE("Constraint solver: each force satisfies Coulomb's law, and the sum balances the deviation") {
    Random random(6);
    std::vector<double> residuals;
    double worst_balance = 0.0, worst_depth = 0.0;
    int slipping = 0, sticking = 0, most = 0;
    for (int trial = 0; trial < 3000; ++trial) {
        const auto rows = random_contacts(random, 1 + random.bits() % 6, random.uniform(0.05, 0.6));
        const Metric metric{1000.0, 10.0};
        const Twist wanted = random_motion(random);
        std::vector<Vec3> forces(rows.size());
        const ConstrainedMotion found = constrain(metric, wanted, rows, forces);
        most = std::max(most, found.factorisations);
        Vec3 sum(0.0), moment(0.0);
        double residual = 0.0;
        const double size =
            metric.linear * glm::length(wanted.linear) + metric.angular * glm::length(wanted.angular) / 0.1;
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const Constraint& c = rows[i];
            sum += forces[i];
            moment += glm::cross(c.arm, forces[i]);
            const double normal = glm::dot(forces[i], c.normal);
            const Vec3 tangential = forces[i] - normal * c.normal;
            const Vec3 u = found.motion.linear + glm::cross(found.motion.angular, c.arm);
            const Vec3 slip = u - glm::dot(u, c.normal) * c.normal;
            CHECK(glm::length(tangential) <= c.friction_coefficient * normal * (1 + 1e-9) + 1e-9 * size);
            const double slack = (glm::dot(u, c.normal) + c.slack) * metric.linear / size;
            const double room = (c.friction_coefficient * normal - glm::length(tangential)) / size;
            worst_depth = std::max(worst_depth, -slack);
            // Complementarity: slack excludes force, and slip excludes a margin in the friction cone.
            residual = std::max(residual, std::min(normal / size, slack));
            residual = std::max(residual, std::min(room, glm::length(slip) * metric.linear / size));
            if (glm::length(slip) * metric.linear > 1e-3 * size && normal > 1e-3 * size) {
                ++slipping;
                CHECK(glm::dot(slip, tangential) <= -0.99 * glm::length(slip) * glm::length(tangential));
            } else if (normal > 1e-3 * size) {
                ++sticking;
            }
        }
        residuals.push_back(residual);
        worst_balance = std::max(
            worst_balance, glm::length(metric.linear * (found.motion.linear - wanted.linear) - sum) / size);
        worst_balance = std::max(
            worst_balance,
            glm::length(metric.angular * (found.motion.angular - wanted.angular) - moment) / size / 0.1);
    }
    std::sort(residuals.begin(), residuals.end());
    MESSAGE("residuals: median " << residuals[1500] << ", of 95 % below " << residuals[2850]
                                 << ", of 99 % below " << residuals[2970] << ", greatest " << residuals.back()
                                 << "; depth " << worst_depth << "; balance " << worst_balance
                                 << "; slipping " << slipping << ", sticking " << sticking
                                 << "; most factorisations " << most);
    CHECK(residuals[1500] < 1e-6);
    CHECK(residuals[2850] < 1e-3);
    CHECK(residuals[2970] < 5e-3);
    // Between wedging contacts Coulomb's law may have no unique solution. The residual is then slip, not
    // depth.
    CHECK(residuals.back() < 0.2);
    CHECK(worst_depth < 0.01);
    CHECK(worst_balance < 1e-4);
    CHECK(slipping > 100);
    CHECK(sticking > 100);
}

TEST_CASE("Constraint solver: a warm start gives the same motion with half the factorisations") {
    Random random(9);
    std::vector<double> offs;
    int with = 0, without = 0, most = 0;
    for (int trial = 0; trial < 300; ++trial) {
        const auto rows = random_contacts(random, 1 + random.bits() % 12, random.uniform(0.0, 0.3));
        const Twist from = random_motion(random), by = random_motion(random);
        std::optional<Twist> before;
        for (int i = 0; i < 20; ++i) {
            const Twist wanted{from.linear + 1e-3 * i * by.linear, from.angular + 1e-3 * i * by.angular};
            const ConstrainedMotion alone = constrain({}, wanted, rows);
            const ConstrainedMotion led = constrain({}, wanted, rows, {}, before);
            before = led.motion;
            if (i == 0) continue;
            with += led.factorisations;
            without += alone.factorisations;
            most = std::max(most, led.factorisations);
            const double size = glm::length(wanted.linear) + 0.1 * glm::length(wanted.angular);
            const Twist& a = alone.motion;
            offs.push_back((glm::length(a.linear - led.motion.linear) +
                            0.1 * glm::length(a.angular - led.motion.angular)) /
                           size);
        }
    }
    std::sort(offs.begin(), offs.end());
    const auto below = [&](double share) {
        return offs[static_cast<std::size_t>(share * static_cast<double>(offs.size()))];
    };
    MESSAGE("off by, of the wanted motion: median "
            << below(0.5) << ", 95 % below " << below(0.95) << ", 99 % below " << below(0.99) << "; " << with
            << " factorisations, " << without << " without, at most " << most);
    CHECK(below(0.5) < 2e-5);
    CHECK(below(0.95) < 5e-3);
    CHECK(2 * with < without);
}

TEST_CASE("Constraint solver: contradicting contacts give a bounded compromise") {
    const std::vector<Constraint> rows{{Vec3(0.0), Vec3(0, 0, 1), -1e-3, 0.3},
                                       {Vec3(0.0), Vec3(0, 0, -1), -1e-3, 0.3}};
    const ConstrainedMotion found = constrain({}, {Vec3(1e-3, 0, 0), Vec3(0.0)}, rows);
    CHECK(glm::length(found.motion.linear) < 2e-3);
    CHECK(std::abs(found.motion.linear.z) < 1e-6);
    CHECK(found.violation == doctest::Approx(1e-3).epsilon(1e-3));
}

TEST_CASE("Constraint solver: the motion is continuous in the desired motion") {
    Random random(7);
    for (int trial = 0; trial < 300; ++trial) {
        const auto rows = random_contacts(random, 1 + random.bits() % 12, 0.0);
        const Twist from = random_motion(random), to = random_motion(random);
        Twist last;
        const double size =
            glm::length(from.linear - to.linear) + glm::length(from.angular - to.angular) * 0.1;
        for (int i = 0; i <= 200; ++i) {
            const double t = i / 200.0;
            const Twist wanted{glm::mix(from.linear, to.linear, t), glm::mix(from.angular, to.angular, t)};
            const Twist u = constrain({}, wanted, rows).motion;
            // A projection onto a convex set never increases distances.
            if (i > 0)
                CHECK(std::hypot(glm::length(u.linear - last.linear),
                                 0.1 * glm::length(u.angular - last.angular)) <= 1.01 * size / 200.0 + 1e-8);
            last = u;
        }
    }
}

TEST_CASE("Constraint solver: the full set of 48 constraints is solved and repeats to the same bits") {
    Random random(8);
    int most = 0;
    for (int trial = 0; trial < 200; ++trial) {
        auto rows = random_contacts(random, 60, 0.2);
        for (Constraint& c : rows) c.slack = std::abs(c.slack);
        const Twist wanted = random_motion(random);
        const ConstrainedMotion once = constrain({}, wanted, rows);
        const ConstrainedMotion again = constrain({}, wanted, rows);
        CHECK(std::memcmp(&once.motion, &again.motion, sizeof(Twist)) == 0);
        CHECK(once.violation < 2e-5);
        most = std::max(most, once.factorisations);
    }
    MESSAGE("most factorisations " << most);
}

}  // namespace proxy_constraint_solver_test
