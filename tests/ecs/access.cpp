#include "engine/ecs/system.hpp"

#include <doctest/doctest.h>

#include "engine/ecs/registry.hpp"

using namespace bolt::ecs;

namespace {

struct Torque {
    double value = 0.0;
};
struct Angle {
    double value = 0.0;
};
struct Picture {
    int model = 0;
};
using Small = Registry<Torque, Angle>;
using Large = Registry<Picture, Angle, Torque>;
using Turn = Access<Angle, const Torque>;

void turn(const Turn& world) {
    world.view<Angle, const Torque>().each(
        [](Angle& angle, const Torque& torque) { angle.value += torque.value; });
}

template <class World>
double turned(double torque) {
    World world;
    world.template add<Torque>(world.create(), 100.0);  // has no angle
    const Entity nut = world.create();
    world.template add<Angle>(nut, 1.0);
    world.template add<Torque>(nut, torque);
    turn(world);
    return world.template only<Angle>().value;
}

template <class World, class Component>
concept writes = requires(World world) {
    world.template only<Component>() = {};
};

}  // namespace

TEST_CASE("Access: one function serves every registry that has its components") {
    CHECK(turned<Small>(2.0) == 3.0);
    CHECK(turned<Large>(2.0) == 3.0);
}

TEST_CASE("Access: a component that the access lists as const cannot be written") {
    CHECK(writes<Turn, Angle>);
    CHECK_FALSE(writes<Turn, Torque>);
    CHECK_FALSE(std::is_convertible_v<const Small&, Turn>);
    CHECK(std::is_convertible_v<const Small&, Access<const Angle, const Torque>>);
    CHECK_FALSE(std::is_convertible_v<int&, Turn>);
}

TEST_CASE("Access: a narrower access refers to the same components") {
    Large world;
    const Entity nut = world.create();
    world.add<Torque>(nut, 1.0);
    world.add<Angle>(nut);
    const Turn wide(world);
    const Access<const Torque> narrow(wide);
    world.get<Torque>(nut).value = 5.0;
    CHECK(narrow.only<Torque>().value == 5.0);
    REQUIRE(narrow.find<Torque>(nut) != nullptr);
    CHECK(narrow.find<Torque>(Entity{7, 1}) == nullptr);
}
