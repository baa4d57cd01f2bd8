// The gloved hand at a station, without its thread.
#include "haptics/station/gloved_hand.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>

#include "tests/station/gloved.hpp"
#include "tests/support/forbidden.hpp"

using namespace bolt;
using namespace bolt::station;

namespace {

constexpr double dt = 1.0 / 80.0;

// A hand in a glove that sends 80 samples per second, or none.
struct Worn {
    HandSetup plan = test::hand_at_bar();
    HandState state;
    hand::GloveSample sample;
    ToolPoses place;
    std::vector<hand::GraspEvent> events;

    void send(const hand::PerSensor<std::uint8_t>& raw, double seconds) {
        for (double t = 0.0; t < seconds; t += dt) {
            sample.frame.raw = raw;
            ++sample.number;
            sample.time += dt;
            step();
        }
    }
    void stay_silent(double seconds) {
        for (double t = 0.0; t < seconds; t += dt) {
            sample.time += dt;
            step();
        }
    }
    void step() {
        const hand::GraspEvent now = update_hand(plan, state, sample, place, dt);
        if (now != hand::GraspEvent::none) events.push_back(now);
    }
};

double apart(const hand::Skeleton& a, const hand::Skeleton& b) {
    double most = 0.0;
    for (std::size_t i = 0; i < hand::joint_count; ++i)
        most = std::max(most, glm::length(a.position[i] - b.position[i]));
    return most;
}

}  // namespace

TEST_CASE("Gloved hand: closing grasps the wrench and opening releases it, with and without tremor") {
    Worn worn;
    CHECK(!displayed_hand(worn.plan, worn.state).has_angles);
    worn.send(test::raw_open(), 0.5);
    CHECK(grip_of(worn.state) == servo::Grip::none);
    worn.send(test::raw_closed(), 0.5);
    CHECK(grip_of(worn.state) == servo::Grip::wrench);
    worn.send(test::raw_open(), 0.1);  // too briefly to release
    worn.send(test::raw_closed(), 0.5);
    CHECK(worn.events == std::vector<hand::GraspEvent>{hand::GraspEvent::grasped});
    worn.send(test::raw_open(), 0.5);
    CHECK(grip_of(worn.state) == servo::Grip::none);
    CHECK(worn.events ==
          std::vector<hand::GraspEvent>{hand::GraspEvent::grasped, hand::GraspEvent::released});
}

TEST_CASE(
    "Gloved hand: a glove lost during a grasp keeps the wrench, is reported, and drops nothing on its "
    "return") {
    Worn worn;
    worn.send(test::raw_open(), 0.5);
    worn.send(test::raw_closed(), 0.5);
    worn.events.clear();
    worn.stay_silent(30.0);
    CHECK(grip_of(worn.state) == servo::Grip::wrench);
    CHECK(worn.events == std::vector<hand::GraspEvent>{hand::GraspEvent::glove_lost});
    // The glove returns open for less than the time in which nothing is released.
    worn.send(test::raw_open(), 0.3);
    worn.send(test::raw_closed(), 5.0);
    CHECK(grip_of(worn.state) == servo::Grip::wrench);
    CHECK(worn.events ==
          std::vector<hand::GraspEvent>{hand::GraspEvent::glove_lost, hand::GraspEvent::glove_back});
}

TEST_CASE(
    "Gloved hand: the displayed hand follows the tool, and the mover's commanded pose while it holds "
    "nothing") {
    Worn worn;
    const Pose somewhere{Vec3(0.4, 1.0, -0.3), rotation({0.3, -1.1, 0.4})};
    worn.place = {somewhere, somewhere};
    worn.send(test::raw_open(), 0.5);
    const hand::Skeleton open =
        hand::joints(worn.plan.wearer.hand, worn.state.grasp.closure.angles, worn.plan.wrist);
    CHECK(apart(displayed_hand(worn.plan, worn.state).finger_joints, open) < 1e-12);
    // An obstacle holds the tool 0.1 m below the hand.
    worn.place.constrained_tool.position -= Vec3(0.0, 0.1, 0.0);
    worn.send(test::raw_open(), 0.1);
    const Vec3 palm = worn.place.constrained_tool *
                      displayed_hand(worn.plan, worn.state).finger_joints.position[hand::palm];
    CHECK(glm::length(palm - somewhere * open.position[hand::palm]) < 1e-12);
    // The hand cannot grasp the tool from a distance. Once it holds it, the displayed hand follows the tool.
    worn.send(test::raw_closed(), 0.5);
    CHECK(!displayed_hand(worn.plan, worn.state).held);
    worn.place.constrained_tool = somewhere;
    worn.send(test::raw_closed(), 0.5);
    const DisplayedHand closed = displayed_hand(worn.plan, worn.state);
    CHECK(closed.held);
    CHECK(apart(closed.finger_joints, open) > 0.03);
    worn.place.constrained_tool.position -= Vec3(0.0, 0.1, 0.0);
    worn.send(test::raw_closed(), 0.5);
    CHECK(apart(displayed_hand(worn.plan, worn.state).finger_joints, closed.finger_joints) < 1e-4);
}

TEST_CASE("Gloved hand: messages name its problems, worst first") {
    hand::GloveReport report;
    CHECK(messages({}, hand::Side::right, report).empty());
    report.handshakes = 1;
    CHECK(messages({}, hand::Side::right, report).empty());
    std::strcpy(report.fault_message.data(), "the port is gone");
    const std::vector<std::string> lost = messages({true, true}, hand::Side::right, report);
    REQUIRE(lost.size() == 2);
    CHECK(lost[0].find("stays in your hand") != std::string::npos);
    CHECK(lost[1] == "the port is gone");
    CHECK(messages({false, true}, hand::Side::right, report)[0].find("stays") == std::string::npos);
    report.fault_message[0] = '\0';
    report.identity.side = hand::Side::left;
    REQUIRE(messages({}, hand::Side::right, report).size() == 1);
    CHECK(messages({}, hand::Side::right, report)[0].find("it is a left glove") != std::string::npos);
    CHECK(messages({}, hand::Side::left, report).empty());
}

TEST_CASE("Gloved hand: a step neither allocates nor waits") {
    Worn worn;
    worn.events.reserve(8);
    for (const auto& raw : {test::raw_open(), test::raw_closed(), test::raw_open()})
        CHECK(test::forbidden_in([&] { worn.send(raw, 0.5); }).all() == 0);
    CHECK(worn.events.size() == 2);
}
