#include "haptics/proxy/coupling.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/proxy/scene.hpp"

namespace proxy_coupling_test {

using namespace bolt;
using namespace bolt::force;
using namespace bolt::proxy;

namespace {

Offset along(const Vec3& linear, const Vec3& angular = Vec3(0.0)) { return {linear, angular}; }

}  // namespace

TEST_CASE("Coupling: passive with the device's damping, within its stiffness, no shock at 0.5 m/s") {
    for (const double dt : {1e-3, 0.25e-3})
        for (const double force : {3.3, 7.9, 12.0, 20.0, 40.0})
            for (const double stiffness : {400.0, 1000.0, 3000.0, 8000.0})
                for (const double damping : {0.0, 0.2, 1.0, 5.0}) {
                    CouplingRange range;
                    range.max_force = force;
                    range.stiffness = stiffness;
                    range.damping = damping;
                    range.dt = dt;
                    const Coupling c = make_coupling(range);
                    CHECK(c.stiffness <= stiffness);
                    CHECK(0.5 * c.stiffness * dt + c.damping <= damping);
                    CHECK(0.5 * c.torsion * dt + c.torsion_damping <= range.torsion_damping);
                    CHECK(0.5 * (c.stiffness * 1e-3 + c.damping) <= 0.1 * force * (1 + 1e-12));
                    CHECK(c.stiffness >= 0.0);
                    CHECK(c.damping >= 0.0);
                }
    // A desktop device of 20 N renders a wall of at least 0.8 N/mm.
    CHECK(make_coupling({}).stiffness >= 800.0);
}

TEST_CASE("Coupling: a linear spring for small offsets that never exceeds the greatest force") {
    Coupling c;
    c.stiffness = 2000.0;
    c.torsion = 20.0;
    c.max_force = 12.0;
    c.max_torque = 0.4;
    const auto at = [&](const Offset& offset) { return coupling_force(c, offset, offset, 1e-3); };
    CHECK(at(along(Vec3(1e-3, 0, 0))).force.x == doctest::Approx(2.0).epsilon(1e-3));
    CHECK(at(along(Vec3(0.0), Vec3(0, 1e-3, 0))).torque.y == doctest::Approx(0.02).epsilon(1e-3));
    double last = 0.0;
    for (double x = 1e-6; x < 1e3; x *= 1.02) {
        const double f = at(along(Vec3(0, x, 0))).force.y;
        CHECK(f <= 12.0 * (1 + 1e-12));
        CHECK(f >= last * (1 - 1e-12));
        const double from = x > 1e-6 ? x / 1.02 : 0.0;
        CHECK(f - last <= c.stiffness * (x - from) * (1 + 1e-9) + 1e-12);  // nowhere stiffer than stated
        last = f;
    }
    CHECK(last == doctest::Approx(12.0).epsilon(1e-6));
    CHECK(at(along(Vec3(1e100, 0, 0))).force.x == doctest::Approx(12.0));
    c.max_torque = 0.0;
    CHECK(at(along(Vec3(0.0), Vec3(0.5, 0, 0))).torque == Vec3(0.0));
}

TEST_CASE("Coupling: damping opposes the change of the offset") {
    Coupling c;
    c.damping = 2.0;
    const OutputCommand command = coupling_force(c, along(Vec3(1e-3, 0, 0)), along(Vec3(0.5e-3, 0, 0)), 1e-3);
    CHECK(command.force.x == doctest::Approx(1.0 + 2.0 * 0.5).epsilon(1e-3));
}

TEST_CASE("Coupling: the angular offset is continuous, also across half a turn") {
    const Vec3 axis = glm::normalize(Vec3(1, 2, -1));
    Vec3 last(0.0);
    for (int i = 0; i <= 3600; ++i) {
        const double angle = to_radians(0.2 * i);
        const Vec3 turn = offset_between(Pose{}, Pose{Vec3(0.0), rotation(angle * axis)}).angular;
        CHECK(glm::length(turn - std::sin(angle) * axis) < 1e-12);
        CHECK(glm::length(turn - last) <= to_radians(0.2) + 1e-12);
        last = turn;
    }
}

TEST_CASE("Coupling: a device thrown at a wall rebounds no faster, since its damping covers sampling") {
    // Mass and the device's own damper, integrated at 10 µs. The coupling is sampled and held for dt.
    CouplingRange range;
    const Coupling c = make_coupling(range);
    const auto rebound = [&](const Coupling& coupling, double damping) {
        double x = 0.01, v = -0.2;
        const double mass = 0.2, fine = 1e-5;
        Offset before;
        for (int tick = 0; tick < 2000; ++tick) {
            const Offset offset = along(Vec3(std::max(0.0, -x), 0, 0));
            const double f = coupling_force(coupling, offset, before, range.dt).force.x;
            before = offset;
            for (int i = 0; i < 100; ++i) {
                v += fine / mass * (f - damping * v);
                x += fine * v;
            }
            if (x > 0.02) break;
        }
        return v;
    };
    CHECK(rebound(c, range.damping) < 0.2);
    // Control: undamped and three times as stiff, the device gains speed.
    Coupling stiff = c;
    stiff.stiffness *= 3.0;
    stiff.max_force = 1e3;
    CHECK(rebound(stiff, 0.0) > 0.2);
}

TEST_CASE("Coupling: the stored energy equals that of the springs and never exceeds the work done on them") {
    Coupling c;
    c.stiffness = 1500.0;
    c.torsion = 12.0;
    c.max_force = 20.0;
    c.max_torque = 2.0;
    CHECK(stored_energy(c, along(Vec3(1e-3, 0, 0))) == doctest::Approx(0.75e-3).epsilon(1e-3));
    CHECK(stored_energy(c, along(Vec3(0.0), Vec3(0, 0.01, 0))) == doctest::Approx(0.6e-3).epsilon(1e-3));
    CHECK(stored_energy(c, {}) == 0.0);
    // Extend the linear spring slowly, up to three times its saturation offset, and swing the angular one.
    double work = 0.0, turned = 0.0;
    const double step = 1e-6;
    for (double x = 0.5 * step; x < 0.04; x += step) {
        work += step * coupling_force(c, along(Vec3(x, 0, 0)), along(Vec3(x, 0, 0)), 1e-3).force.x;
        REQUIRE(stored_energy(c, along(Vec3(x + 0.5 * step, 0, 0))) <= work * (1 + 1e-9));
        const Offset turn = along(Vec3(0.0), Vec3(0, 0, std::sin(10.0 * x)));
        turned += 10.0 * step * coupling_force(c, turn, turn, 1e-3).torque.z;
        REQUIRE(stored_energy(c, turn) <= turned * (1 + 1e-3) + 1e-9);
    }
}

TEST_CASE("Coupling: without force output it keeps its stiffness as a weight and stores no energy") {
    CouplingRange range;
    range.max_force = range.max_torque = 0.0;
    const Coupling c = make_coupling(range);
    CHECK(c.stiffness > 0.0);
    CHECK(c.torsion > 0.0);
    const Offset off{Vec3(0.01, 0.0, 0.0), Vec3(0.0, 0.1, 0.0)};
    const OutputCommand felt = coupling_force(c, off, {}, range.dt);
    CHECK(felt.force == Vec3(0.0));
    CHECK(felt.torque == Vec3(0.0));
    CHECK(stored_energy(c, off) == 0.0);
}

}  // namespace proxy_coupling_test
