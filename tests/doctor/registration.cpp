// Touching points with an arm, in virtual time, and the assessment of a registration.
#include <doctest/doctest.h>

#include "engine/base/random.hpp"
#include "game/station/frame_registration.hpp"
#include "game/station/point_source.hpp"

namespace registration_test {

using namespace bolt;
using namespace bolt::station_setup;

namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// An arm that sends a sample a millisecond, whose hand a script moves.
struct ScriptedArm {
    struct Moment {
        double until = 0.0;  // s
        Pose pose;
        std::uint32_t buttons = 0;
    };
    device::VirtualTime time;
    std::vector<Moment> script;
    double unusable_from = 1e9;
    std::vector<double> enter;  // s, times at which Enter is pressed
    double stop_at = 1e9;
    std::string shown;

    TouchIo io() {
        return {[this] { return snapshot(); }, [this] { return confirmed(); },
                [this] { return time.now >= stop_at; },
                [this](std::string_view line) { (shown += line) += '\n'; }, device::virtual_timer(time)};
    }

  private:
    device::DeviceSnapshot snapshot() const {
        device::DeviceSnapshot snapshot;
        snapshot.usable = time.now < unusable_from;
        snapshot.number = static_cast<std::uint64_t>(std::min(time.now, unusable_from) * 1000.0) + 1;
        for (const Moment& moment : script) {
            snapshot.sample.pose = moment.pose;
            snapshot.sample.buttons = moment.buttons;
            if (time.now < moment.until) break;
        }
        return snapshot;
    }
    bool confirmed() {
        if (enter.empty() || time.now < enter.front()) return false;
        enter.erase(enter.begin());
        return true;
    }
};

const Pose first{{0.01, 0.02, 0.03}, {1.0, 0.0, 0.0, 0.0}};
const Pose second{{-0.05, 0.0, 0.01}, rotation({0.0, 0.0, pi / 2})};

// Corners of a box of 0.25 × 0.2 × 0.25 m and its centre, which is the check point.
std::vector<PointPair> box(const Pose& pose) {
    std::vector<PointPair> pairs;
    for (unsigned i = 0; i < 8; ++i) {
        const Vec3 from((i & 4U) != 0 ? 0.25 : 0.0, (i & 2U) != 0 ? 0.2 : 0.0, (i & 1U) != 0 ? 0.25 : 0.0);
        pairs.push_back({from, pose * from});
    }
    pairs.push_back({{0.125, 0.1, 0.125}, pose * Vec3(0.125, 0.1, 0.125)});
    return pairs;
}

constexpr const char* date = "2026-03-02T09:15:00Z";

Result<MeasuredRegistration> registered(std::span<const PointPair> pairs) {
    return register_frames(content::CoordinateFrame::arm, content::CoordinateFrame::room, pairs, date);
}

}  // namespace

TEST_CASE("Arm tip: a press of a button measures the tip, and a button that is still held does not") {
    ScriptedArm arm;
    arm.script = {{0.5, first, 0}, {1.5, first, 1}, {2.0, second, 1}, {2.5, second, 0}, {9.0, second, 4}};
    ArmTip tip(arm.io(), {0.1, 0.0, 0.0});
    const std::vector<Vec3> targets{{1, 2, 3}, {4, 5, 6}};
    const auto pairs = measure_points(tip, targets);
    REQUIRE_MESSAGE(pairs, pairs.error().message());
    REQUIRE(pairs->size() == 2);
    CHECK(glm::length((*pairs)[0].from - Vec3(0.11, 0.02, 0.03)) < 1e-12);
    CHECK((*pairs)[0].to == targets[0]);
    CHECK(glm::length((*pairs)[1].from - Vec3(-0.05, 0.1, 0.01)) < 1e-12);
    CHECK(arm.time.now == doctest::Approx(2.5 + TouchOptions{}.duration).epsilon(0.01));
    CHECK(has(arm.shown, "Point 1 of 2: touch (1.000, 2.000, 3.000) m"));
    CHECK(!has(arm.shown, "Once more"));
}

TEST_CASE("Arm tip: Enter measures as well, and an Enter from before the question does not") {
    ScriptedArm arm;
    arm.script = {{9.0, first, 0}};
    arm.enter = {0.0, 1.0};
    ArmTip tip(arm.io(), {});
    const auto measured = tip.measure(0, 1, {});
    REQUIRE(measured);
    CHECK(glm::length(*measured - first.position) < 1e-15);
    CHECK(arm.time.now > 1.0);
}

TEST_CASE("Arm tip: if the hand moves, the point is requested again") {
    ScriptedArm arm;
    arm.script = {{0.5, first, 0}, {0.6, first, 1}, {1.0, second, 1}, {1.5, second, 0}, {9.0, second, 1}};
    ArmTip tip(arm.io(), {});
    const auto measured = tip.measure(4, 8, {});
    REQUIRE(measured);
    CHECK(glm::length(*measured - second.position) < 1e-12);
    CHECK(has(arm.shown, "Point 5: the hand moved by "));
    CHECK(has(arm.shown, "expected at most 1.0 mm. Once more."));
}

TEST_CASE("Arm tip: an arm that is lost, and a user who ends it, end the wait") {
    ScriptedArm lost;
    lost.script = {{9.0, first, 0}};
    lost.unusable_from = 0.4;
    const auto none = ArmTip(lost.io(), {}).measure(0, 1, {});
    REQUIRE(!none);
    CHECK(none.error().code == ErrorCode::no_device);
    CHECK(lost.time.now == doctest::Approx(1.4).epsilon(0.01));
    ScriptedArm ended;
    ended.script = {{9.0, first, 0}};
    ended.stop_at = 0.3;
    CHECK(ArmTip(ended.io(), {}).measure(0, 1, {}).error().message() == "the registration was interrupted");
}

TEST_CASE("Arm tip: after a pause, a button that was pressed in it is no press, and the arm is not lost") {
    ScriptedArm arm;
    arm.script = {{0.5, first, 0},  {0.6, first, 1},  {4.0, first, 0},
                  {6.0, second, 1}, {6.5, second, 0}, {9.0, second, 1}};
    ArmTip tip(arm.io(), {});
    REQUIRE(tip.touch(0, "Touch."));
    arm.time.now = 5.0;
    const auto measured = tip.touch(1, "Touch.");
    REQUIRE_MESSAGE(measured, (measured ? "" : measured.error().message()));
    CHECK(arm.time.now == doctest::Approx(6.5 + TouchOptions{}.duration).epsilon(0.01));
    CHECK(glm::length(*measured - second.position) < 1e-12);
}

TEST_CASE("Arm tip: a touch is the mean of positions that stay together") {
    Random random(3);
    std::vector<Vec3> positions;
    for (int i = 0; i < 300; ++i) positions.push_back(Vec3(1, 2, 3) + 0.1e-3 * random_direction(random));
    const auto mean = average_touch(positions);
    REQUIRE(mean);
    CHECK(glm::length(*mean - Vec3(1, 2, 3)) < 0.02e-3);
    positions.back().x += 2e-3;
    CHECK(has(average_touch(positions).error().message(), "the hand moved by 2."));
    positions.back().x = bolt::nan;
    CHECK(has(average_touch(positions).error().message(), "an invalid position"));
    CHECK(average_touch({}).error().message() == "the device sent 0 positions; expected at least 5");
}

TEST_CASE("Frame registration: the last point is kept out of the pose and checks it") {
    const Pose pose{{1.0, 2.0, 3.0}, rotation({0.3, -0.2, 1.0})};
    std::vector<PointPair> pairs = box(pose);
    pairs.back().to.x += 2e-3;
    const auto measured = registered(pairs);
    REQUIRE(measured);
    const content::Registration& one = measured->registration;
    CHECK(glm::length(one.pose.position - pose.position) < 1e-12);
    CHECK(one.points == 8);
    CHECK(one.rms < 1e-12);
    CHECK(one.date == date);
    CHECK(measured->check_error == doctest::Approx(2e-3));
    CHECK(check_quality(*measured));
    CHECK(warnings_of(*measured).empty());
    CHECK(registered(std::span(pairs).first(3)).error().message() ==
          "3 points are too few; expected at least 4, of which the last is the check point");
}

TEST_CASE("Frame registration: a large rms and a check point that is off are refused") {
    std::vector<PointPair> pairs = box({});
    pairs[5].to += Vec3(0.0, 0.018, 0.0);
    auto measured = registered(pairs);
    REQUIRE_MESSAGE(measured, measured.error().message());
    CHECK(measured->registration.rms > max_rms);
    const Status rms = check_quality(*measured);
    REQUIRE(!rms);
    CHECK(has(rms.error().message(), "arm -> room: the rms is "));
    CHECK(has(rms.error().message(), "measure point 6 again"));
    CHECK(has(describe(*measured), "arm -> room, 8 points"));

    pairs = box({});
    pairs.back().to.y += 5.1e-3;
    measured = registered(pairs);
    REQUIRE(measured);
    CHECK(check_quality(*measured).error().message() ==
          "arm -> room: the check point is off by 5.1 mm; expected at most 5 mm; measure again");
    pairs.back().to.y -= 0.2e-3;
    CHECK(check_quality(*registered(pairs)));
}

TEST_CASE("Frame registration: few points and points in a plane give warnings") {
    const std::vector<PointPair> pairs = box({});
    const std::vector<PointPair> flat{pairs[0], pairs[1], pairs[4], pairs[5]};
    const auto measured = registered(flat);
    REQUIRE(measured);
    const std::vector<std::string> warnings = warnings_of(*measured);
    REQUIRE(warnings.size() == 2);
    CHECK(has(warnings[0], "3 points and a check point are few"));
    CHECK(has(warnings[1], "near a plane"));
    CHECK(has(describe(*measured), "  -\n"));  // with three points none can be left out
    CHECK(!measured->registration.largest_left_out);
}

TEST_CASE("Frame registration: a stored one is found in both directions") {
    const Pose pose{{1.0, 2.0, 3.0}, rotation({0.3, -0.2, 1.0})};
    const std::vector<content::Registration> all{registered(box(pose))->registration};
    const auto forth = registration_from(all, content::CoordinateFrame::arm, content::CoordinateFrame::room);
    const auto back = registration_from(all, content::CoordinateFrame::room, content::CoordinateFrame::arm);
    REQUIRE((forth && back));
    CHECK(*forth == all[0]);
    CHECK(back->from == content::CoordinateFrame::room);
    CHECK(glm::length(back->pose * (forth->pose * Vec3(1, 2, 3)) - Vec3(1, 2, 3)) < 1e-12);
    CHECK(content::check_error(*back).value() < 1e-12);
    CHECK(!registration_from(all, content::CoordinateFrame::tracker, content::CoordinateFrame::room));
}

}  // namespace registration_test
