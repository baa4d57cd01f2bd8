// No lesson has a dead end: whatever was done to it, somebody competent can finish it.
//
// BOLT_TRAINEES=2000 lives as many as that, BOLT_FIRST_TRAINEE those from this one on.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "tests/dead_ends/desk.hpp"
#include "tests/dead_ends/life.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/sanitized.hpp"

namespace dead_ends {

Life live(const Person& who, const content::Assembly& assembly, Met& met) {
    const bolt::test::Folder folder;
    const auto file = folder / "life.boltwright";
    Life life;
    {
        auto begun = play::Course::begin(assembly, who.course, file);
        REQUIRE(begun);
        play::Course& course = **begun;
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
    for (std::size_t i = 0; i < hints::situation_count; ++i)
        text += "  " + std::to_string(i) + ": " + std::to_string(met.reached[i]) + ", " +
                std::to_string(met.left[i]) + ", " + std::to_string(met.said[i]) + "\n";
    for (const auto& [event, count] : met.events) text += "  " + event + ": " + std::to_string(count) + "\n";
    for (std::size_t i = 0; i < force::fault_kinds; ++i)
        text += "  fault " + std::to_string(i) + ": " + std::to_string(met.faults[i]) + "\n";
    return text + "  undone " + std::to_string(met.undone) + ", damaged joints " +
           std::to_string(met.damaged) + ", rounded nuts " + std::to_string(met.rounded);
}

// No assembly of ours has nuts that fingers cannot turn or threads that shear before the bolt breaks, and
// nobody says how far fingers can still twist.
constexpr std::array nowhere{hints::Situation::run_down_by_wrench, hints::Situation::twist_back,
                             hints::Situation::leave_stripped};

// That were neither reached nor said, of those that there are.
std::vector<std::size_t> never_met(const Met& met) {
    std::vector<std::size_t> never;
    for (std::size_t i = 0; i < hints::situation_count; ++i) {
        const bool there = std::find(nowhere.begin(), nowhere.end(), hints::Situation(i)) == nowhere.end();
        if (there && met.reached[i] == 0 && met.said[i] == 0) never.push_back(i);
    }
    return never;
}

// A run of an hour says where it is.
void tell(const Person& who, const Life& life, std::uint64_t number) {
    if (number % 50 == 0) (void)std::fprintf(stderr, "%llu lives\n", static_cast<unsigned long long>(number));
    if (life.troubles.empty() && life.restarts == 0) return;
    (void)std::fprintf(stderr, "%s: %d restarts; %s\n", describe(who).c_str(), life.restarts,
                       life.troubles.empty() ? "finished" : life.troubles.front().c_str());
}

}  // namespace

TEST_CASE("whatever somebody has done to a lesson, somebody competent can finish it") {
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
    if (test::sanitized) return;
    const std::vector<std::size_t> never = never_met(met);
    CAPTURE(never.size());
    CHECK((lives < 1000 ? never.size() <= 9 : never.empty()));
}

TEST_CASE("a wrench that is caught on its way to a nut comes off, and gets there from elsewhere") {
    if (test::sanitized) return;
    // On the flange's lowest nut the hand tried the same way over and over.
    const Person who = person(200);
    REQUIRE(who.assembly == "dn200-pn16");
    Met met;
    const Life life = live(who, assembly_of(who), met);
    CHECK(life.troubles.empty());
    CHECK(life.restarts == 0);
}

}  // namespace dead_ends
