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

#include "tests/dead_ends/desk.hpp"
#include "tests/dead_ends/life.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/skip.hpp"

namespace dead_ends {

Life live(const Person& who, const content::Assembly& assembly, Met& met) {
    const bolt::test::Folder folder;
    const auto file = folder / "life.boltwright";
    Life life;
    {
        auto begun = session::Course::begin(assembly, who.course, file);
        REQUIRE(begun);
        session::Course& course = **begun;
        Watch watch(course, met);
        Desk desk(course, watch);
        if (who.overdoes) {
            desk.sets = who.sets;
            (who.at_mouse ? overdo_at_mouse : overdo_at_device)(desk, who.seed, who.span);
            desk.sets = 1.0;
        } else {
            (who.at_mouse ? meddle_at_mouse : meddle_at_device)(desk, who.seed, who.span, who.rough);
        }

        life.random_time = course.time();
        life.done_by_random = desk.over();
        life.restarts = who.at_mouse ? finish_at_mouse(desk) : finish_at_device(desk, who.seed);
        life.rescue_time = course.time() - life.random_time;
        for (const double lost : course.state().rounded) met.rounded += lost > 0.0 ? 1 : 0;
        for (const auto& joint : course.state().joints)
            met.damaged += joint.condition != joint::Condition::sound ? 1 : 0;
        life.troubles = watch.troubles();
    }
    for (const char* end : {"", "-wal", "-shm"}) std::filesystem::remove(file.string() + end);
    return life;
}

namespace {

std::uint64_t asked(const char* variable, std::uint64_t usual) {
    const char* text = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): nothing sets it
    return text != nullptr ? std::strtoull(text, nullptr, 10) : usual;
}

std::string table(const Met& met) {
    std::string text = "situation: reached, left, said\n";
    for (std::size_t i = 0; i < lesson::situation_count; ++i)
        text += "  " + std::to_string(i) + ": " + std::to_string(met.reached[i]) + ", " +
                std::to_string(met.left[i]) + ", " + std::to_string(met.said[i]) + "\n";
    for (const auto& [event, count] : met.events) text += "  " + event + ": " + std::to_string(count) + "\n";
    for (std::size_t i = 0; i < force::fault_kinds; ++i)
        text += "  fault " + std::to_string(i) + ": " + std::to_string(met.faults[i]) + "\n";
    return text + "  undone " + std::to_string(met.undone) + ", damaged joints " +
           std::to_string(met.damaged) + ", rounded nuts " + std::to_string(met.rounded);
}

// Situations that no simulated life meets, each with the reason. A listed situation that is met fails the
// test, too.
struct Exception {
    lesson::Situation situation;
    const char* reason;
};
constexpr Exception exceptions[] = {
    {lesson::Situation::run_down_by_wrench, "no shipped assembly has nuts that fingers cannot turn"},
    {lesson::Situation::twist_back, "the desk does not limit how far fingers twist"},
    {lesson::Situation::leave_stripped, "in every shipped assembly the bolt breaks before the threads shear"},
};

// Lives that meet what the first ones do not: a bolt tightened into yield, a nut turned on while loosening, a
// broken bolt.
constexpr std::array<std::uint64_t, 3> rare_lives{203, 473, 1757};

// Says what is wrong with each situation that was met although listed, or not met although not listed.
std::vector<std::string> coverage_errors(const Met& met, std::span<const Exception> listed) {
    std::vector<std::string> errors;
    for (std::size_t i = 0; i < lesson::situation_count; ++i) {
        const auto exception = std::find_if(listed.begin(), listed.end(), [i](const Exception& e) {
            return static_cast<std::size_t>(e.situation) == i;
        });
        const bool was_met = met.reached[i] > 0 || met.said[i] > 0;
        const std::string place = "situation " + std::to_string(i) + ": ";
        if (was_met && exception != listed.end())
            errors.push_back(place + "is met; expected not, because " + exception->reason);
        if (!was_met && exception == listed.end())
            errors.push_back(place + "is not met; expected a life that meets it, or a reason in the list");
    }
    return errors;
}

// Reports the progress of a run that takes an hour.
void tell(const Person& who, const Life& life, std::uint64_t number) {
    if (number % 50 == 0) (void)std::fprintf(stderr, "%llu lives\n", static_cast<unsigned long long>(number));
    if (life.troubles.empty() && life.restarts == 0) return;
    (void)std::fprintf(stderr, "%s: %d restarts; %s\n", describe(who).c_str(), life.restarts,
                       life.troubles.empty() ? "finished" : life.troubles.front().c_str());
}

}  // namespace

TEST_CASE("Dead ends: a competent trainee can finish a lesson, whatever was done to it") {
    const std::uint64_t first = asked("BOLT_FIRST_TRAINEE", 1);
    const std::uint64_t usual = test::sanitized ? 4 : 60, lives = asked("BOLT_TRAINEES", usual);
    Met met;
    int restarts = 0, by_random = 0, dead = 0;
    double random_time = 0.0, rescue_time = 0.0;
    for (std::uint64_t seed = first; seed < first + lives; ++seed) {
        const Person who = person(seed);
        const Life life = live(who, assembly_of(who), met);
        restarts += life.restarts;
        by_random += life.done_by_random ? 1 : 0;
        random_time += life.random_time;
        rescue_time += life.rescue_time;
        dead += life.troubles.empty() ? 0 : 1;
        for (const std::string& trouble : life.troubles) {
            const std::string of = describe(who) + ": " + trouble;
            FAIL_CHECK(of);
        }
        if (lives > usual) tell(who, life, seed - first + 1);
    }
    MESSAGE(lives << " lives, " << dead << " with trouble, " << random_time << " s of anything, "
                  << rescue_time << " s to finish, " << restarts << " restarts, " << by_random
                  << " finished by chance\n"
                  << table(met));
    if (test::sanitized) return test::skip_rest("too few lives under a sanitizer to meet every situation");
    if (first != 1 || lives < usual)
        return test::skip_rest("other lives than the usual ones meet other situations");
    for (const std::uint64_t seed : rare_lives) {
        const Person who = person(seed);
        const Life life = live(who, assembly_of(who), met);
        CAPTURE(describe(who));
        CHECK(life.troubles.empty());
    }
    CHECK(coverage_errors(met, exceptions) == std::vector<std::string>{});
}

TEST_CASE("Dead ends: an unmet situation without a reason is an error, and so is a stale reason") {
    Met all;
    all.said.fill(1);
    CHECK(coverage_errors(all, {}).empty());
    Met some = all;
    some.said[5] = 0;
    CHECK(coverage_errors(some, {}) ==
          std::vector<std::string>{
              "situation 5: is not met; expected a life that meets it, or a reason in the list"});
    const Exception listed{lesson::Situation(5), "of a test"};
    CHECK(coverage_errors(some, {&listed, 1}).empty());
    CHECK(coverage_errors(all, {&listed, 1}) ==
          std::vector<std::string>{"situation 5: is met; expected not, because of a test"});
}

TEST_CASE("Dead ends: a wrench that is caught on its way to a nut comes off and takes another way") {
    if (test::sanitized) return test::skip_rest("a life at the flange takes minutes under a sanitizer");
    // On the flange's lowest nut the hand tried the same way over and over.
    const Person who = person(200);
    REQUIRE(who.assembly == "dn200-pn16");
    Met met;
    const Life life = live(who, assembly_of(who), met);
    CHECK(life.troubles.empty());
    CHECK(life.restarts == 0);
}

}  // namespace dead_ends
