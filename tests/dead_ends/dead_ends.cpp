// No lesson has a dead end: a competent trainee can finish it, whatever was done to it before.
//
// BOLT_TRAINEES=2000 simulates that many lives, BOLT_FIRST_TRAINEE=N starts with life N.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <span>

#include "tests/dead_ends/lesson_run.hpp"
#include "tests/dead_ends/life.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/skip.hpp"

namespace dead_ends {

Life run_life(const LifePlan& plan, const content::Assembly& assembly, Coverage& coverage) {
    const bolt::test::Folder folder;
    const auto file = folder / "life.boltwright";
    Life life;
    {
        auto begun = session::LessonSession::begin(assembly, plan.options, file);
        REQUIRE(begun);
        session::LessonSession& session = **begun;
        InvariantChecker checker(session, coverage);
        LessonRun run(session, checker);
        if (plan.overtightens) {
            run.set_torque_scale = plan.set_torque_scale;
            (plan.at_mouse ? overtighten_at_mouse : overtighten_at_device)(run, plan.seed, plan.span);
            run.set_torque_scale = 1.0;
        } else {
            (plan.at_mouse ? act_randomly_at_mouse : act_randomly_at_device)(run, plan.seed, plan.span,
                                                                             plan.rough);
        }

        life.random_time = session.time();
        life.done_by_random = run.over();
        life.restarts = plan.at_mouse ? finish_at_mouse(run) : finish_at_device(run, plan.seed);
        life.rescue_time = session.time() - life.random_time;
        for (const double lost : session.state().rounded) coverage.rounded += lost > 0.0 ? 1 : 0;
        for (const auto& joint : session.state().joints)
            coverage.damaged += joint.condition != joint::JointCondition::intact ? 1 : 0;
        life.problems = checker.problems();
    }
    for (const char* end : {"", "-wal", "-shm"}) std::filesystem::remove(file.string() + end);
    return life;
}

namespace {

std::uint64_t environment(const char* variable, std::uint64_t otherwise) {
    const char* text = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): nothing sets it
    return text != nullptr ? std::strtoull(text, nullptr, 10) : otherwise;
}

std::string table(const Coverage& coverage) {
    std::string text = "situation: reached, left, hinted\n";
    for (std::size_t i = 0; i < lesson::situation_count; ++i)
        text += "  " + std::to_string(i) + ": " + std::to_string(coverage.reached[i]) + ", " +
                std::to_string(coverage.left[i]) + ", " + std::to_string(coverage.hinted[i]) + "\n";
    for (const auto& [event, count] : coverage.events)
        text += "  " + event + ": " + std::to_string(count) + "\n";
    for (std::size_t i = 0; i < force::fault_kinds; ++i)
        text += "  fault " + std::to_string(i) + ": " + std::to_string(coverage.faults[i]) + "\n";
    return text + "  undone " + std::to_string(coverage.undone) + ", damaged joints " +
           std::to_string(coverage.damaged) + ", rounded nuts " + std::to_string(coverage.rounded);
}

// Situations that no simulated life meets, each with its reason. The test also fails if a listed situation is
// met.
struct Exception {
    lesson::Situation situation;
    const char* reason;
};
constexpr const char* by_torque = "the lives tighten by torque; tests/lesson/angle.cpp tightens by angle";
constexpr Exception exceptions[] = {
    {lesson::Situation::run_down_by_wrench, "no shipped assembly has nuts that fingers cannot turn"},
    {lesson::Situation::twist_back, "the lesson run does not limit how far fingers twist"},
    {lesson::Situation::counter_hold, "tests/lesson/counter_hold.cpp plays such a lesson"},
    {lesson::Situation::pull_to_click_by_adaptor, "no shipped assembly has a wrench with an adaptor"},
    {lesson::Situation::turn_on, by_torque},
    {lesson::Situation::ease_to_angle, by_torque},
    {lesson::Situation::stop_at_angle, by_torque},
    {lesson::Situation::stop_too_far, by_torque},
    {lesson::Situation::pass_turn, by_torque},
    {lesson::Situation::pass_turn_back, "no life that loosens the flange shows a hint at its first pass"},
    {lesson::Situation::leave_stripped, "in every shipped assembly the bolt breaks before the threads shear"},
};

// Lives with situations that the first ones do not meet: a bolt tightened into yield, a nut tightened while
// loosening, a broken bolt.
constexpr std::array<std::uint64_t, 3> rare_lives{203, 473, 1757};

// Returns an error for each situation that is met and listed, or neither.
std::vector<std::string> coverage_errors(const Coverage& coverage, std::span<const Exception> listed) {
    std::vector<std::string> errors;
    for (std::size_t i = 0; i < lesson::situation_count; ++i) {
        const auto exception = std::find_if(listed.begin(), listed.end(), [i](const Exception& e) {
            return static_cast<std::size_t>(e.situation) == i;
        });
        const bool was_met = coverage.reached[i] > 0 || coverage.hinted[i] > 0;
        const std::string place = "situation " + std::to_string(i) + ": ";
        if (was_met && exception != listed.end())
            errors.push_back(place + "is met; expected not, because " + exception->reason);
        if (!was_met && exception == listed.end())
            errors.push_back(place + "is not met; expected a life that meets it, or a reason in the list");
    }
    return errors;
}

// Logs the progress of a run that takes an hour.
void log_progress(const LifePlan& plan, const Life& life, std::uint64_t number) {
    if (number % 50 == 0) (void)std::fprintf(stderr, "%llu lives\n", static_cast<unsigned long long>(number));
    if (life.problems.empty() && life.restarts == 0) return;
    (void)std::fprintf(stderr, "%s: %d restarts; %s\n", describe(plan).c_str(), life.restarts,
                       life.problems.empty() ? "finished" : life.problems.front().c_str());
}

}  // namespace

TEST_CASE("Dead ends: a competent trainee can finish a lesson, whatever was done to it") {
    const std::uint64_t first = environment("BOLT_FIRST_TRAINEE", 1);
    const std::uint64_t default_lives = test::sanitized ? 4 : 60,
                        lives = environment("BOLT_TRAINEES", default_lives);
    Coverage coverage;
    int restarts = 0, by_random = 0, dead = 0;
    double random_time = 0.0, rescue_time = 0.0;
    for (std::uint64_t seed = first; seed < first + lives; ++seed) {
        const LifePlan plan = make_life_plan(seed);
        const Life life = run_life(plan, assembly_of(plan), coverage);
        restarts += life.restarts;
        by_random += life.done_by_random ? 1 : 0;
        random_time += life.random_time;
        rescue_time += life.rescue_time;
        dead += life.problems.empty() ? 0 : 1;
        for (const std::string& problem : life.problems) {
            const std::string message = describe(plan) + ": " + problem;
            FAIL_CHECK(message);
        }
        if (lives > default_lives) log_progress(plan, life, seed - first + 1);
    }
    MESSAGE(lives << " lives, " << dead << " with problems, " << random_time << " s of random actions, "
                  << rescue_time << " s to finish, " << restarts << " restarts, " << by_random
                  << " finished by chance\n"
                  << table(coverage));
    if (test::sanitized) return test::skip_rest("too few lives under a sanitizer to meet every situation");
    if (first != 1 || lives < default_lives)
        return test::skip_rest("lives other than the default ones meet other situations");
    for (const std::uint64_t seed : rare_lives) {
        const LifePlan plan = make_life_plan(seed);
        const Life life = run_life(plan, assembly_of(plan), coverage);
        CAPTURE(describe(plan));
        CHECK(life.problems.empty());
    }
    for (const std::string& error : coverage_errors(coverage, exceptions)) FAIL_CHECK(error);
}

TEST_CASE("Dead ends: an unmet situation without a reason is an error, and so is a stale reason") {
    Coverage all;
    all.hinted.fill(1);
    CHECK(coverage_errors(all, {}).empty());
    Coverage some = all;
    some.hinted[5] = 0;
    CHECK(coverage_errors(some, {}) ==
          std::vector<std::string>{
              "situation 5: is not met; expected a life that meets it, or a reason in the list"});
    const Exception listed{lesson::Situation(5), "of a test"};
    CHECK(coverage_errors(some, {&listed, 1}).empty());
    CHECK(coverage_errors(all, {&listed, 1}) ==
          std::vector<std::string>{"situation 5: is met; expected not, because of a test"});
}

TEST_CASE("Dead ends: a wrench stopped by an obstacle on its way to a nut takes another path") {
    if (test::sanitized) return test::skip_rest("a life at the flange takes minutes under a sanitizer");
    // A hand once repeated the same approach to the flange's lowest nut without end.
    const LifePlan plan = make_life_plan(200);
    REQUIRE(plan.assembly == "dn200-pn16");
    Coverage coverage;
    const Life life = run_life(plan, assembly_of(plan), coverage);
    CHECK(life.problems.empty());
    CHECK(life.restarts == 0);
}

}  // namespace dead_ends
