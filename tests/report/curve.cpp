#include "game/analysis/joint_curve.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "engine/base/math.hpp"
#include "tests/report/synthetic.hpp"

using namespace bolt;
using namespace bolt::analysis;
using namespace bolt::report;

namespace {

session::TickRecord tick(int joint, double degrees, double torque,
                         joint::Stage stage = joint::Stage::linearity) {
    session::TickRecord t;
    t.joint = static_cast<std::int16_t>(joint);
    t.nut_angle = static_cast<float>(to_radians(degrees));
    t.wrench_torque = static_cast<float>(torque);
    t.stage = static_cast<std::uint8_t>(stage);
    t.grip = static_cast<std::uint8_t>(servo::Grip::wrench);
    return t;
}

CurveBuilder builder_for(std::size_t joints, double snug = 10.0) {
    CurveRequest request;
    request.snug_torque.assign(joints, snug);
    return CurveBuilder(request);
}

}  // namespace

TEST_CASE("Joint curves: consecutive holds of one nut are one visit, which ends at another nut") {
    CurveBuilder builder = builder_for(2);
    std::vector<session::TickRecord> ticks;
    for (int hold = 0; hold < 3; ++hold) {
        for (int i = 0; i < 50; ++i) ticks.push_back(tick(0, 30.0 * hold + 0.6 * i, 20.0 + hold));
        for (int i = 0; i < 10; ++i) ticks.push_back(tick(-1, 0.0, 0.0));
    }
    for (int i = 0; i < 50; ++i) ticks.push_back(tick(1, 0.6 * i, 5.0));
    for (int i = 0; i < 50; ++i) ticks.push_back(tick(0, 90.0 + 0.6 * i, 40.0));
    builder.add(1000, ticks);
    const std::vector<JointCurve> curves = builder.finish();
    REQUIRE(curves.size() == 2);
    REQUIRE(curves[0].visits.size() == 2);
    CHECK(curves[0].visits[0].holds == 3);
    CHECK(curves[0].visits[1].holds == 1);
    CHECK(curves[0].visits[0].begin == doctest::Approx(1.0));
    CHECK(curves[0].visits[0].peak.torque == doctest::Approx(22.0));
    CHECK(curves[0].visits[1].peak.torque == doctest::Approx(40.0));
    CHECK(to_degrees(curves[0].end_angle) == doctest::Approx(90.0 + 0.6 * 49));
    CHECK(curves[1].visits.size() == 1);
    CHECK(curves[1].visits[0].worked);
}

TEST_CASE("Joint curves: pieces of any size give the same curves") {
    const SyntheticSession session = synthetic_session({});
    CurveRequest request;
    request.snug_torque.assign(12, 20.0);
    request.dt = 0.01;
    for (const lesson::LessonEvent& event : session.events) request.pass_begins.push_back(event.tick);
    CurveBuilder builder(request);
    const std::span<const session::TickRecord> ticks = session.ticks;
    for (std::size_t at = 0, size = 1; at < ticks.size(); at += size, size = size % 977 + 13)
        builder.add(at, ticks.subspan(at, std::min(size, ticks.size() - at)));
    const std::vector<JointCurve> pieces = builder.finish();
    for (std::size_t j = 0; j < pieces.size(); ++j) {
        const JointCurve& whole = session.data.curves[j];
        REQUIRE(pieces[j].visits.size() == whole.visits.size());
        CHECK(pieces[j].mark == whole.mark);
        CHECK(pieces[j].stages.size() == whole.stages.size());
        for (std::size_t v = 0; v < whole.visits.size(); ++v) {
            CHECK(pieces[j].visits[v].points.size() == whole.visits[v].points.size());
            CHECK(pieces[j].visits[v].peak.torque == whole.visits[v].peak.torque);
        }
    }
}

TEST_CASE("Joint curves: snug angle, run-down and stages of a known joint") {
    const SyntheticSession session = synthetic_session({});
    for (const JointCurve& curve : session.data.curves) {
        const double seat = 18.0 * 360.0;
        REQUIRE(std::isfinite(curve.mark));
        // One tick turns the wrench by 0.25°.
        const double snug = to_degrees(curve.mark) - seat;
        CHECK(synthetic_torque(snug) >= 20.0 - 0.01);
        CHECK(synthetic_torque(snug - 0.26) < 20.0);
        REQUIRE(curve.stages.size() >= 3);
        CHECK(curve.stages[0].stage == joint::Stage::navigation);
        CHECK(curve.stages[1].stage == joint::Stage::transition);
        CHECK(curve.stages[2].stage == joint::Stage::linearity);
        for (std::size_t i = 1; i < curve.stages.size(); ++i)
            CHECK(curve.stages[i].from == curve.stages[i - 1].to);
        CHECK(curve.run_down.angle / (2.0 * pi) == doctest::Approx(18.0).epsilon(0.01));
        CHECK(curve.run_down.torque_high < 0.2);
        CHECK(curve.run_down.time == doctest::Approx(curve.run_down.angle / to_radians(540.0)).epsilon(0.05));
    }
}

TEST_CASE("Joint curves: the mark of a nut that left its seat is where a pass by angle met the snug torque") {
    using joint::Stage;
    const auto at = [](double degrees, double torque, Stage stage) {
        return tick(0, degrees, torque, stage);
    };
    const auto mark_of = [](std::vector<session::TickRecord> first_pass,
                            std::vector<session::TickRecord> second_pass) {
        CurveRequest request{{10.0}, 0.001, joint::Direction::tighten, {0, first_pass.size()}};
        request.turns_by_angle = {false, true};
        CurveBuilder builder(request);
        builder.add(0, first_pass);
        builder.add(first_pass.size(), second_pass);
        return to_degrees(builder.finish()[0].mark);
    };
    const std::vector<session::TickRecord> seated = {at(90, 2, Stage::navigation),
                                                     at(100, 12, Stage::linearity)};
    // Seated at the beginning of the second pass: its first angle.
    CHECK(mark_of(seated, {at(101, 11, Stage::linearity), at(130, 40, Stage::linearity)}) ==
          doctest::Approx(101.0));
    // Off its seat at the beginning, and unseated during the pass: where the snug torque was met afterwards.
    std::vector<session::TickRecord> unseated = seated;
    unseated.push_back(at(80, -1, Stage::navigation));
    CHECK(mark_of(unseated, {at(80, 1, Stage::navigation), at(104, 12, Stage::linearity),
                             at(130, 40, Stage::linearity)}) == doctest::Approx(104.0));
    CHECK(mark_of(seated, {at(101, 11, Stage::linearity), at(85, -1, Stage::navigation),
                           at(99, 9, Stage::linearity), at(103, 12, Stage::linearity)}) ==
          doctest::Approx(103.0));
    CHECK(std::isnan(mark_of(seated, {})));
    CHECK(std::isnan(mark_of(seated, {at(101, 11, Stage::linearity), at(85, -1, Stage::navigation)})));
}

TEST_CASE("Joint curves: loosening reverses the direction") {
    CurveRequest request;
    request.snug_torque.assign(1, 10.0);
    request.direction = joint::Direction::loosen;
    CurveBuilder builder(request);
    std::vector<session::TickRecord> ticks;
    for (int i = 0; i < 100; ++i)
        ticks.push_back(tick(0, 100.0 - i, -50.0 * std::exp(-0.1 * i),
                             i < 40 ? joint::Stage::linearity : joint::Stage::navigation));
    builder.add(0, ticks);
    const JointCurve curve = builder.finish()[0];
    CHECK(curve.visits[0].peak.torque == doctest::Approx(-50.0));
    CHECK(to_degrees(curve.start_angle) == doctest::Approx(100.0));
    CHECK(to_degrees(curve.end_angle) == doctest::Approx(1.0));
    REQUIRE(curve.stages.size() == 2);
    CHECK(curve.stages[1].stage == joint::Stage::navigation);
}

TEST_CASE("Joint curves: invalid samples are ignored, and the number of visits is bounded") {
    CurveBuilder builder = builder_for(2);
    std::vector<session::TickRecord> ticks = {tick(7, 1.0, 1.0), tick(-5, 1.0, 1.0),
                                              tick(0, std::nan(""), 1.0), tick(0, 1.0, HUGE_VAL)};
    ticks.push_back(tick(0, 1.0, 1.0));
    ticks.back().stage = 200;
    builder.add(0, ticks);
    for (int i = 0; i < 500; ++i) {
        const std::vector<session::TickRecord> touch(5, tick(i % 2, i, 30.0));
        builder.add(static_cast<std::uint64_t>(10 + 5 * i), touch);
    }
    const std::vector<JointCurve> curves = builder.finish();
    CHECK(curves[0].visits.size() == 64);
    CHECK(curves[1].visits.size() == 64);
    CHECK(to_degrees(curves[0].end_angle) == doctest::Approx(498.0));
}
