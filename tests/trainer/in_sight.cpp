// What fades before the nut that is due: everything while the hand works there, only the hand while it waits.
#include <doctest/doctest.h>

#include "game/scene/systems.hpp"
#include "tests/trainer/player.hpp"

TEST_CASE("what hides the due nut fades: a hand that waits alone, and about more of it") {
    using namespace bolt;
    const content::Assembly assembly = trainer_test::assembly("cover-m8");
    session::CourseOptions options;
    const auto begun = session::prepare(assembly, options);
    REQUIRE(begun);
    scene::World world;
    world::add_haptics(world, begun->state);
    const ecs::Entity casing = world.create(), due = world.create(), other = world.create(),
                      hand = world.create();
    for (const ecs::Entity entity : {casing, due, other, hand}) world.add<scene::CanFade>(entity, true);
    world.add<scene::OfJoint>(due, std::size_t{1});
    world.add<scene::OfJoint>(other, std::size_t{2});
    world.add<scene::Fingers>(hand);
    const auto fades = [&](ecs::Entity entity) { return world.get<scene::CanFade>(entity).fades; };
    render::Scene drawn;
    scene::keep_in_sight(world, drawn, begun->setup, 1, scene::Hides::hand);
    const float waiting = drawn.cut_away.radius;
    CHECK(drawn.cut_away.strength == 1.0F);
    CHECK_FALSE(fades(casing));
    CHECK_FALSE(fades(due));
    CHECK_FALSE(fades(other));
    CHECK(fades(hand));
    scene::keep_in_sight(world, drawn, begun->setup, 1);
    CHECK(drawn.cut_away.radius < waiting);
    CHECK(fades(casing));
    CHECK_FALSE(fades(due));
    CHECK(fades(other));
    CHECK(fades(hand));
}

TEST_CASE("an arm that comes past the eye is seen through, one at its length is not") {
    using namespace bolt;
    scene::World world;
    const ecs::Entity one = world.create();
    world.add<scene::Placement>(one);
    world.add<scene::Drawn>(one);
    scene::Fingers& fingers = world.add<scene::Fingers>(one);
    fingers.shown = hand::right_skeleton();
    const Vec3 wrist = fingers.shown.position[hand::wrist],
               back = fingers.shown.rotation[hand::wrist] * Vec3(0.0, 0.0, 1.0);
    const auto opacity = [&](const Vec3& eye) {
        scene::thin_near_arms(world, eye);
        render::Scene drawn;
        scene::present(world, drawn);
        return drawn.objects.at(0).opacity;
    };
    const Vec3 aside = glm::normalize(glm::cross(back, Vec3(0.3, 0.5, 0.8)));
    CHECK(opacity(wrist + 0.5 * back) == 1.0F);                // behind its end
    CHECK(opacity(wrist + 0.2 * back + 0.3 * aside) == 1.0F);  // beside it
    CHECK(opacity(wrist + 0.2 * back + 0.05 * aside) < 0.2F);
    CHECK(opacity(wrist + 0.3 * back) < 0.2F);
    float before = opacity(wrist + 0.1 * back);
    for (double far = 0.10; far < 0.26; far += 0.02) {  // evenly: nothing pops in or out
        const float now = opacity(wrist + 0.1 * back + far * aside);
        CHECK(now >= before);
        CHECK(now - before < 0.25F);
        before = now;
    }
}
