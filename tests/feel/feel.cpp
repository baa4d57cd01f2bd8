// The feel of the arms that Boltwright drives, emulated: the part of bolt-arm-validation that takes seconds.
#include <doctest/doctest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>

#include "engine/base/file.hpp"
#include "tools/verify/arms/tables.hpp"

using namespace bolt;
using namespace bolt::arm_validation;

namespace {

TightenedAssembly& zq350() {
    static TightenedAssembly tightened = [] {
        Result<TightenedAssembly> loaded = load_tightened_assembly("zq350");
        REQUIRE_MESSAGE(loaded, (loaded ? "" : loaded.error().message()));
        return std::move(*loaded);
    }();
    return tightened;
}

RigOptions with(const ArmFacts& arm) {
    RigOptions options;
    options.arm = &arm;
    return options;
}

const ArmFacts& arm(const char* key) {
    const ArmFacts* found = find_arm(key);
    REQUIRE(found != nullptr);
    return *found;
}

constexpr double largest_step = 10.0 + 1e-6;  // % of the greatest force, in a millisecond

// Compares two rows of a table: the texts are equal, and figures differ by a fifth or by half a unit at most,
// because other libraries round differently.
bool same_row(const std::string& a, const std::string& b) {
    const char *p = a.c_str(), *q = b.c_str();
    const auto digit = [](const char* s) { return std::isdigit(static_cast<unsigned char>(*s)) != 0; };
    while (*p != '\0' && *q != '\0') {
        if (digit(p) && digit(q)) {
            char *p_end = nullptr, *q_end = nullptr;
            const double x = std::strtod(p, &p_end), y = std::strtod(q, &q_end);
            if (std::abs(x - y) > std::max(0.2 * std::max(std::abs(x), std::abs(y)), 0.5)) return false;
            p = p_end;
            q = q_end;
        } else if (*p++ != *q++) {
            return false;
        }
    }
    return *p == *q;
}

bool has_row(const std::string& text, const std::string& row) {
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        if (same_row(text.substr(begin, end - begin), row)) return true;
        begin = end + 1;
    }
    return false;
}

}  // namespace

TEST_CASE("Arm feel: at the announced limits no arm gives energy, trembles, or steps by more than a tenth") {
    const std::vector<Press> presses = find_presses(zq350());
    REQUIRE(presses.size() == 5);
    for (const ArmFacts& facts : arm_table()) {
        CAPTURE(std::string(facts.name));
        double at_rim = 0.0;
        const FeelOutcome held = feel_of(zq350(), with(facts), true, presses, at_rim);
        CHECK_FALSE(gives_energy(held));
        CHECK(held.record.greatest_energy <= max_energy);
        CHECK_FALSE(trembles(held));
        CHECK(step_percent(held, facts.announced()) <= largest_step);
        CHECK(held.touched);
        // No hand but the friction of the arm damps it: a first bounce may give energy, but it may not go on.
        const FeelOutcome alone = feel_of(zq350(), with(facts), false, presses, at_rim);
        CHECK(alone.record.energy <= max_energy);
        CHECK_FALSE(trembles(alone));
        CHECK(step_percent(alone, facts.announced()) <= largest_step);
    }
}

TEST_CASE(
    "Arm feel: ten times as stiff without the passivity controller, every arm gives energy or trembles") {
    const std::vector<Press> presses = find_presses(zq350());
    for (const ArmFacts& facts : arm_table()) {
        CAPTURE(std::string(facts.name));
        RigOptions options = with(facts);
        options.hand = hand_impedances()[loose_hand];
        options.controller = false;
        options.coupling_factor = options.wrench_factor = 10.0;
        CHECK_FALSE(is_stable(run_press(zq350(), options, presses.front())));
        CHECK_FALSE(is_stable(run_pull(zq350(), options, Pull::hold)));
    }
}

TEST_CASE("Arm feel: a wrench that the casing holds back does not push the hand by turning to a bolt") {
    // With this seed the wrench meets the casing while it turns. Before, up to 5 mJ came out.
    const std::vector<Press> presses = find_presses(zq350(), 2);
    const auto near = std::find_if(presses.begin(), presses.end(),
                                   [](const Press& press) { return press.name == "near a bolt"; });
    REQUIRE(near != presses.end());
    for (const char* key : {"omega7", "touch"})
        for (const NamedHandImpedance& hand : hand_impedances()) {
            if (hand.unheld) continue;
            CAPTURE(std::string(hand.name));
            RigOptions options = with(arm(key));
            options.hand = hand;
            const FeelOutcome outcome = run_press(zq350(), options, *near);
            CHECK(outcome.touched);
            CHECK(is_stable(outcome));
        }
}

TEST_CASE("Arm feel: guiding shortens the way of a blind hand, and hands bump no more often") {
    constexpr std::uint64_t seeds = 30;
    for (const char* key : {"omega7", "sigma7"}) {
        const ArmFacts& facts = arm(key);
        CAPTURE(key);
        std::vector<Approach> free, guided;
        for (std::uint64_t seed = 0; seed < seeds; ++seed) {
            free.push_back(run_approach(zq350(), facts, seed, false));
            guided.push_back(run_approach(zq350(), facts, seed, true));
        }
        const ApproachSummary without = summarize(free), with_guiding = summarize(guided);
        CHECK(with_guiding.way_ratio < 0.9 * without.way_ratio);
        CHECK(with_guiding.time < without.time);
        CHECK(with_guiding.bumps < without.bumps);
        CHECK(2 * with_guiding.missed < without.missed);
        // These hands hit the casing faster than contact is designed for; the output stage limits the step.
        const double limit = 0.1 * facts.announced().limits.force;
        CHECK(without.step_max > 0.9 * limit);
        CHECK(std::max(without.step_max, with_guiding.step_max) <= limit * (1.0 + 1e-9));
    }
}

TEST_CASE("Arm feel: a run does not depend on the runs before it") {
    const ArmFacts& facts = arm("touch");
    const Approach first = run_approach(zq350(), facts, 3, true);
    (void)run_approach(zq350(), arm("sigma7"), 4, false);
    const Approach again = run_approach(zq350(), facts, 3, true);
    CHECK(first.way == again.way);
    CHECK(first.force == again.force);
    CHECK(first.step == again.step);
    CHECK(first.time == again.time);
}

TEST_CASE("Arm feel: docs/performance.md has the figures of the program") {
    const Result<std::string> text = read_file(BOLT_PERFORMANCE, 1U << 20U, ErrorCode::failed);
    REQUIRE(text);
    const std::size_t begin = text->find(tables_begin), end = text->find(tables_end);
    REQUIRE(begin < end);
    REQUIRE(end != std::string::npos);
    const std::string tables = text->substr(begin, end - begin);
    for (const ArmFacts& facts : arm_table()) CHECK(tables.find(facts.name) != std::string::npos);
    const ArmResult touch = measure(zq350(), arm("touch"));
    for (const std::string& row : rows_of(touch)) CHECK_MESSAGE(has_row(tables, row), row);
    // The check can fail.
    ArmResult other = touch;
    other.contact.held.stable *= 2.0;
    CHECK_FALSE(has_row(tables, rows_of(other)[1]));
    CHECK(replace_tables(*text, "new")->find("| Touch |") == std::string::npos);
    CHECK_FALSE(replace_tables("no marks", "new"));
}
