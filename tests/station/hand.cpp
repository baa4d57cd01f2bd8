// What a gloved hand does at a station, without its thread.
#include "haptics/station/hand.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>

#include "tests/station/gloved.hpp"
#include "tests/support/forbidden.hpp"

using namespace bolt;
using namespace bolt::station;

namespace {

constexpr double dt = 1.0 / 80.0;

// A hand in a glove that gives 80 samples a second, or none.
struct Worn {
    HandPlan plan = test::hand_at_bar();
    HandState state;
    glove::Sample sample;
    ToolPlace place;
    std::vector<grip::Told> told;

    void shows(const glove::BySensor<std::uint8_t>& raw, double seconds) {
        for (double t = 0.0; t < seconds; t += dt) {
            sample.frame.raw = raw;
            ++sample.number;
            sample.time += dt;
            step();
        }
    }
    void is_mute(double seconds) {
        for (double t = 0.0; t < seconds; t += dt) {
            sample.time += dt;
            step();
        }
    }
    void step() {
        const grip::Told now = hand_step(plan, state, sample, place, dt);
        if (now != grip::Told::nothing) told.push_back(now);
    }
};

double apart(const hand::Skeleton& a, const hand::Skeleton& b) {
    double most = 0.0;
    for (std::size_t i = 0; i < hand::joint_count; ++i)
        most = std::max(most, glm::length(a.position[i] - b.position[i]));
    return most;
}

}  // namespace

TEST_CASE("a gloved hand takes the wrench by closing on it, and lets it go by opening, trembling or not") {
    Worn worn;
    CHECK(!shown(worn.plan, worn.state).any);
    worn.shows(test::raw_open(), 0.5);
    CHECK(grip_of(worn.state) == servo::Grip::none);
    worn.shows(test::raw_closed(), 0.5);
    CHECK(grip_of(worn.state) == servo::Grip::wrench);
    worn.shows(test::raw_open(), 0.1);  // for a moment
    worn.shows(test::raw_closed(), 0.5);
    CHECK(worn.told == std::vector<grip::Told>{grip::Told::taken});
    worn.shows(test::raw_open(), 0.5);
    CHECK(grip_of(worn.state) == servo::Grip::none);
    CHECK(worn.told == std::vector<grip::Told>{grip::Told::taken, grip::Told::let_go});
}

TEST_CASE(
    "a glove that is lost in mid-grasp: the wrench stays, that is said, and when it is back nothing falls") {
    Worn worn;
    worn.shows(test::raw_open(), 0.5);
    worn.shows(test::raw_closed(), 0.5);
    worn.told.clear();
    worn.is_mute(30.0);
    CHECK(grip_of(worn.state) == servo::Grip::wrench);
    CHECK(worn.told == std::vector<grip::Told>{grip::Told::glove_lost});
    // Sensors are quicker back than the hand in them thinks.
    worn.shows(test::raw_open(), 0.3);
    worn.shows(test::raw_closed(), 5.0);
    CHECK(grip_of(worn.state) == servo::Grip::wrench);
    CHECK(worn.told == std::vector<grip::Told>{grip::Told::glove_lost, grip::Told::glove_back});
}

TEST_CASE("the shown hand goes with the tool, and is where the mover has it as long as it holds nothing") {
    Worn worn;
    const Pose somewhere{Vec3(0.4, 1.0, -0.3), rotation({0.3, -1.1, 0.4})};
    worn.place = {somewhere, somewhere};
    worn.shows(test::raw_open(), 0.5);
    const hand::Skeleton open =
        hand::joints(worn.plan.wearer.hand, worn.state.grip.closing.shown, worn.plan.wrist);
    CHECK(apart(shown(worn.plan, worn.state).joints, open) < 1e-12);
    // The tool is held back 0.1 m below the hand.
    worn.place.now.position -= Vec3(0.0, 0.1, 0.0);
    worn.shows(test::raw_open(), 0.1);
    const Vec3 palm = worn.place.now * shown(worn.plan, worn.state).joints.position[hand::palm];
    CHECK(glm::length(palm - somewhere * open.position[hand::palm]) < 1e-12);
    // It cannot be taken from there, but where it is at hand; from then on the hand goes where the tool can.
    worn.shows(test::raw_closed(), 0.5);
    CHECK(!shown(worn.plan, worn.state).held);
    worn.place.now = somewhere;
    worn.shows(test::raw_closed(), 0.5);
    const ShownHand closed = shown(worn.plan, worn.state);
    CHECK(closed.held);
    CHECK(apart(closed.joints, open) > 0.03);
    worn.place.now.position -= Vec3(0.0, 0.1, 0.0);
    worn.shows(test::raw_closed(), 0.5);
    CHECK(apart(shown(worn.plan, worn.state).joints, closed.joints) < 1e-4);
}

TEST_CASE("what is wrong with a gloved hand is said in words, worst first") {
    glove::Report report;
    CHECK(words({}, hand::Side::right, report).empty());
    report.greetings = 1;
    CHECK(words({}, hand::Side::right, report).empty());
    std::strcpy(report.trouble.data(), "the port is gone");
    const std::vector<std::string> lost = words({true, true}, hand::Side::right, report);
    REQUIRE(lost.size() == 2);
    CHECK(lost[0].find("stays in your hand") != std::string::npos);
    CHECK(lost[1] == "the port is gone");
    CHECK(words({false, true}, hand::Side::right, report)[0].find("stays") == std::string::npos);
    report.trouble[0] = '\0';
    report.identity.hand = glove::Hand::left;
    REQUIRE(words({}, hand::Side::right, report).size() == 1);
    CHECK(words({}, hand::Side::right, report)[0].find("is a left one") != std::string::npos);
    CHECK(words({}, hand::Side::left, report).empty());
}

TEST_CASE("a step of a gloved hand allocates nothing, waits for nothing") {
    Worn worn;
    worn.told.reserve(8);
    for (const auto& raw : {test::raw_open(), test::raw_closed(), test::raw_open()})
        CHECK(test::forbidden_in([&] { worn.shows(raw, 0.5); }).all() == 0);
    CHECK(worn.told.size() == 2);
}
