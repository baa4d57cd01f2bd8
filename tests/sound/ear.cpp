// What there is to be heard of ticks that are written by hand.

#include "game/sound/event_detection.hpp"

#include "haptics/servo/tool_contact.hpp"
#include "tests/sound/support.hpp"
#include "tests/support/forbidden.hpp"

using namespace bolt;
using namespace bolt::sound;
using collision::ObstacleId;

namespace {

constexpr double dt = 1e-3;

struct Script {
    servo::Setup setup;
    Ear ear;
    servo::Output output;
    Cues cues;
    test::HapticWorld world{2};

    explicit Script(const force::OutputLimits& limits = {}) : setup(test::two_joints(limits)) {}
    Heard tick() { return hear(ear, setup, world.write(output), cues); }
    // So many ticks at this speed; the strikes that are heard meanwhile.
    std::vector<float> move(const Vec3& velocity, int ticks) {
        std::vector<float> strikes;
        for (int i = 0; i < ticks; ++i) {
            output.tool.position += dt * velocity;
            if (const Heard heard = tick(); heard.strike > 0.0F) strikes.push_back(heard.strike);
        }
        return strikes;
    }
    Heard turn(double speed) {
        output.nut_angle += dt * speed;
        return tick();
    }
};

// The strikes of a wrench that comes at a wall and stays there.
std::vector<float> against_wall(double speed) {
    Script script;
    std::vector<float> strikes = script.move({0, -speed, 0}, 50);
    script.output.touched = ObstacleId::fixed(3);
    for (const float more : script.move({}, 50)) strikes.push_back(more);
    return strikes;
}

}  // namespace

TEST_CASE("a wrench that meets something is heard once, as hard as it came") {
    for (const double speed : {0.05, 0.1, 0.3, 1.0}) {
        CAPTURE(speed);
        const std::vector<float> strikes = against_wall(speed);
        REQUIRE(strikes.size() == 1);
        CHECK(strikes[0] == doctest::Approx(speed).epsilon(1e-3));
    }
    CHECK(against_wall(0.01).empty());
}

TEST_CASE(
    "the end of the handle strikes as well, though the jaw hardly moves; not when it only turns a nut") {
    for (const bool turns : {false, true}) {
        Script script;
        if (turns) script.output.joint = 1;
        const double handle = script.setup.wrench.handle_length, turn = 0.2 / handle;  // rad/s
        std::vector<float> strikes;
        for (int i = 0; i < 100; ++i) {
            if (i == 50) script.output.touched = turns ? ObstacleId::nut(1) : ObstacleId::fixed(3);
            const double angle = turn * dt * std::min(i, 50);
            script.output.tool.orientation = glm::angleAxis(angle, Vec3(0, 1, 0));
            if (const Heard heard = script.tick(); heard.strike > 0.0F) strikes.push_back(heard.strike);
        }
        if (turns) {
            CHECK(strikes.empty());
            continue;
        }
        REQUIRE(strikes.size() == 1);
        CHECK(strikes[0] == doctest::Approx(0.2).epsilon(1e-2));
    }
}

TEST_CASE("what is met is iron or a nut, or as its name says") {
    const content::Loaded loaded = content::load_assembly("cover-m8");
    REQUIRE(loaded.ok());
    const std::vector<session::ObstacleName> names{{ObstacleId::fixed(0), "housing"},
                                                   {ObstacleId::fixed(1), "B1_bolt"},
                                                   {ObstacleId::fixed(2), "B10_bolt"},
                                                   {ObstacleId::fixed(4), "B4_washer_nut"},
                                                   {ObstacleId::nut(0), "B1_nut"}};
    const std::vector<Met> still = materials(loaded.assembly, names);
    CHECK(still == std::vector<Met>{Met::casing, Met::nut, Met::casing, Met::casing, Met::nut});
    const ObstacleId nut = ObstacleId::nut(1);
    for (const ObstacleId id :
         {ObstacleId::fixed(0), ObstacleId::fixed(1), ObstacleId::fixed(2), ObstacleId::fixed(3),
          ObstacleId::fixed(4), ObstacleId::fixed(5), ObstacleId::fixed(1001), nut}) {
        CAPTURE(id.index());
        Script script;
        script.ear.still = still;
        script.move({0, -0.2, 0}, 50);
        script.output.touched = id;
        Heard struck;
        for (int i = 0; i < 20; ++i)
            if (const Heard heard = script.tick(); heard.strike > 0.0F) struck = heard;
        CHECK(struck.strike > 0.1F);
        CHECK((struck.met == Met::nut) ==
              (id == ObstacleId::fixed(1) || id == ObstacleId::fixed(4) || id == nut));
    }
}

TEST_CASE(
    "no strike: in the air, when it goes faster, held back for a tick, taken into the hand, a hand that "
    "stops") {
    Script air;
    air.move({0.3, 0, 0}, 50);
    CHECK(air.move({}, 50).empty());

    Script away;
    away.output.touched = ObstacleId::fixed(3);
    away.move({}, 50);
    CHECK(away.move({0.4, 0, 0}, 50).empty());

    Script held_back;
    held_back.output.touched = ObstacleId::fixed(3);
    held_back.move({0.3, 0, 0}, 50);
    CHECK(held_back.move({}, 1).empty());
    CHECK(held_back.move({0.3, 0, 0}, 50).empty());

    Script taken;
    taken.output.touched = ObstacleId::fixed(3);
    taken.move({}, 50);
    CHECK(taken.move({400, 0, 0}, 1).empty());
    CHECK(taken.move({}, 50).empty());

    Script stops;  // at 4 m/s²
    stops.output.touched = ObstacleId::fixed(3);
    stops.move({0.2, 0, 0}, 50);
    for (int i = 0; i <= 50; ++i) CHECK(stops.move({0.2 - 0.004 * i, 0, 0}, 1).empty());
}

TEST_CASE("what trembles against a wall knocks no more than what rings on") {
    Script script;
    script.output.touched = ObstacleId::fixed(3);
    std::size_t strikes = 0;
    for (int i = 0; i < 100; ++i) strikes += script.move({0, i % 2 == 0 ? -0.1 : 0.1, 0}, 5).size();
    CHECK(strikes >= 1);
    CHECK(strikes <= 30);  // in half a second and a hundred times to and fro
}

TEST_CASE(
    "sliding is heard with its speed and what presses across it, and not in the air or with the nut that "
    "turns") {
    Script script;
    script.output.force = Vec3(3.0, 4.0, 0.0);
    script.move({0.2, 0, 0}, 10);
    CHECK(script.tick().slide == 0.0F);
    script.output.touched = ObstacleId::fixed(3);
    script.output.tool.position += Vec3(0.2 * dt, 0, 0);
    const Heard heard = script.tick();
    CHECK(heard.slide == doctest::Approx(0.2));
    CHECK(heard.press == doctest::Approx(4.0));
    script.output.joint = 1;
    script.output.touched = ObstacleId::nut(1);
    script.output.tool.position += Vec3(0.2 * dt, 0, 0);
    CHECK(script.tick().slide == 0.0F);
    script.output.touched = ObstacleId::nut(0);  // the neighbour
    script.output.tool.position += Vec3(0.2 * dt, 0, 0);
    CHECK(script.tick().slide == doctest::Approx(0.2));
}

TEST_CASE("without a device that renders forces a usual one is taken for what presses") {
    force::OutputLimits none;
    none.force = none.torque = 0.0;
    Script script(none);
    script.output.touched = ObstacleId::fixed(3);
    script.move({0.2, 0, 0}, 10);
    script.output.tool.position += Vec3(0.2 * dt, 0, 0);
    CHECK(script.tick().press > 1.0F);
}

TEST_CASE("a nut runs while it bears nothing and creeps when it does, either way round") {
    Script script;
    script.output.joint = 0;
    script.tick();
    for (const double speed : {9.0, -9.0}) {
        const Heard heard = script.turn(speed);
        CHECK(heard.run == doctest::Approx(9.0));
        CHECK(heard.creep == 0.0F);
        CHECK(heard.load == 0.0F);
    }
    const double full = script.setup.group.joints[0].reference_load;
    REQUIRE(full > 0.0);
    script.output.clamp = 0.5 * full;
    const Heard heard = script.turn(0.4);
    CHECK(heard.run == 0.0F);
    CHECK(heard.creep == doctest::Approx(0.4));
    CHECK(heard.load == doctest::Approx(0.5));
    CHECK(script.turn(0.0).creep == 0.0F);
    // Another nut stands elsewhere: that is no turn.
    script.output.joint = 1;
    script.output.nut_angle = 40.0;
    const Heard other = script.tick();
    CHECK(other.run == 0.0F);
    CHECK(other.creep == 0.0F);
    // Nor is a step that is undone.
    script.output.nut_angle = 7.0;
    const Heard undone = script.tick();
    CHECK(undone.run == 0.0F);
    CHECK(undone.creep == 0.0F);
}

TEST_CASE("the published law's load is its torque") {
    Script script;
    script.setup.group = joint::make_published_group({});
    script.output.joint = 0;
    script.tick();
    script.output.wrench_torque = -0.5 * joint::PublishedParameters{}.T_max_Nm;
    CHECK(script.turn(-0.3).load == doctest::Approx(0.5));
}

TEST_CASE("a jaw that slips is heard in its tick, as hard as the joint bore before") {
    Script script;
    script.output.joint = 0;
    script.output.clamp = 0.6 * script.setup.group.joints[0].reference_load;
    CHECK(script.tick().slip == 0.0F);
    script.output.slipped = 0;
    script.output.joint = -1;
    CHECK(script.tick().slip == doctest::Approx(0.6));
    script.output.slipped = -1;
    CHECK(script.tick().slip == 0.0F);
}

TEST_CASE("a torque wrench is heard in the tick in which it clicks, and no torque is") {
    Script script;
    script.output.joint = 0;
    for (int i = 0; i <= 300; ++i) {
        script.output.wrench_torque = i;
        script.output.clicked = i == 200;
        CHECK(script.tick().click == (i == 200));
    }
}

TEST_CASE("what the lesson says of a tick is passed on") {
    const std::vector<lesson::Event> events{{1, "engage", 0, 0.0, {}}, {1, "step_end", 0, 0.0, {}}};
    CHECK(cues_of(events).done);
    CHECK_FALSE(cues_of(events).mistake);
    const std::vector<lesson::Event> wrong{{1, "mistake", 0, 0.0, {}}};
    CHECK(cues_of(wrong).mistake);
    CHECK_FALSE(cues_of(wrong).done);
    Script script;
    script.cues = cues_of(events);
    CHECK(script.tick().done);
    script.cues = cues_of(wrong);
    CHECK(script.tick().mistake);
}

TEST_CASE("numbers of any kind give numbers, and the ear allocates nothing") {
    Script script;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    script.output.touched = ObstacleId::fixed(3);
    script.output.joint = 1;
    for (const double odd : {nan, 1e300, -1e300, 0.0}) {
        script.output.tool.position = Vec3(odd);
        script.output.force = Vec3(odd);
        script.output.nut_angle = odd;
        script.output.clamp = odd;
        const test::Forbidden found = test::forbidden_in([&] { script.tick(); });
        CHECK(found.all() == 0);
    }
    // What comes afterwards is heard as ever.
    script.output.tool = {};
    script.output.touched = {};
    script.move({0, -0.2, 0}, 50);
    script.output.touched = ObstacleId::fixed(3);
    CHECK(script.move({}, 50).size() == 1);
}
