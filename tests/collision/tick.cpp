// Requirements of the servo's tick on contact queries, with the shipped reducer and wrench.

#include <doctest/doctest.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "haptics/proxy/god_object.hpp"
#include "tests/collision/reducer.hpp"
#include "tests/support/forbidden.hpp"
#include "tests/support/sanitized.hpp"

namespace collision_tick_test {

using namespace bolt;
using namespace bolt::collision;
using namespace bolt::proxy;
using namespace contact_test;

namespace {

constexpr int fewer = test::sanitized ? 10 : 1;

}  // namespace

TEST_CASE("Narrow phase: distances to the reducer's casing equal brute force") {
    const Reducer reducer;
    std::vector<ClosedSurface> casing;
    for (const ContactMesh& part : reducer.casing) casing.push_back(surface_of(part));
    Random random(41);
    double worst = 0.0;
    for (int i = 0; i < 300 / fewer; ++i) {
        const Vec3 p = near_surface(casing[i % 2 == 0 ? 0 : 1], 5.0 * mm, random);
        const double truth = std::min(contact_oracle::signed_distance(casing[0], p),
                                      contact_oracle::signed_distance(casing[1], p));
        worst = std::max(worst, std::abs(collision::signed_distance(reducer.world, p) - truth));
    }
    CHECK(worst <= 1e-6);
}

// The motion resembles a hand that searches with its wrench: slow and fast, rotating about the contact, at
// most 1 mm deep. At greater depths thousands of points are inside and exceed the output; which of them are
// kept is unspecified.
TEST_CASE("Narrow phase: on the reducer a warm cache gives the same contacts as an empty one") {
    const Reducer reducer;
    Random random(42);
    NarrowPhaseState warm = make_narrow_phase(reducer.world, reducer.tool);
    NarrowPhaseState cold = make_narrow_phase(reducer.world, reducer.tool);
    const int wanted = test::sanitized ? 60 : 1500;
    int compared = 0, touching = 0;
    while (compared < wanted) {
        Pose pose = reducer.at_the_surface(random);
        Vec3 about = pose.position;
        bool deep = false;
        for (int leg = 0; leg < 8 && !deep; ++leg) {
            const auto size = [&](double least, double most) {
                return std::exp(random.uniform(std::log(least), std::log(most)));
            };
            const Vec3 way = size(0.005, 1.0) * mm * random_direction(random);
            const Quat turn = rotation(size(1e-4, 0.05) * random_direction(random));
            const double band = random.uniform(0.0, 1.0) < 0.8 ? 0.6 * mm : random.uniform(0.1, 1.5) * mm;
            for (int i = 0; i < 12 && !deep; ++i) {
                pose = {about + turn * (pose.position - about) + way, turn * pose.orientation};
                about += way;
                std::array<Contact, 32> a;
                std::array<Contact, 32> b;
                const ContactQueryResult x = find_contacts(reducer.world, reducer.tool, pose, band, warm, a);
                if (x.count > 0) about = a[0].on_tool;
                deep = x.count > 0 && a[0].distance < -1.0 * mm;
                if (deep || i % 4 != 3) continue;
                clear_cache(cold, reducer.world, reducer.tool);
                const ContactQueryResult y = find_contacts(reducer.world, reducer.tool, pose, band, cold, b);
                REQUIRE(x.count == y.count);
                REQUIRE(x.complete_within == y.complete_within);
                for (std::size_t k = 0; k < x.count; ++k) {
                    REQUIRE(a[k].distance == b[k].distance);
                    REQUIRE(a[k].on_tool == b[k].on_tool);
                    REQUIRE(a[k].normal == b[k].normal);
                    REQUIRE(a[k].feature == b[k].feature);
                }
                touching += x.count > 0 ? 1 : 0;
                ++compared;
            }
        }
    }
    MESSAGE("touching " << touching << " of " << compared);
    CHECK(4 * touching > compared);
}

TEST_CASE("Narrow phase: a query allocates nothing, locks nothing, reads no clock") {
    const Reducer reducer;
    Random random(43);
    NarrowPhaseState state = make_narrow_phase(reducer.world, reducer.tool);
    std::vector<Pose> poses;
    for (int i = 0; i < 20; ++i) poses.push_back(reducer.at_the_surface(random));
    std::array<Contact, 32> contacts;
    std::size_t found = 0;
    const test::Forbidden seen = test::forbidden_in([&] {
        for (const Pose& pose : poses)
            found += find_contacts(reducer.world, reducer.tool, pose, 0.6 * mm, state, contacts).count;
        found += occluded(reducer.world, poses[0].position, poses[1].position) ? 1U : 0U;
    });
    CHECK(found > 20);
    CHECK(seen.all() == 0);
    // The counter detects allocations.
    CHECK(test::forbidden_in([&] { (void)make_narrow_phase(reducer.world, reducer.tool); }).allocations > 0);
}

TEST_CASE("Narrow phase: on the reducer first contact is detected in time and persists in depth") {
    const Reducer reducer;
    const ClosedSurface still = surface_of(reducer.casing), moving = surface_of(reducer.wrench);
    NarrowPhaseState state = make_narrow_phase(reducer.world, reducer.tool);
    Random random(44);
    int met = 0;
    for (int i = 0; i < 320 / fewer; ++i) {
        const Pose start = reducer.at_the_surface(random);
        const Vec3 way = random_direction(random);
        const auto at = [&](double s) { return Pose{start.position + s * way, start.orientation}; };
        const auto crosses = [&](double s) { return contact_oracle::cross(still.tree, moving.tree, at(s)); };
        double free = -20.0 * mm;
        double in = 4.0 * mm;
        if (crosses(free) || !crosses(in)) continue;
        while (in - free > 1e-6) {
            const double middle = 0.5 * (free + in);
            (crosses(middle) ? in : free) = middle;
        }
        std::array<Contact, 32> contacts;
        const ContactQueryResult touch =
            find_contacts(reducer.world, reducer.tool, at(free), 0.5 * mm, state, contacts);
        REQUIRE(touch.count > 0);
        // Late detection leaves the god-object, which keeps its skin, at most 0.1 mm deep.
        CHECK(contacts[0].distance < GodObjectParameters{}.skin + 0.1 * mm);
        // After another 0.5 mm along a path that may be oblique, the depth is smaller but must be detected.
        const ContactQueryResult deep =
            find_contacts(reducer.world, reducer.tool, at(in + 0.5 * mm), 0.5 * mm, state, contacts);
        REQUIRE(deep.count > 0);
        CHECK(contacts[0].distance < 0.05 * mm);
        ++met;
    }
    CHECK(met >= std::max(1, 15 / fewer));
}

}  // namespace collision_tick_test
