// The filter of the head: dropouts are held and faded, jumps are refused at first.
#include "engine/tracking/head_filter.hpp"

#include <doctest/doctest.h>

#include <vector>

#include "engine/base/random.hpp"
#include "engine/tracking/head_pose.hpp"

namespace head_filter_test {

using namespace bolt;
using namespace bolt::tracking;

namespace {

constexpr double period = 1.0 / 60.0;  // s, of the tracker and of the frames

HeadFilterSettings settings() {
    HeadFilterSettings s;
    s.fixed_head.position = {0.0, 1.6, 0.0};
    return s;
}

// A person who sways: 0.2 m at 0.5 Hz, 0.63 m/s.
Pose swaying(double time) {
    return {{0.2 * std::sin(pi * time), 1.7, 0.5}, rotation(Vec3(0.0, 0.3 * std::sin(2.0 * time), 0.0))};
}

// Runs frames and remembers the results.
struct Run {
    HeadFilterSettings with = settings();
    HeadFilterState state;
    double now = 0.0;
    FilteredHead head;
    double largest_step = 0.0;  // m, from frame to frame, after the first one
    double largest_turn = 0.0;  // rad, likewise
    bool first = true;

    void frame(const std::vector<HeadSample>& samples) {
        const FilteredHead before = head;
        head = filter_head(state, with, samples, now);
        CHECK(finite(head.pose.position));
        CHECK(std::abs(glm::length(head.pose.orientation) - 1.0) < 1e-9);
        if (!first) {
            largest_step = std::max(largest_step, glm::length(head.pose.position - before.pose.position));
            largest_turn = std::max(
                largest_turn, glm::length(turn_between(before.pose.orientation, head.pose.orientation)));
        }
        first = false;
        now += period;
    }
    // `pose_at`: of the tracker.
    template <class PoseAt>
    void track(double seconds, const PoseAt& pose_at) {
        for (const double end = now + seconds - 0.5 * period; now < end;) frame({{now, pose_at(now)}});
    }
    void lose(double seconds) {
        for (const double end = now + seconds - 0.5 * period; now < end;) frame({});
    }
};

double distance(const Pose& a, const Pose& b) { return glm::length(a.position - b.position); }

}  // namespace

TEST_CASE("Head filter: without samples the head is the fixed one") {
    Run run;
    run.lose(1.0);
    CHECK(run.head.status == HeadStatus::faded);
    CHECK(run.head.pose.position == run.with.fixed_head.position);
    CHECK(run.largest_step == 0.0);
}

TEST_CASE("Head filter: a tracked head is shown as it is, without delay") {
    Run run;
    run.track(3.0, swaying);
    CHECK(run.head.status == HeadStatus::tracked);
    CHECK(distance(run.head.pose, swaying(run.now - period)) < 1e-12);
    CHECK(run.largest_step < 0.65 * period);
}

TEST_CASE("Head filter: of several samples in a frame the newest counts") {
    Run run;
    run.frame({{-0.02, swaying(-0.02)}, {-0.01, swaying(-0.01)}, {0.0, swaying(0.0)}});
    CHECK(distance(run.head.pose, swaying(0.0)) < 1e-12);
}

TEST_CASE("Head filter: the first sample after a start without one is approached") {
    Run run;
    run.lose(0.5);
    run.track(run.with.return_time + 0.1, swaying);
    CHECK(distance(run.head.pose, swaying(run.now - period)) < 1e-12);
    CHECK(run.largest_step < 0.08);  // 0.51 m in 0.3 s, minimum jerk: 3.2 m/s at most
}

TEST_CASE("Head filter: a dropout is held, then faded to the fixed head without a step") {
    Run run;
    const auto still = [](double) { return Pose{{0.4, 1.8, 0.3}, rotation(Vec3(0.0, 0.5, 0.0))}; };
    run.track(1.0, still);
    const double last = run.now - period;
    run.lose(0.05);
    CHECK(run.head.status == HeadStatus::tracked);  // a few lost frames are nothing
    run.lose(0.4);
    CHECK(run.head.status == HeadStatus::held);
    CHECK(distance(run.head.pose, still(0.0)) < 1e-12);
    while (run.now < last + run.with.dropout_time + 0.5 * run.with.fade_time) run.frame({});
    CHECK(run.head.status == HeadStatus::faded);
    const double way = distance(still(0.0), run.with.fixed_head);
    CHECK(distance(run.head.pose, still(0.0)) == doctest::Approx(0.5 * way).epsilon(0.05));
    run.lose(0.5 * run.with.fade_time + 0.1);
    CHECK(distance(run.head.pose, run.with.fixed_head) < 1e-12);
    CHECK(run.head.status == HeadStatus::faded);
    CHECK(run.largest_step < 1.875 * way / run.with.fade_time * period * 1.01);  // the peak of a minimum jerk
    CHECK(run.largest_turn < 1.875 * 0.5 / run.with.fade_time * period * 1.01);
}

TEST_CASE("Head filter: a head that returns is approached without a step, at any moment of the dropout") {
    for (const double lost : {0.12, 0.3, 0.6, 1.5, 4.0}) {
        Run run;
        run.track(1.0, swaying);
        run.lose(lost);
        const auto moved = [](double time) {
            Pose pose = swaying(time);
            pose.position.x += 0.3;
            return pose;
        };
        const Pose before = run.head.pose;
        run.largest_step = 0.0;
        run.track(run.with.return_time + 0.05, moved);
        CHECK(run.head.status == HeadStatus::tracked);
        CHECK(distance(run.head.pose, moved(run.now - period)) < 1e-12);
        // The head moves meanwhile, by at most 0.63 m/s.
        const double way = distance(before, moved(run.now)) + 0.63 * run.with.return_time;
        CHECK(run.largest_step < (1.875 * way / run.with.return_time + 0.63) * period);
    }
}

TEST_CASE("Head filter: single jumps are refused") {
    Run run;
    int frame = 0;
    const auto with_jumps = [&](double time) {
        Pose pose = swaying(time);
        if (++frame % 7 == 0) pose.position += Vec3(1.0, -0.5, 2.0);
        if (frame % 11 == 0) pose.orientation = pose.orientation * rotation(Vec3(0.0, 2.0, 0.0));
        return pose;
    };
    run.track(3.0, with_jumps);
    CHECK(run.largest_step < 3.0 * 0.65 * period);  // at most two samples in a row are missing
    CHECK(run.largest_turn < 3.0 * 0.6 * period);
    CHECK(run.head.status == HeadStatus::tracked);
}

TEST_CASE("Head filter: a jump that lasts is accepted after its time and approached without a step") {
    Run run;
    run.track(1.0, swaying);
    const auto there = [](double time) {
        Pose pose = swaying(time);
        pose.position.z += 3.0;
        return pose;
    };
    run.track(run.with.jump_time - 2.0 * period, there);
    CHECK(run.head.pose.position.z == doctest::Approx(0.5));  // refused so far
    CHECK(run.head.status == HeadStatus::held);
    run.track(run.with.return_time + 4.0 * period, there);
    CHECK(run.head.status == HeadStatus::tracked);
    CHECK(distance(run.head.pose, there(run.now - period)) < 1e-12);
    CHECK(run.largest_step < (1.875 * 3.2 / run.with.return_time + 0.63) * period);
}

TEST_CASE("Head filter: a jump that a head could soon cover is accepted sooner, and also without a step") {
    Run run;
    run.track(1.0, swaying);
    const auto there = [](double time) {
        Pose pose = swaying(time);
        pose.position.z += 0.3;
        return pose;
    };
    run.track(0.02, there);
    CHECK(run.head.pose.position.z == doctest::Approx(0.5));  // 0.3 m in a frame is refused
    run.track(0.3 / run.with.max_speed + run.with.return_time, there);
    CHECK(distance(run.head.pose, there(run.now - period)) < 1e-12);
    CHECK(run.largest_step < (1.875 * 0.4 / run.with.return_time + 0.63) * period);
}

TEST_CASE("Head filter: noise at two places is never accepted as a jump") {
    Run run;
    run.track(1.0, swaying);
    Random random(9);
    // Far from the head, and far from one another.
    const auto noise = [&](double) {
        return Pose{{random.uniform(3.0, 90.0), random.uniform(-50.0, 50.0), random.uniform(-50.0, 50.0)},
                    {1, 0, 0, 0}};
    };
    const Pose last = run.head.pose;
    run.track(run.with.dropout_time - 2.0 * period, noise);
    CHECK(run.head.status == HeadStatus::held);
    CHECK(distance(run.head.pose, last) < 1e-12);
    run.track(run.with.fade_time + 0.1, noise);
    CHECK(run.head.status == HeadStatus::faded);
    CHECK(distance(run.head.pose, run.with.fixed_head) < 1e-12);
}

TEST_CASE("Head filter: a fast head is followed, also between two samples of a slow tracker") {
    Run run;
    const auto running = [](double time) { return Pose{{3.5 * time, 1.6, 0.0}, {1, 0, 0, 0}}; };
    run.track(1.0, running);
    CHECK(run.head.status == HeadStatus::tracked);
    CHECK(distance(run.head.pose, running(run.now - period)) < 1e-12);
    const double from = run.now;
    for (int i = 0; i < 60; ++i) {  // 20 Hz
        run.now = from + i * 0.05;
        run.frame({{from + i * 0.05, running(from + i * 0.05)}});
        CHECK(run.head.status == HeadStatus::tracked);
    }
}

TEST_CASE("Head filter: samples that are not finite, or not newer, are ignored") {
    Run run;
    run.track(1.0, swaying);
    const Pose last = run.head.pose;
    const double now = run.now;
    const Pose other{{0.0, 1.6, 0.4}, {1, 0, 0, 0}};
    run.frame({{now, {{bolt::nan, 0.0, 0.0}, {1, 0, 0, 0}}},
               {bolt::nan, other},
               {std::numeric_limits<double>::infinity(), other},
               {now, {{0.0, 1.6, 0.5}, {0.0, 0.0, 0.0, 0.0}}},
               {now, {{0.0, 1.6, 0.5}, {bolt::nan, 0.0, 0.0, 0.0}}},
               {now - 0.5, other}});
    CHECK(distance(run.head.pose, last) < 1e-12);
    run.track(0.5, swaying);
    CHECK(run.head.status == HeadStatus::tracked);
}

TEST_CASE("Head filter: random trackers never make a step larger than a head's") {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        Random random(seed);
        Run run;
        run.track(0.5, swaying);
        Vec3 offset(0.0);
        double until = 0.0;
        bool lost = false;
        for (int i = 0; i < 1200; ++i) {
            if (run.now >= until) {
                until = run.now + random.uniform(0.02, 1.2);
                lost = random.chance(0.3);
                if (random.chance(0.5)) offset = random_direction(random) * random.uniform(0.0, 2.0);
            }
            Pose pose = swaying(run.now);
            pose.position += offset;
            if (lost)
                run.frame({});
            else
                run.frame({{run.now, pose}});
        }
        // A return covers at most 4 m and a little in 0.3 s; without the filter steps are up to 4 m. A change
        // that a head could make in the time of the refused samples, 0.1 s, is followed at once.
        CHECK_MESSAGE(run.largest_step < 0.5, seed);
    }
}

TEST_CASE("Head pose: axes, scale, mounting and the offset to the eyes are applied in this order") {
    // A tracker whose z is up, 1 m above the floor at z = -2 m; it measures in units of 0.5 m.
    TrackerRegistration registration;
    registration.axes_rotation = glm::normalize(Quat(glm::dmat3(1, 0, 0, 0, 0, -1, 0, 1, 0)));
    REQUIRE(glm::length(registration.axes_rotation * Vec3(0, 0, 1) - Vec3(0, 1, 0)) < 1e-12);
    registration.scale = 0.5;
    registration.tracker_in_room = {{0.0, 1.0, -2.0}, rotation(Vec3(0.0, pi / 2, 0.0))};
    registration.head_in_body = {{0.0, -0.06, 0.02}, {1, 0, 0, 0}};
    const Pose head = head_in_room(registration, {{2.0, 4.0, 1.0}, {1, 0, 0, 0}});
    // Tracker (2, 4, 1): renamed and scaled (1, 0.5, -2); turned by 90 degrees about y (-2, 0.5, -1).
    const Vec3 body = Vec3(-2.0, 0.5, -1.0) + Vec3(0.0, 1.0, -2.0);
    CHECK(glm::length(head.position - (body + Vec3(0.02, -0.06, 0.0))) < 1e-12);
    // A body that is turned about the tracker's up is turned about the room's up.
    const Pose turned = head_in_room(registration, {{0, 0, 0}, rotation(Vec3(0.0, 0.0, 0.4))});
    CHECK(glm::length(turn_between(head.orientation, turned.orientation) - Vec3(0.0, 0.4, 0.0)) < 1e-12);
}

}  // namespace head_filter_test
