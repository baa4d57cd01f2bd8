// Contact queries on the shipped reducer against the oracle: no intersection deeper than 0.1 mm is missed.
#include <doctest/doctest.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "tests/collision/reducer.hpp"
#include "tests/support/sanitized.hpp"

using namespace bolt;
using namespace bolt::collision;
using namespace contact_test;

namespace {

constexpr int fewer = test::sanitized ? 10 : 1;

struct Oracle {
    Reducer reducer;
    ClosedSurface still = surface_of(reducer.casing), moving = surface_of(reducer.wrench);

    [[nodiscard]] bool crosses(const Pose& pose) const {
        return contact_oracle::cross(still.tree, moving.tree, pose);
    }
    [[nodiscard]] double deepest(const Pose& pose) const {
        return contact_oracle::depth(still, moving, pose, contact_oracle::from_50_um);
    }
};

}  // namespace

TEST_CASE("Narrow phase: on the reducer no penetration deeper than 0.1 mm is missed") {
    const Oracle oracle;
    NarrowPhaseState state = make_narrow_phase(oracle.reducer.world, oracle.reducer.tool);
    std::array<Contact, 32> contacts;
    const auto told = [&](const Pose& pose) {
        const ContactQueryResult found =
            find_contacts(oracle.reducer.world, oracle.reducer.tool, pose, 0.6 * mm, state, contacts);
        return found.count > 0 ? contacts[0].distance : 1.0;
    };
    // Regression: a query once reported 50 µm of clearance at this pose.
    const Pose once{Vec3(0.32634405, 0.15625746, -0.12115136),
                    glm::normalize(Quat(0.78773209, 0.11951799, 0.22161258, -0.56221126))};
    CHECK(oracle.crosses(once));
    CHECK(oracle.deepest(once) > 0.1 * mm);
    CHECK(told(once) < -0.1 * mm);

    Random random(61);
    int deep = 0;
    double most = 0.0;  // m, greatest depth that was not reported
    for (int i = 0; i < 300 / fewer; ++i) {
        const Pose start = oracle.reducer.at_the_surface(random);
        const Vec3 way = random_direction(random);
        const auto at = [&](double s) { return Pose{start.position + s * way, start.orientation}; };
        double free = -20.0 * mm;
        double in = 4.0 * mm;
        if (oracle.crosses(at(free)) || !oracle.crosses(at(in))) continue;
        while (in - free > 1e-5) {
            const double middle = 0.5 * (free + in);
            (oracle.crosses(at(middle)) ? in : free) = middle;
        }
        // Approach along the path, as the god-object does, so that the cache is warm.
        for (double s = -3.0 * mm; s < 0.0; s += 0.3 * mm) told(at(in + s));
        for (const double further : {0.05, 0.12, 0.2, 0.4, 0.8}) {
            const Pose pose = at(in + further * mm);
            const double distance = told(pose);
            if (distance < 0.0) {
                ++deep;
                continue;
            }
            const double depth = oracle.deepest(pose);
            CAPTURE(i);
            CAPTURE(further);
            CHECK(depth < 0.1 * mm);
            most = std::max(most, depth);
        }
    }
    CHECK(deep > 50 / fewer);
    MESSAGE(deep << " told, what was not lies " << 1e6 * most << " um deep at most");
}
