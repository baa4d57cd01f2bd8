#include "haptics/force/device_mapping.hpp"

#include <doctest/doctest.h>

#include <initializer_list>

using namespace bolt;
using namespace bolt::force;

TEST_CASE("Torque rendering: the largest torque uses four fifths of the range; smaller ranges are unscaled") {
    OutputLimits limits;
    limits.torque = 3.1;
    CHECK(make_torque_rendering(limits, 210.0, 0.23).scale * 210.0 == doctest::Approx(0.8 * 3.1));
    CHECK(make_torque_rendering(limits, 2.0, 0.23).scale == 1.0);
    CHECK(make_torque_rendering(limits, 0.0, 0.23).scale == 1.0);
    CHECK(make_torque_rendering(limits, 210.0, 0.23).as_force == 0.0);
}

TEST_CASE("Torque rendering: without torque output it is a force at the handle, unscaled if in range") {
    OutputLimits limits;
    limits.torque = 0.0;
    limits.force = 12.0;
    const TorqueRendering scaled = make_torque_rendering(limits, 210.0, 0.23);
    CHECK(scaled.scale == 0.0);
    CHECK(scaled.as_force * 210.0 == doctest::Approx(0.8 * 12.0));
    CHECK(make_torque_rendering(limits, 1.5, 0.23).as_force == doctest::Approx(1.0 / 0.23));
}

TEST_CASE("Torque rendering: resistance to tightening turns the hand about +axis, as torque and as force") {
    const Vec3 axis(0, 1, 0), handle(1, 0, 0);
    const OutputCommand torque = render_torque({0.01, 0.0}, 100.0, axis, handle);
    CHECK(torque.torque == Vec3(0, 1, 0));
    CHECK(torque.force == Vec3(0.0));
    const OutputCommand force = render_torque({0.0, 0.05}, 100.0, axis, handle);
    CHECK(force.torque == Vec3(0.0));
    // A rotation about the axis moves the end of the handle along axis x handle.
    CHECK(force.force == 5.0 * glm::cross(axis, handle));
}

TEST_CASE("Torque rendering: the stored energy is the work of the rendered torque") {
    const double stiffness = 400.0, length = 0.25, wound = 0.05;  // N·m/rad, m, rad
    for (const TorqueRendering& r : {TorqueRendering{0.01, 0.0}, TorqueRendering{0.0, 0.05}}) {
        double work = 0.0;
        const int steps = 100'000;
        for (int i = 0; i < steps; ++i) {
            const double torque = stiffness * wound * (i + 0.5) / steps;
            const OutputCommand out = render_torque(r, torque, Vec3(0, 1, 0), Vec3(1, 0, 0));
            const double turn = wound / steps;
            work += glm::dot(out.torque, Vec3(0, turn, 0)) + glm::dot(out.force, Vec3(0, 0, -turn * length));
        }
        CHECK(work == doctest::Approx(stored_torque_energy(r, stiffness * wound, stiffness, length)));
    }
}
