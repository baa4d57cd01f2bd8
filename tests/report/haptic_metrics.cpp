// Haptic metrics of scripted ticks, their section of the report, and the studies.
#include "game/analysis/haptic_metrics.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "game/analysis/session_data.hpp"
#include "game/plot/html.hpp"
#include "game/report/attempts.hpp"
#include "game/report/report.hpp"
#include "game/session/session_file.hpp"
#include "haptics/servo/tool_contact.hpp"
#include "tests/report/synthetic.hpp"
#include "tests/report/well_formed.hpp"

using namespace bolt;
using namespace bolt::analysis;
using namespace bolt::plot;
using namespace bolt::report;
using collision::ObstacleId;

namespace {

session::Header header_of(bool guide = true) {
    session::Header header;
    header.dt = 0.001;
    header.mode = lesson::Mode::guided;
    header.guiding_force = guide;
    header.contact_models = "casing.glb";
    header.device_limits = force::OutputLimits{};
    header.servo_rate = 0.0;
    header.obstacle_names = {{ObstacleId::fixed(0), "casing"},
                             {ObstacleId::fixed(1), "lid"},
                             {ObstacleId::nut(0), "J01_nut"},
                             {ObstacleId::nut(1), "J02_nut"}};
    return header;
}

// 1.5 s in which a hand moves a wrench towards the nut at the origin, 1 mm per tick.
struct ScriptedSession {
    std::vector<session::TickRecord> ticks = std::vector<session::TickRecord>(1500);
    std::vector<lesson::LessonEvent> events = {{100, lesson::EventKind::step_begin, 0, 0.0, ""}};

    ScriptedSession() {
        for (std::size_t i = 0; i < ticks.size(); ++i) {
            ticks[i].grip = static_cast<std::uint8_t>(servo::Grip::wrench);
            ticks[i].commanded_tool.position[0] = 0.001F * static_cast<float>(ticks.size() - i);
        }
    }
    void touch(std::size_t from, std::size_t to, ObstacleId obstacle) {
        for (std::size_t i = from; i < to; ++i) ticks[i].touched = obstacle;
    }
    void hold(std::size_t from, std::size_t to, std::int16_t joint) {
        for (std::size_t i = from; i < to; ++i) ticks[i].joint = joint;
    }
    void push(std::size_t from, std::size_t to, float force) {
        for (std::size_t i = from; i < to; ++i) ticks[i].force[1] = force;
    }
    [[nodiscard]] HapticMetrics metrics(std::size_t piece = 1500) const {
        HapticMetricsBuilder builder(header_of(), events, {Vec3(0.0), Vec3(0.5, 0.0, 0.0)});
        for (std::size_t i = 0; i < ticks.size(); i += piece)
            builder.add(i, std::span(ticks).subspan(i, std::min(piece, ticks.size() - i)));
        return builder.finish();
    }
};

}  // namespace

TEST_CASE("Haptic metrics: contacts with the due or the held nut are no obstacle_contacts") {
    ScriptedSession script;
    script.touch(200, 230, ObstacleId::fixed(0));
    script.touch(270, 280, ObstacleId::fixed(1));  // 40 ms later: still the same contact
    script.touch(600, 650, ObstacleId::fixed(1));
    script.touch(900, 950, ObstacleId::nut(0));    // the due nut
    script.touch(1000, 1010, ObstacleId::nut(1));  // a nut that is not due
    script.hold(1200, 1300, 0);
    script.touch(1250, 1400, ObstacleId::fixed(0));  // begins while the jaw holds a nut
    script.push(610, 620, 4.0F);
    for (const std::size_t piece : {1500U, 1U, 77U}) {
        const HapticMetrics metrics = script.metrics(piece);
        REQUIRE(metrics.obstacle_contacts.size() == 3);
        CHECK(metrics.obstacle_contacts[0].begin == doctest::Approx(0.2));
        CHECK(metrics.obstacle_contacts[0].length == doctest::Approx(0.08));
        CHECK(metrics.obstacle_contacts[0].obstacle == ObstacleId::fixed(0));
        CHECK(metrics.obstacle_contacts[1].length == doctest::Approx(0.05));
        CHECK(metrics.obstacle_contacts[1].peak_force == doctest::Approx(4.0));
        CHECK(metrics.obstacle_contacts[2].obstacle == ObstacleId::nut(1));
    }
}

TEST_CASE(
    "Haptic metrics: the largest changes of the force, their activity, and those that the output stage "
    "limited") {
    ScriptedSession script;
    script.push(300, 310, 1.5F);
    script.push(500, 900, 2.0F);  // 2 N in a tick is the limit of the output stage
    script.hold(500, 880, 0);
    const HapticMetrics metrics = script.metrics();
    CHECK(metrics.force.greatest == 2.0);
    CHECK(metrics.force.at_limit == 2);
    CHECK(metrics.force.above == 0);
    CHECK(metrics.force.ticks == 412);  // ticks with a force, and those in which it ended
    CHECK(metrics.force.p99 == 0.0);    // four of 412
    CHECK(metrics.at_limit[static_cast<std::size_t>(ToolActivity::engaging)] == 1);
    CHECK(metrics.at_limit[static_cast<std::size_t>(ToolActivity::free)] == 1);
    REQUIRE(metrics.force_jumps.size() >= 3);
    CHECK(metrics.force_jumps[0].change == 2.0);
    CHECK(metrics.force_jumps[2].change == 1.5);
    CHECK(describe(metrics.force_jumps[0], {{"J01"}}, {}) == "wrench engages J01");
    script.push(700, 800, 2.5F);
    script.push(701, 702, 4.8F);  // 2.3 N: no device does this, but the page must report it
    CHECK(script.metrics().force.above == 2);
    CHECK(describe(script.metrics().force_jumps[0], {{"J01"}}, {}) == "wrench on J01, navigation, 0.0 N·m");
}

TEST_CASE(
    "Haptic metrics: the time to a nut lasts from the step's beginning until it is held, with a part near "
    "it") {
    ScriptedSession script;
    script.hold(1490, 1500, 0);
    const HapticMetrics metrics = script.metrics();
    REQUIRE(metrics.arrivals.size() == 1);
    CHECK(metrics.arrivals[0].joint == 0);
    CHECK(metrics.arrivals[0].wrench);
    CHECK(metrics.arrivals[0].duration == doctest::Approx(1.39));
    CHECK(metrics.arrivals[0].near_nut ==
          doctest::Approx(0.030).epsilon(0.05));  // the last 39 ticks without the held ones
}

TEST_CASE("Haptic metrics: time with a visible nut while the wrench is near it") {
    ScriptedSession script;
    script.hold(1490, 1500, 0);  // the nut is due from tick 100 on; the wrench is near it from tick 1460 on
    script.events.push_back({1300, lesson::EventKind::visibility, 0, 0.3, ""});
    script.events.push_back({1470, lesson::EventKind::visibility, 0, 0.6, ""});
    script.events.push_back({1480, lesson::EventKind::visibility, 0, 0.59, ""});
    HapticMetrics metrics = script.metrics();
    REQUIRE(metrics.arrivals.size() == 1);
    CHECK(metrics.arrivals[0].near_nut == doctest::Approx(0.029).epsilon(0.05));
    CHECK(metrics.arrivals[0].nut_visible == doctest::Approx(0.010));
    // The visibility of this nut is unknown then, which differs from "not visible".
    script.events[1].joint = 1;
    CHECK(std::isnan(script.metrics().arrivals[0].nut_visible));
    // A value that comes a tick late, because the step begins beside the nut, is no reason to drop the
    // others.
    script.events[2].tick = 1461;
    CHECK(script.metrics().arrivals[0].nut_visible == doctest::Approx(0.019).epsilon(0.06));
}

TEST_CASE("Haptic metrics: duration of each fault of the output") {
    ScriptedSession script;
    for (std::size_t i = 100; i < 150; ++i)
        script.ticks[i].fault = static_cast<std::uint8_t>(force::Fault::jumped);
    const HapticMetrics metrics = script.metrics();
    CHECK(metrics.faults[static_cast<std::size_t>(force::Fault::jumped)] == doctest::Approx(0.05));
    CHECK(metrics.faults[0] == 0.0);
}

TEST_CASE("Haptics section: shows all metrics, and names those that an old session lacks") {
    ScriptedSession script;
    script.touch(200, 230, ObstacleId::fixed(0));
    script.push(300, 310, 1.5F);
    script.hold(1490, 1500, 0);
    SessionData session = synthetic_session({}).data;
    session.header.obstacle_names = header_of().obstacle_names;
    session.header.obstacle_names[0].name = "casing <upper>";
    session.metrics = script.metrics();
    std::string html = haptics_section(session);
    CHECK(markup_fault(page("t", html)) == "");
    const auto has = [&](const char* part) { return html.find(part) != std::string::npos; };
    CHECK(has("✓ even"));
    CHECK(has("7.5\u00a0%"));
    CHECK(has("casing &lt;upper&gt;"));
    CHECK(has("There are no wake-up, compute and period times. Servo: virtual time."));
    session.metrics.servo_text = session::servo_text(1000.0);
    html = haptics_section(session);
    CHECK(has("There are no wake-up, compute and period times. Servo: 1000 Hz."));
    session.metrics.timing.emplace();
    servo::add(session.metrics.timing->wake_up, 12'000);
    session.metrics.force.at_limit = 2;
    CHECK(haptics_section(session).find("▲ limited 2 times") != std::string::npos);
    session.metrics.force.above = 3;
    html = haptics_section(session);
    CHECK(markup_fault(page("t", html)) == "");
    CHECK(has("▲ jerked 3 times"));
    CHECK(has("12.0"));
    session.metrics.has_contacts_and_faults = false;
    html = haptics_section(session);
    CHECK(has("older format"));
    session.metrics = {};
    CHECK(haptics_section(session).empty());
}

TEST_CASE("Studies: compare only attempts that differ in nothing but the aid and the seed") {
    std::vector<Attempt> attempts;
    for (int i = 0; i < 8; ++i) {
        Attempt a = attempt_of(synthetic_session({}).data);
        a.guided = i % 2 == 0;
        a.seed = static_cast<std::uint64_t>(i / 2);
        a.duration = (a.guided ? 60.0 : 120.0) + 6.0 * i;
        a.obstacle_contacts = i;
        a.finished = i != 7;
        attempts.push_back(a);
    }
    attempts.push_back(attempts.front());
    attempts.back().trainee = "clumsy (simulated)";  // only guided: nothing to compare with
    const std::string html = guiding_study(attempts);
    CHECK(markup_fault(page("t", html)) == "");
    const auto count = [&](std::string_view part) {
        int n = 0;
        for (std::size_t at = html.find(part); at != std::string::npos; at = html.find(part, at + 1)) ++n;
        return n;
    };
    CHECK(count("<h2>") == 1);
    CHECK(count("These trainees are simulated") == 1);
    CHECK(count("n = 4 guided and 4 not guided; finished: 4 and 3.") == 1);
    CHECK(count("1.30 <span class=\"of\">(1.15 to 1.45)</span>") == 1);  // 60, 72, 84, 96 s
    CHECK(count("4.0 <span class=\"of\">(2.5 to 5.5)</span>") == 1);     // 1, 3, 5, 7
    CHECK(count("class=\"mpeak\"") == 4 * count("<svg"));
    const std::string overview = attempts_section(attempts, true);
    CHECK(overview.find("Learning curve") == std::string::npos);
    CHECK(overview.find("#session-") == std::string::npos);
    CHECK(attempts_section(attempts).find("Learning curve") != std::string::npos);
    for (Attempt& a : attempts) a.guided = true;
    CHECK(guiding_study(attempts).empty());
    CHECK(view_study(attempts).empty());
    for (std::size_t i = 0; i < 8; ++i) attempts[i].view_help = i % 2 == 0;
    const std::string views = view_study(attempts);
    CHECK(markup_fault(page("t", views)) == "");
    CHECK(views.find("n = 4 view help and 4 by hand; finished: 4 and 3.") != std::string::npos);
    CHECK(views.find("These trainees are simulated") != std::string::npos);
    CHECK(views.find("presses V") != std::string::npos);  // the description of the model
    CHECK(guiding_study(attempts).empty());
    // Attempts that differ in both aids are not compared.
    for (Attempt& a : attempts) a.guided = a.view_help;
    CHECK(view_study(attempts).empty());
    for (Attempt& a : attempts) {
        a.view_help = false;
        a.guided = true;
    }
    attempts.front().guided = false;
    for (Attempt& a : attempts) a.trainee_kind = session::TraineeKind::person;
    CHECK(guiding_study(attempts).find("These trainees are simulated") == std::string::npos);
    for (Attempt& a : attempts) a.trainee_kind = session::TraineeKind::unrecorded;
    CHECK(guiding_study(attempts).find("do not record whether a person") != std::string::npos);
}
