// A trainee who goes to another joint leaves the present nut along that nut's axis.
#include <doctest/doctest.h>

#include "game/trainees/behaviour.hpp"

namespace bolt::lesson::leaving_nut {

namespace {

// A nut on top and the next one, which points down. The wrench is on the first one.
struct Bench {
    servo::Setup setup;
    servo::State state;
    trainees::TraineeState trainee;
    Pose wrench{Vec3(0.0, 0.005, 0.0)};

    Bench() : setup(two_nuts()), trainee(trainees::find_profile("expert").value(), 1, setup) {
        state.joints.resize(2);
        trainee.setup = &setup;
        trainee.servo_state = &state;
        trainee.rest = {Vec3(0.0, 0.4, 0.3)};
        trainee.plan.joint = 1;
    }

    static servo::Setup two_nuts() {
        servo::Setup setup;
        for (const double up : {1.0, -1.0}) {
            servo::NutGeometry nut;
            nut.seat = up > 0.0 ? Vec3(0.0) : Vec3(0.07, -0.06, -0.08);
            nut.axis = Vec3(0.0, up, 0.0);
            setup.nuts.push_back(nut);
        }
        return setup;
    }

    // An obstacle holds the wrench back, on the way to the rest pose, until the trainee retreats.
    Vec3 retreat() {
        trainee.enter(trainees::Phase::change_tool, 1.0);
        for (int i = 0; i < 2000 && trainee.phase == trainees::Phase::change_tool; ++i)
            trainees::retreat_if_caught(trainee, {wrench.position + Vec3(0.0, -0.05, 0.0)}, wrench);
        REQUIRE(trainee.phase == trainees::Phase::lift);
        return trainee.to.position - wrench.position;
    }
};

}  // namespace

TEST_CASE(
    "Leaving a nut: a caught wrench retreats off the nut that it is on, not along the axis of the next one") {
    Bench bench;
    CHECK(bench.retreat().y > 0.05);  // up and back
    CHECK(bench.retreat().y > 0.0);   // to the side
    CHECK(bench.retreat().y > 0.05);
    bench.wrench.position = bench.setup.nuts[1].seat;
    bench.trainee.consecutive_catches = 0;
    CHECK(bench.retreat().y < -0.03);
}

TEST_CASE("Leaving a nut: each retreat of a caught tool has a part off the nut, wherever the rest pose is") {
    Random random(11, 1);
    const auto some = [&] {
        return Vec3(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
    };
    for (int i = 0; i < 200; ++i) {
        const Vec3 up = glm::normalize(some()), back = some(), aside = 0.1 * some();
        for (int catches = 1; catches < 10; ++catches) {
            CAPTURE(catches);
            const double off = glm::dot(trainees::retreat_direction(catches, up, back, aside), up);
            CHECK(off > (catches % 2 == 1 ? 1.0 - 1e-9 : 0.3 - 1e-9));
        }
    }
}

}  // namespace bolt::lesson::leaving_nut
