// Cues that event detection derives from scripted ticks.
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
    EventDetector detector;
    servo::Output output;
    LessonCues lesson;
    test::HapticWorld world{2};

    explicit Script(const force::OutputLimits& limits = {}) : setup(test::two_joints(limits)) {}
    SoundCues tick() { return detect_events(detector, setup, world.write(output), lesson); }
    // Moves the tool for some ticks. Returns the speeds of the strikes.
    std::vector<float> move(const Vec3& velocity, int ticks) {
        std::vector<float> strikes;
        for (int i = 0; i < ticks; ++i) {
            output.constrained_tool.position += dt * velocity;
            if (const SoundCues cues = tick(); cues.strike_speed > 0.0F) strikes.push_back(cues.strike_speed);
        }
        return strikes;
    }
    SoundCues turn(double speed) {
        output.nut_angle += dt * speed;
        return tick();
    }
};

// The strikes of a wrench that moves against a wall and stays there.
std::vector<float> against_wall(double speed) {
    Script script;
    std::vector<float> strikes = script.move({0, -speed, 0}, 50);
    script.output.touched = ObstacleId::fixed(3);
    for (const float more : script.move({}, 50)) strikes.push_back(more);
    return strikes;
}

}  // namespace

TEST_CASE("Event detection: an impact gives one strike with the speed of the wrench") {
    for (const double speed : {0.05, 0.1, 0.3, 1.0}) {
        CAPTURE(speed);
        const std::vector<float> strikes = against_wall(speed);
        REQUIRE(strikes.size() == 1);
        CHECK(strikes[0] == doctest::Approx(speed).epsilon(1e-3));
    }
    CHECK(against_wall(0.01).empty());
}

TEST_CASE(
    "Event detection: the end of the handle strikes as well, but not when the wrench only turns a nut") {
    for (const bool turns : {false, true}) {
        Script script;
        if (turns) script.output.joint = 1;
        const double handle = script.setup.wrench.handle_length, turn = 0.2 / handle;  // rad/s
        std::vector<float> strikes;
        for (int i = 0; i < 100; ++i) {
            if (i == 50) script.output.touched = turns ? ObstacleId::nut(1) : ObstacleId::fixed(3);
            const double angle = turn * dt * std::min(i, 50);
            script.output.constrained_tool.orientation = glm::angleAxis(angle, Vec3(0, 1, 0));
            if (const SoundCues cues = script.tick(); cues.strike_speed > 0.0F)
                strikes.push_back(cues.strike_speed);
        }
        if (turns) {
            CHECK(strikes.empty());
            continue;
        }
        REQUIRE(strikes.size() == 1);
        CHECK(strikes[0] == doctest::Approx(0.2).epsilon(1e-2));
    }
}

TEST_CASE("Event detection: the struck surface follows from the obstacle and its name") {
    const content::LoadedAssembly loaded = content::load_assembly("cover-m8");
    REQUIRE(loaded.ok());
    const std::vector<session::ObstacleName> names{{ObstacleId::fixed(0), "housing"},
                                                   {ObstacleId::fixed(1), "B1_bolt"},
                                                   {ObstacleId::fixed(2), "B10_bolt"},
                                                   {ObstacleId::fixed(4), "B4_washer_nut"},
                                                   {ObstacleId::nut(0), "B1_nut"}};
    const std::vector<StruckSurface> still = struck_surfaces(loaded.assembly, names);
    CHECK(still == std::vector<StruckSurface>{StruckSurface::casing, StruckSurface::nut,
                                              StruckSurface::casing, StruckSurface::casing,
                                              StruckSurface::nut});
    const ObstacleId nut = ObstacleId::nut(1);
    for (const ObstacleId id :
         {ObstacleId::fixed(0), ObstacleId::fixed(1), ObstacleId::fixed(2), ObstacleId::fixed(3),
          ObstacleId::fixed(4), ObstacleId::fixed(5), ObstacleId::fixed(1001), nut}) {
        CAPTURE(id.index());
        Script script;
        script.detector.surfaces = still;
        script.move({0, -0.2, 0}, 50);
        script.output.touched = id;
        SoundCues struck;
        for (int i = 0; i < 20; ++i)
            if (const SoundCues cues = script.tick(); cues.strike_speed > 0.0F) struck = cues;
        CHECK(struck.strike_speed > 0.1F);
        CHECK((struck.surface == StruckSurface::nut) ==
              (id == ObstacleId::fixed(1) || id == ObstacleId::fixed(4) || id == nut));
    }
}

TEST_CASE(
    "Event detection: no strike in the air, when accelerating, after one delayed tick, on picking up, or "
    "when the hand stops") {
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

TEST_CASE("Event detection: a wrench that trembles against a wall does not strike in each contact") {
    Script script;
    script.output.touched = ObstacleId::fixed(3);
    std::size_t strikes = 0;
    for (int i = 0; i < 100; ++i) strikes += script.move({0, i % 2 == 0 ? -0.1 : 0.1, 0}, 5).size();
    CHECK(strikes >= 1);
    CHECK(strikes <= 30);  // of a hundred reversals within half a second
}

TEST_CASE(
    "Event detection: sliding has the speed and the force across it; none in the air or on the turned nut") {
    Script script;
    script.output.force = Vec3(3.0, 4.0, 0.0);
    script.move({0.2, 0, 0}, 10);
    CHECK(script.tick().slide_speed == 0.0F);
    script.output.touched = ObstacleId::fixed(3);
    script.output.constrained_tool.position += Vec3(0.2 * dt, 0, 0);
    const SoundCues cues = script.tick();
    CHECK(cues.slide_speed == doctest::Approx(0.2));
    CHECK(cues.contact_force == doctest::Approx(4.0));
    script.output.joint = 1;
    script.output.touched = ObstacleId::nut(1);
    script.output.constrained_tool.position += Vec3(0.2 * dt, 0, 0);
    CHECK(script.tick().slide_speed == 0.0F);
    script.output.touched = ObstacleId::nut(0);  // the neighbour
    script.output.constrained_tool.position += Vec3(0.2 * dt, 0, 0);
    CHECK(script.tick().slide_speed == doctest::Approx(0.2));
}

TEST_CASE("Event detection: without a force device sliding has a default contact force") {
    force::OutputLimits none;
    none.force = none.torque = 0.0;
    Script script(none);
    script.output.touched = ObstacleId::fixed(3);
    script.move({0.2, 0, 0}, 10);
    script.output.constrained_tool.position += Vec3(0.2 * dt, 0, 0);
    CHECK(script.tick().contact_force > 1.0F);
}

TEST_CASE("Event detection: an unloaded nut runs and a loaded one creeps, in both directions") {
    Script script;
    script.output.joint = 0;
    script.tick();
    for (const double speed : {9.0, -9.0}) {
        const SoundCues cues = script.turn(speed);
        CHECK(cues.run_speed == doctest::Approx(9.0));
        CHECK(cues.creep_speed == 0.0F);
        CHECK(cues.load == 0.0F);
    }
    const double full = script.setup.group.joints[0].reference_load;
    REQUIRE(full > 0.0);
    script.output.clamp = 0.5 * full;
    const SoundCues cues = script.turn(0.4);
    CHECK(cues.run_speed == 0.0F);
    CHECK(cues.creep_speed == doctest::Approx(0.4));
    CHECK(cues.load == doctest::Approx(0.5));
    CHECK(script.turn(0.0).creep_speed == 0.0F);
    // The angle of another nut is not a rotation.
    script.output.joint = 1;
    script.output.nut_angle = 40.0;
    const SoundCues other = script.tick();
    CHECK(other.run_speed == 0.0F);
    CHECK(other.creep_speed == 0.0F);
    // An undone step is not a rotation either.
    script.output.nut_angle = 7.0;
    const SoundCues undone = script.tick();
    CHECK(undone.run_speed == 0.0F);
    CHECK(undone.creep_speed == 0.0F);
}

TEST_CASE("Event detection: the published law's load is derived from its torque") {
    Script script;
    script.setup.group = joint::make_published_group({{}, {}});
    script.output.joint = 0;
    script.tick();
    script.output.wrench_torque = -0.5 * joint::PublishedParameters{}.T_max_Nm;
    CHECK(script.turn(-0.3).load == doctest::Approx(0.5));
}

TEST_CASE("Event detection: a slip occurs in its tick with the load of the joint before") {
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

TEST_CASE("Event detection: a torque wrench clicks in its tick and at no other torque") {
    Script script;
    script.output.joint = 0;
    for (int i = 0; i <= 300; ++i) {
        script.output.wrench_torque = i;
        script.output.clicked = i == 200;
        CHECK(script.tick().click == (i == 200));
    }
}

TEST_CASE("Event detection: a swing back gives one cue for each tooth of a ratchet and none without teeth") {
    for (const int teeth : {0, 72, 36})
        for (const double half_teeth : {1.0, 9.0, 25.0}) {
            CAPTURE(teeth);
            CAPTURE(half_teeth);
            servo::Setup setup = test::two_joints();
            const double tooth = to_radians(teeth > 0 ? 360.0 / teeth : 5.0);
            setup.wrench.ratchet.tooth_angle = teeth > 0 ? tooth : 0.0;
            setup.wrench.ratchet.drag = 0.25;
            setup.wrench.head_angle = 0.0;
            servo::State state = servo::initial_state(setup);
            const servo::NutGeometry& nut = setup.nuts[0];
            joint::turn_nut(setup.group, state.joints, 0, nut.start_gap / nut.lead + 0.3, 1.0, 0.001);
            double handle = state.joints[0].nut.angle;
            const Vec3 centre = servo::nut_centre(nut, handle);
            EventDetector detector;
            world::World world;
            world::add_haptics(world, state);
            const auto heard = [&](double by, int ticks) {
                int cues = 0;
                for (int i = 0; i < ticks; ++i) {
                    handle += by / ticks;
                    const servo::TickInput input =
                        test::holding(servo::Grip::wrench, test::tool_at(nut, centre, handle));
                    const servo::Output output = servo::tick(setup, state, input);
                    world::write_haptics(world, {state, input, output});
                    cues += detect_events(detector, setup, world).tooth ? 1 : 0;
                }
                return cues;
            };
            CHECK(heard(0.0, 100) == 0);
            REQUIRE(state.engagement.joint == 0);
            CHECK(heard(setup.wrench.half_play + 0.005, 200) == 0);  // pulls
            heard(-2.0 * setup.wrench.half_play - 0.005, 200);       // takes up the play
            const double begun = state.engagement.ratchet_slack;
            const int whole = static_cast<int>((begun + 0.5 * half_teeth * tooth) / tooth);
            const int ticks = static_cast<int>(400.0 * half_teeth);
            CHECK(heard(-0.5 * half_teeth * tooth, ticks) == (teeth > 0 ? whole : 0));
            CHECK(heard(0.4 * tooth, 100) == 0);  // forward again
        }
}

TEST_CASE("Event detection: the cues of the lesson are passed on") {
    const std::vector<lesson::LessonEvent> events{{1, lesson::EventKind::engage, 0, 0.0, {}},
                                                  {1, lesson::EventKind::step_end, 0, 0.0, {}}};
    CHECK(lesson_cues(events).done);
    CHECK_FALSE(lesson_cues(events).mistake);
    const std::vector<lesson::LessonEvent> wrong{{1, lesson::EventKind::mistake, 0, 0.0, {}}};
    CHECK(lesson_cues(wrong).mistake);
    CHECK_FALSE(lesson_cues(wrong).done);
    Script script;
    script.lesson = lesson_cues(events);
    CHECK(script.tick().done);
    script.lesson = lesson_cues(wrong);
    CHECK(script.tick().mistake);
}

TEST_CASE("Event detection: accepts any numbers and does not allocate") {
    Script script;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    script.output.touched = ObstacleId::fixed(3);
    script.output.joint = 1;
    for (const double odd : {nan, 1e300, -1e300, 0.0}) {
        script.output.constrained_tool.position = Vec3(odd);
        script.output.force = Vec3(odd);
        script.output.nut_angle = odd;
        script.output.clamp = odd;
        const test::Forbidden found = test::forbidden_in([&] { script.tick(); });
        CHECK(found.all() == 0);
    }
    // The detection recovers afterwards.
    script.output.constrained_tool = {};
    script.output.touched = {};
    script.move({0, -0.2, 0}, 50);
    script.output.touched = ObstacleId::fixed(3);
    CHECK(script.move({}, 50).size() == 1);
}
