// Fading in front of the due nut: all parts while the hand works there, only the hand while it waits.
#include <doctest/doctest.h>

#include "game/scene/systems.hpp"
#include "tests/trainer/player.hpp"

TEST_CASE(
    "Cut-away: a waiting hand alone fades in front of the due nut; during work all other parts fade, in a "
    "smaller area") {
    using namespace bolt;
    const content::Assembly assembly = trainer_test::assembly("cover-m8");
    session::LessonOptions options;
    const auto begun = session::prepare_session(assembly, options);
    REQUIRE(begun);
    scene::SceneWorld world;
    world::add_haptics(world, begun->state);
    const ecs::Entity casing = world.create(), due = world.create(), other = world.create(),
                      hand = world.create();
    for (const ecs::Entity entity : {casing, due, other, hand}) world.add<scene::Fadable>(entity, true);
    world.add<scene::JointPart>(due, std::size_t{1});
    world.add<scene::JointPart>(other, std::size_t{2});
    world.add<scene::SkinnedHand>(hand);
    const auto fades = [&](ecs::Entity entity) { return world.get<scene::Fadable>(entity).fades; };
    render::Scene drawn;
    scene::fade_occluders(world, drawn, begun->setup, 1, scene::Occluders::hand);
    const float waiting = drawn.cut_away.radius;
    CHECK(drawn.cut_away.strength == 1.0F);
    CHECK_FALSE(fades(casing));
    CHECK_FALSE(fades(due));
    CHECK_FALSE(fades(other));
    CHECK(fades(hand));
    scene::fade_occluders(world, drawn, begun->setup, 1);
    CHECK(drawn.cut_away.radius < waiting);
    CHECK(fades(casing));
    CHECK_FALSE(fades(due));
    CHECK(fades(other));
    CHECK(fades(hand));
}

TEST_CASE("Arms: an arm close to the eye fades, a distant one does not") {
    using namespace bolt;
    scene::SceneWorld world;
    const ecs::Entity one = world.create();
    world.add<scene::Transform>(one);
    world.add<scene::Drawable>(one);
    scene::SkinnedHand& fingers = world.add<scene::SkinnedHand>(one);
    fingers.shown = hand::right_skeleton();
    const Vec3 wrist = fingers.shown.position[hand::wrist],
               back = fingers.shown.rotation[hand::wrist] * Vec3(0.0, 0.0, 1.0);
    const auto opacity = [&](const Vec3& eye) {
        scene::fade_near_arms(world, eye);
        render::Scene drawn;
        scene::appearance_system(world);
        view::collect_objects(world, drawn);
        return drawn.objects.at(0).opacity;
    };
    const Vec3 aside = glm::normalize(glm::cross(back, Vec3(0.3, 0.5, 0.8)));
    CHECK(opacity(wrist + 0.5 * back) == 1.0F);                // behind its end
    CHECK(opacity(wrist + 0.2 * back + 0.3 * aside) == 1.0F);  // beside it
    CHECK(opacity(wrist + 0.2 * back + 0.05 * aside) < 0.2F);
    CHECK(opacity(wrist + 0.3 * back) < 0.2F);
    float before = opacity(wrist + 0.1 * back);
    for (double far = 0.10; far < 0.26; far += 0.02) {  // gradually: nothing pops in or out
        const float now = opacity(wrist + 0.1 * back + far * aside);
        CHECK(now >= before);
        CHECK(now - before < 0.25F);
        before = now;
    }
}
