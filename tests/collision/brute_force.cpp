// Contact queries compared with exact but slow reference computations.

#include <doctest/doctest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <optional>
#include <string>

#include "haptics/collision/narrow_phase.hpp"
#include "tests/collision/support.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/skip.hpp"

namespace collision_brute_force_test {

using namespace bolt;
using namespace bolt::collision;
using namespace contact_test;

namespace {

// Divisor of the number of samples under a sanitizer. tests/contact_validation runs the same code; the limits
// apply to the release build.
constexpr int fewer = test::sanitized ? 10 : 1;

struct Case {
    std::string name;
    ContactMesh mesh;
    Vec3 middle;
    double size;
};

std::vector<Case> cases() {
    std::vector<Case> all;
    all.push_back({"box", box(Vec3(-0.02, -0.01, -0.015), Vec3(0.02, 0.01, 0.015)).mesh(), Vec3(0.0), 0.022});
    all.push_back({"ball", ball(0.015).mesh(), Vec3(0.0), 0.015});
    all.push_back({"rib", box(Vec3(-0.02, 0.0, -0.0005), Vec3(0.02, 0.01, 0.0005)).mesh(),
                   Vec3(0.0, 0.005, 0.0), 0.02});
    all.push_back({"casing", casing().mesh(), Vec3(0.02, 0.01, 0.015), 0.022});
    return all;
}

CollisionWorld one(const ContactMesh& mesh, bool moves = false) {
    const Obstacle obstacle{ObstacleId::fixed(7), &mesh, {}, moves};
    return make_world({&obstacle, 1}).value();
}

Vec3 random_offset(Random& random) {
    return Vec3(random.uniform(-0.8, 0.8), random.uniform(-0.8, 0.8), random.uniform(-0.8, 0.8));
}

// Shifts the tool along `way` until the surfaces just cross, then by `deeper` (m). Empty if they never cross
// or cross at the start.
std::optional<Pose> push_in(const ClosedSurface& still, const ClosedSurface& tool, const Pose& start,
                            const Vec3& way, double deeper) {
    const auto at = [&](double s) { return Pose{start.position + s * way, start.orientation}; };
    const auto crosses = [&](double s) { return contact_oracle::cross(still.tree, tool.tree, at(s)); };
    double free = -1.0;
    double in = 0.0;
    for (double s = 0.0; s < 0.08; s += 0.8 * mm) {
        if (crosses(s)) {
            if (free < 0.0) return std::nullopt;
            in = s;
            break;
        }
        free = s;
    }
    if (in == 0.0) return std::nullopt;
    while (in - free > 1e-6) {
        const double middle = 0.5 * (free + in);
        (crosses(middle) ? in : free) = middle;
    }
    return at(in + deeper);
}

}  // namespace

TEST_CASE("Signed distance: points have the distances of brute force") {
    Random random(11);
    for (const Case& c : cases()) {
        CAPTURE(c.name);
        const CollisionWorld world = one(c.mesh);
        const ClosedSurface surface = surface_of(c.mesh);
        double worst = 0.0;
        for (int i = 0; i < 25'000 / fewer; ++i) {
            // Half of the points are within a millimetre of the surface.
            Vec3 p = c.middle + c.size * Vec3(random.normal(), random.normal(), random.normal());
            if (i % 2 == 0) p = near_surface(surface, mm, random);
            worst = std::max(worst, std::abs(collision::signed_distance(world, p) -
                                             contact_oracle::signed_distance(surface, p)));
        }
        CHECK(worst <= 1e-6);
    }
}

// Compares the nearest contact with the distance of the two surfaces over all pairs of triangles.
TEST_CASE("Narrow phase: the distance of two solids with sharp edges equals brute force") {
    Random random(12);
    const std::vector<ContactMesh> parts{box(Vec3(-0.012, -0.002, -0.005), Vec3(0.03, 0.002, 0.005)).mesh()};
    const ToolShape tool = make_tool(parts, {}).value();
    const ClosedSurface moving = surface_of(parts);
    for (const Case& c : cases()) {
        if (c.name == "ball") continue;
        CAPTURE(c.name);
        const CollisionWorld world = one(c.mesh);
        NarrowPhaseState state = make_narrow_phase(world, tool);
        const ClosedSurface still = surface_of(c.mesh);
        double worst = 0.0;
        int near = 0;
        for (int i = 0; i < 600 / fewer; ++i) {
            const Vec3 way = random_direction(random);
            const Pose start{c.middle + c.size * random_offset(random) - 0.06 * way, random_turn(random)};
            const auto pose = push_in(still, moving, start, way, -random.uniform(0.0, 2.0) * mm);
            if (!pose) continue;
            if (contact_oracle::cross(still.tree, moving.tree, *pose)) continue;
            const double truth = contact_oracle::gap(still.tree, moving.tree, *pose, 10.0 * mm);
            std::array<Contact, 64> contacts;
            const ContactQueryResult found = find_contacts(world, tool, *pose, 2.5 * mm, state, contacts);
            ++near;
            REQUIRE(found.count > 0);
            worst = std::max(worst, std::abs(contacts[0].distance - truth));
            for (const Contact& k : std::span(contacts).first(found.count)) {
                CHECK(k.obstacle == ObstacleId::fixed(7));
                CHECK(glm::length(k.on_obstacle + k.distance * k.normal - k.on_tool) < 1e-9);
            }
        }
        CHECK(near > 100 / fewer);
        CHECK(worst <= 1e-6);
    }
}

TEST_CASE("Narrow phase: cached bounds never change the result") {
    Random random(13);
    const std::vector<ContactMesh> parts{wrench().mesh()};
    const ToolShape tool = make_tool(parts, {}).value();
    for (const Case& c : cases()) {
        CAPTURE(c.name);
        for (const bool moves : {false, true}) {
            const CollisionWorld world = one(c.mesh, moves);
            NarrowPhaseState warm = make_narrow_phase(world, tool);
            NarrowPhaseState cold = make_narrow_phase(world, tool);
            Vec3 from = c.middle + 1.5 * c.size * random_direction(random);
            Quat turn = random_turn(random);
            std::size_t touching = 0;
            for (int leg = 0; leg < (test::sanitized ? 3 : 10); ++leg) {
                const Vec3 to = c.middle + c.size * random.uniform(0.3, 1.2) * random_direction(random);
                const Quat turned = rotation(random_direction(random) * 0.8) * turn;
                for (int i = 0; i < 60; ++i) {
                    Pose pose{glm::mix(from, to, i / 60.0), glm::slerp(turn, turned, i / 60.0)};
                    std::array<Contact, 24> a;
                    std::array<Contact, 24> b;
                    const double band = 0.3 * mm * (1 + leg % 4);
                    const ContactQueryResult warm_found = find_contacts(world, tool, pose, band, warm, a);
                    clear_cache(cold, world, tool);
                    const ContactQueryResult cold_found = find_contacts(world, tool, pose, band, cold, b);
                    REQUIRE(warm_found.count == cold_found.count);
                    REQUIRE(warm_found.complete_within == cold_found.complete_within);
                    REQUIRE(warm_found.truncated == cold_found.truncated);
                    for (std::size_t k = 0; k < warm_found.count; ++k) {
                        REQUIRE(a[k].distance == b[k].distance);
                        REQUIRE(a[k].feature == b[k].feature);
                        REQUIRE(a[k].on_tool == b[k].on_tool);
                        REQUIRE(a[k].on_obstacle == b[k].on_obstacle);
                        REQUIRE(a[k].normal == b[k].normal);
                    }
                    touching += warm_found.count > 0 ? 1 : 0;
                }
                from = to;
                turn = turned;
            }
            CHECK(touching > (test::sanitized ? 20 : 100));
        }
    }
}

TEST_CASE("Narrow phase: penetration over 0.1 mm is never missed, although samples alone miss some") {
    Random random(14);
    const std::vector<ContactMesh> parts{wrench().mesh()};
    const ToolShape tool = make_tool(parts, {}).value();
    const ClosedSurface moving = surface_of(parts);
    int met = 0;
    int missed_by_points = 0;
    for (const Case& c : cases()) {
        CAPTURE(c.name);
        const CollisionWorld world = one(c.mesh);
        const ClosedSurface still = surface_of(c.mesh);
        NarrowPhaseState state = make_narrow_phase(world, tool);
        int here = 0;
        for (int i = 0; i < (test::sanitized ? 8 : 40); ++i) {
            const Vec3 way = random_direction(random);
            const Pose start{c.middle + c.size * random_offset(random) - 0.05 * way, random_turn(random)};
            const auto pose = push_in(still, moving, start, way, random.uniform(0.1, 0.4) * mm);
            if (!pose) continue;
            if (contact_oracle::depth(still, moving, *pose, contact_oracle::from_50_um) < 0.1 * mm) continue;
            ++here;
            std::array<Contact, 32> contacts;
            const ContactQueryResult found = find_contacts(world, tool, *pose, 0.5 * mm, state, contacts);
            REQUIRE(found.count > 0);
            CHECK(contacts[0].distance < 0.0);
            double points = 1.0;
            for (const SurfaceSample& s : tool.samples.samples)
                points = std::min(points, collision::signed_distance(world, *pose * s.at));
            missed_by_points += points > 0.0 ? 1 : 0;
        }
        CHECK(here > (test::sanitized ? 1 : 10));
        met += here;
    }
    MESSAGE(met << " meet, points of the tool alone miss " << missed_by_points);
    if (test::sanitized)
        test::skip_part("too few poses under a sanitizer for one that only edges find");
    else
        CHECK(missed_by_points > 0);
}

}  // namespace collision_brute_force_test
