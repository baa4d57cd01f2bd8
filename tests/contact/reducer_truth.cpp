// Whether what truly intersects on the shipped reducer is ever missed. Truth: crossings of triangles with
// triangles, and how deep points spread closely over the triangles that cross lie in the other solid.
#include <doctest/doctest.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "tests/contact/reducer.hpp"
#include "tests/support/sanitized.hpp"

using namespace bolt;
using namespace bolt::contact;
using namespace contact_test;

namespace {

constexpr double mm = 1e-3;
constexpr int fewer = test::sanitized ? 10 : 1;

struct Truth {
    Reducer reducer;
    geometry::Bvh still = tree(reducer.world.shapes[0].solid.mesh, {});

    [[nodiscard]] bool crosses(const Pose& pose) const {
        return first_crossing(still, tree(reducer.tool.solid.mesh, pose), geometry::Pose{}).has_value();
    }

    // How deep the wrench's surface is in the casing, and the casing's in the wrench, near the place.
    [[nodiscard]] double deepest(const Pose& pose) const {
        const Solid& casing = reducer.world.shapes[0].solid;
        const Solid& wrench = reducer.tool.solid;
        return std::max(deepest(wrench, casing, pose), deepest(casing, wrench, inverse(pose)));
    }

  private:
    static double deepest(const Solid& mine, const Solid& other, const Pose& to_other) {
        constexpr double spacing = 0.3 * mm;
        double depth = 0.0;
        const Vec3 middle = inverse(to_other) * other.middle;
        for (std::size_t t = 0; t < mine.mesh.triangles.size(); ++t) {
            const auto [a, b, c] = corners(mine.mesh, t);
            const Vec3 low = glm::min(glm::min(a, b), c) - other.radius;
            const Vec3 high = glm::max(glm::max(a, b), c) + other.radius;
            if (glm::any(glm::lessThan(middle, low)) || glm::any(glm::greaterThan(middle, high))) continue;
            const Vec3 at = to_other * ((a + b + c) / 3.0);
            const double size = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
            if (near_point(other, at, size, 0.0, {}).distance > size) continue;
            const int steps = 1 + static_cast<int>(size / spacing);
            for (int i = 0; i <= steps; ++i)
                for (int k = 0; k <= steps - i; ++k) {
                    const Vec3 p = a + (b - a) * (double(i) / steps) + (c - a) * (double(k) / steps);
                    const Vec3 q = to_other * p;
                    if (glm::any(glm::lessThan(q, other.box.low)) ||
                        glm::any(glm::greaterThan(q, other.box.high)))
                        continue;
                    // Told right wherever it is deeper than that.
                    depth = std::max(depth, -near_point(other, q, 20.0 * mm, 0.0, {}).distance);
                }
        }
        return depth;
    }
};

}  // namespace

TEST_CASE("on the reducer: what intersects by more than 0.1 mm is never missed") {
    const Truth truth;
    ProximityState state = make_proximity(truth.reducer.world, truth.reducer.tool);
    std::array<Contact, 32> contacts;
    const auto told = [&](const Pose& pose) {
        const Found found =
            find_contacts(truth.reducer.world, truth.reducer.tool, pose, 0.6 * mm, state, contacts);
        return found.count > 0 ? contacts[0].distance : 1.0;
    };
    // Was once told to be free by 50 um.
    const Pose once{Vec3(0.32634405, 0.15625746, -0.12115136),
                    glm::normalize(Quat(0.78773209, 0.11951799, 0.22161258, -0.56221126))};
    CHECK(truth.crosses(once));
    CHECK(truth.deepest(once) > 0.1 * mm);
    CHECK(told(once) < -0.1 * mm);

    Random random(61);
    int deep = 0;
    double most = 0.0;  // that was not told
    for (int i = 0; i < 300 / fewer; ++i) {
        const Pose start = truth.reducer.at_the_surface(random);
        const Vec3 way = random_direction(random);
        const auto at = [&](double s) { return Pose{start.position + s * way, start.orientation}; };
        double free = -20.0 * mm;
        double in = 4.0 * mm;
        if (truth.crosses(at(free)) || !truth.crosses(at(in))) continue;
        while (in - free > 1e-5) {
            const double middle = 0.5 * (free + in);
            (truth.crosses(at(middle)) ? in : free) = middle;
        }
        // Come to along the way, as a god-object would.
        for (double s = -3.0 * mm; s < 0.0; s += 0.3 * mm) told(at(in + s));
        for (const double further : {0.05, 0.12, 0.2, 0.4, 0.8}) {
            const Pose pose = at(in + further * mm);
            const double distance = told(pose);
            if (distance < 0.0) {
                ++deep;
                continue;
            }
            const double depth = truth.deepest(pose);
            CAPTURE(i);
            CAPTURE(further);
            CHECK(depth < 0.1 * mm);
            most = std::max(most, depth);
        }
    }
    CHECK(deep > 50 / fewer);
    MESSAGE(deep << " told, what was not lies " << 1e6 * most << " um deep at most");
}
