// What fades before the nut that is due: everything while the hand works there, only the hand while it waits.
#include <doctest/doctest.h>

#include "game/scene/systems.hpp"
#include "tests/trainer/player.hpp"

TEST_CASE("what hides the due nut fades: a hand that waits alone, and about more of it") {
    using namespace bolt;
    const content::Assembly assembly = trainer_test::assembly("cover-m8");
    play::CourseOptions options;
    const auto begun = play::prepare(assembly, options);
    REQUIRE(begun);
    scene::World world;
    const ecs::Entity casing = world.create(), due = world.create(), other = world.create(),
                      hand = world.create();
    for (const ecs::Entity entity : {casing, due, other, hand}) world.add<scene::CanFade>(entity, true);
    world.add<scene::OfJoint>(due, std::size_t{1});
    world.add<scene::OfJoint>(other, std::size_t{2});
    world.add<scene::Fingers>(hand);
    const auto fades = [&](ecs::Entity entity) { return world.get<scene::CanFade>(entity).fades; };
    render::Scene drawn;
    scene::keep_in_sight(world, drawn, begun->setup, begun->state, 1, scene::Hides::hand);
    const float waiting = drawn.cut_away.radius;
    CHECK(drawn.cut_away.strength == 1.0F);
    CHECK_FALSE(fades(casing));
    CHECK_FALSE(fades(due));
    CHECK_FALSE(fades(other));
    CHECK(fades(hand));
    scene::keep_in_sight(world, drawn, begun->setup, begun->state, 1);
    CHECK(drawn.cut_away.radius < waiting);
    CHECK(fades(casing));
    CHECK_FALSE(fades(due));
    CHECK(fades(other));
    CHECK(fades(hand));
}
