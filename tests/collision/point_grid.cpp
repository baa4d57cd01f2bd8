// The grid of points, compared with all distances.
#include "haptics/collision/point_grid.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "engine/base/random.hpp"

namespace collision_point_grid_test {

using namespace bolt;

TEST_CASE("Point grid: a point is near exactly if one of all added points is within the distance") {
    Random random(77, 0);
    int near = 0, far = 0;
    for (int run = 0; run < 40; ++run) {
        const double size = random.uniform(0.2e-3, 5e-3), extent = random.uniform(2.0, 12.0) * size;
        const Vec3 centre(random.normal(), random.normal(), random.normal());
        const auto point = [&] {
            return centre + Vec3(random.uniform(-extent, extent), random.uniform(-extent, extent),
                                 random.uniform(-extent, extent));
        };
        collision::PointGrid grid(size);
        std::vector<Vec3> points;
        for (int i = 0; i < 300; ++i) {
            const Vec3 p = point();
            const bool expected = std::any_of(points.begin(), points.end(), [&](const Vec3& other) {
                return glm::dot(p - other, p - other) < size * size;
            });
            REQUIRE(grid.has_near(p) == expected);
            ++(expected ? near : far);
            if (i % 3 != 0) continue;
            grid.add(p);
            points.push_back(p);
        }
    }
    CHECK(near > 500);
    CHECK(far > 500);
}

}  // namespace collision_point_grid_test
