#include <doctest/doctest.h>

#include "engine/base/random.hpp"
#include "haptics/proxy/constraint_solver.hpp"

namespace proxy_travel_test {

using namespace bolt;
using namespace bolt::collision;
using namespace bolt::proxy;

namespace {

Vec3 any(Random& random, double size) {
    return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

}  // namespace

TEST_CASE("Travel bound: no point of the tool's box exceeds it, and the farthest corner nearly reaches it") {
    Random random(7);
    double closest = 0.0, saved = 0.0;
    for (int trial = 0; trial < 2000; ++trial) {
        const BoundingBox box{Vec3(-0.02, -0.03, -0.006), Vec3(0.28, 0.03, 0.006)};
        const double radius = glm::length(Vec3(0.28, 0.03, 0.006));
        const Pose from{any(random, 1.0), glm::normalize(rotation(any(random, 2.0)))};
        const Twist twist{any(random, 2e-3), any(random, trial % 2 == 0 ? 5e-3 : 0.5)};
        const double told = travel(twist, radius, from.orientation, box);
        CHECK(told <= travel(twist, radius));
        double furthest = 0.0;
        for (int i = 0; i < 40; ++i) {
            const Vec3 share(random.uniform(), random.uniform(), random.uniform());
            // The first eight points are the corners.
            const Vec3 at = i < 8 ? Vec3(i & 1, i >> 1 & 1, i >> 2) : share;
            const Vec3 point = box.low + at * (box.high - box.low);
            for (const double part : {1.0, random.uniform()})
                furthest = std::max(furthest, glm::length(moved(from, part * twist) * point - from * point));
        }
        CHECK(furthest <= told);
        if (trial % 2 == 0) closest = std::max(closest, 1.0 - furthest / told);
        saved += told / travel(twist, radius) / 2000.0;
    }
    CHECK(closest < 0.02);  // small motions only
    CHECK(saved < 0.95);
}

}  // namespace proxy_travel_test
