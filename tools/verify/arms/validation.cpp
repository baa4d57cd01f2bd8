#include "tools/verify/arms/validation.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>
#include <thread>

namespace bolt::arm_validation {

namespace {

using Job = std::function<void(TightenedAssembly&, std::span<const Press>)>;

// Runs all jobs. Each thread loads an assembly of its own. Returns the first error of loading.
Status run_jobs(const std::vector<Job>& jobs, const std::string& assembly, unsigned threads) {
    std::atomic<std::size_t> next = 0;
    std::mutex lock;
    std::optional<Error> error;
    const auto work = [&] {
        Result<TightenedAssembly> tightened = load_tightened_assembly(assembly);
        if (!tightened) {
            const std::lock_guard guard(lock);
            if (!error) error = tightened.error();
            return;
        }
        const std::vector<Press> presses = find_presses(*tightened);
        for (std::size_t i = next++; i < jobs.size(); i = next++) jobs[i](*tightened, presses);
    };
    std::vector<std::thread> others;
    for (unsigned i = 1; i < threads; ++i) others.emplace_back(work);
    work();
    for (std::thread& other : others) other.join();
    if (error) return fail(*error);
    return {};
}

StableRange range_of(TightenedAssembly& tightened, std::span<const Press> presses, const RangeQuery& query) {
    return stable_range(tightened, query, presses);
}

// Adds the jobs that measure the stable range of both springs.
void add_range_jobs(std::vector<Job>& jobs, ArmResult& result) {
    const auto add = [&](TestedSpring spring, StableRange& range, bool controller, bool held) {
        jobs.push_back([&range, query = RangeQuery{result.arm, spring, controller, held}](
                           TightenedAssembly& tightened, std::span<const Press> presses) {
            range = range_of(tightened, presses, query);
        });
    };
    for (const TestedSpring spring : {TestedSpring::contact, TestedSpring::nut}) {
        SpringResult& s = spring == TestedSpring::contact ? result.contact : result.nut;
        add(spring, s.held, true, true);
        add(spring, s.uncontrolled, false, true);
        add(spring, s.free, true, false);
    }
}

void add_arm_jobs(std::vector<Job>& jobs, ArmResult& result) {
    add_range_jobs(jobs, result);
    for (const bool held : {true, false})
        jobs.push_back([&result, held](TightenedAssembly& tightened, std::span<const Press> presses) {
            RigOptions options;
            options.arm = result.arm;
            double rim = 0.0;
            (held ? result.held : result.free) = feel_of(tightened, options, held, presses, rim);
            if (held) result.swing_at_rim = rim;
        });
}

}  // namespace

FeelOutcome feel_of(TightenedAssembly& tightened, const RigOptions& options, bool held,
                    std::span<const Press> presses, double& swing_at_rim) {
    std::optional<FeelOutcome> worst;
    const auto add = [&](FeelOutcome outcome, bool at_rim) {
        if (at_rim) {
            swing_at_rim = std::max(swing_at_rim, outcome.late_swing);
            outcome.late_swing = outcome.early_swing = 0.0;
        }
        worst = worst ? worse(*worst, outcome) : outcome;
    };
    RigOptions with = options;
    for (const NamedHandImpedance& hand : hand_impedances()) {
        if (hand.unheld == held) continue;
        with.hand = hand;
        for (const Press& press : presses) add(run_press(tightened, with, press), false);
        add(run_pull(tightened, with, Pull::hold), false);
        const bool can_tighten = hand.stiffness >= hand_impedances()[usual_hand].stiffness;
        if (!held || !can_tighten) continue;
        for (const Pull pull : {Pull::breakaway, Pull::yield, Pull::slip_off})
            add(run_pull(tightened, with, pull), pull == Pull::slip_off);
    }
    return worst.value_or(FeelOutcome{});
}

ArmResult measure(TightenedAssembly& tightened, const ArmFacts& arm) {
    ArmResult result;
    result.arm = &arm;
    std::vector<Job> jobs;
    add_arm_jobs(jobs, result);
    const std::vector<Press> presses = find_presses(tightened);
    for (const Job& job : jobs) job(tightened, presses);
    return result;
}

bool runs_approaches(const ArmFacts& arm) {
    constexpr std::array keys{"omega7", "touch", "inverse3", "sigma7"};
    return std::any_of(keys.begin(), keys.end(), [&](const char* key) { return arm.key == key; });
}

Result<ValidationResult> validate(const ValidationOptions& options) {
    ValidationResult result;
    struct Raw {
        std::vector<Approach> free, guided;
    };
    std::vector<Raw> raw;
    for (const ArmFacts* arm : options.arms) {
        result.arms.push_back({arm, {}, {}, {}, {}, 0.0});
        if (options.approaches > 0 && runs_approaches(*arm)) result.approaches.push_back({arm, {}, {}});
    }
    const auto count = static_cast<std::size_t>(std::max(options.approaches, 0));
    raw.resize(result.approaches.size(), {std::vector<Approach>(count), std::vector<Approach>(count)});

    std::vector<Job> jobs;
    for (ArmResult& arm : result.arms) add_arm_jobs(jobs, arm);
    for (std::size_t a = 0; a < raw.size(); ++a)
        for (const bool guided : {false, true})
            for (std::size_t seed = 0; seed < count; ++seed)
                jobs.push_back([&, a, guided, seed](TightenedAssembly& tightened, std::span<const Press>) {
                    (guided ? raw[a].guided : raw[a].free)[seed] =
                        run_approach(tightened, *result.approaches[a].arm, seed, guided);
                });
    BOLT_TRY(run_jobs(jobs, options.assembly, options.threads));
    for (std::size_t a = 0; a < raw.size(); ++a) {
        result.approaches[a].free = summarize(raw[a].free);
        result.approaches[a].guided = summarize(raw[a].guided);
    }
    return result;
}

}  // namespace bolt::arm_validation
