// bolt-truth: what contact tells and does on an assembly, held against brute force in double. Takes minutes;
// tests run a few hundred poses of the same.
#include <algorithm>
#include <thread>

#include <CLI/CLI.hpp>

#include "content/format/load.hpp"
#include "engine/base/console.hpp"
#include "game/cli/program.hpp"
#include "game/play/servo_setup.hpp"
#include "game/play/touch_models.hpp"
#include "tools/truth/near_poses.hpp"
#include "tools/truth/trips.hpp"

namespace {

using namespace bolt;

struct Options {
    std::string assembly = "zq350";
    truth::NearOptions near;
    int ways = 200;
};

Status ask(const Options& options, const servo::Touch& touch, const truth::Scene& scene) {
    const std::vector<truth::NearPose> poses =
        truth::near_poses(scene, touch.world, touch.wrench, options.near);
    const truth::NearSummary near = truth::summarize(poses, options.near.band);
    if (Status said = say(truth::to_text(near)); !said) return said;
    for (const truth::NearPose& pose : poses)
        if (truth::told_outside(pose))
            if (Status said = say("inside, told to be outside: " + truth::to_text(pose.tool) + "\n"); !said)
                return said;
    return near.missed == 0 ? Status{} : fail(ErrorCode::failed, "something that is inside was not told");
}

Status lead(const Options& options, const servo::Setup& setup, servo::State& state,
            const truth::Scene& scene) {
    double deepest = 0.0;
    const auto tell = [&](const Result<truth::Trip>& trip) -> Status {
        if (!trip) return fail(trip.error());
        deepest = std::max(deepest, trip->depth);
        return say(truth::to_text(*trip));
    };
    const contact::ToolShape& tool = state.touch->wrench;
    const contact::GodObjectParameters& parameters = state.touch->parameters;
    const std::uint64_t seed = options.near.seed;
    if (Status told = tell(truth::flicked(tool, parameters, seed, 4 * options.ways)); !told) return told;
    if (Status told =
            tell(truth::in_a_slot(tool, parameters, setup.wrench.jaw.thickness, seed, 1000 * options.ways));
        !told)
        return told;
    if (Status told = tell(truth::at_nuts(setup, state, scene, seed, options.ways)); !told) return told;
    if (Status told = tell(truth::pulled_through(setup, state, scene, seed, options.ways)); !told)
        return told;
    if (deepest > 0.1e-3) return fail(ErrorCode::failed, "the wrench was deeper than 0.1 mm in something");
    return {};
}

Status run(const Options& options) {
    content::Loaded loaded = content::load_assembly(options.assembly);
    if (!loaded.ok()) return fail(loaded.errors.front());
    const servo::Setup setup = play::make_setup(loaded.assembly, joint::Law::mechanistic, {}, 1, 0.001);
    Result<std::optional<servo::Touch>> touch = play::load_touch(loaded.assembly, setup);
    if (!touch) return fail(touch.error());
    if (!touch->has_value())
        return fail(ErrorCode::bad_content, options.assembly + " has nothing to bump into");
    servo::State state = servo::initial_state(setup);
    state.touch = std::move(*touch);
    const truth::Scene scene = truth::make_scene(state.touch->world, state.touch->wrench);
    if (options.near.poses > 0)
        if (Status held = ask(options, *state.touch, scene); !held) return held;
    return options.ways > 0 ? lead(options, setup, state, scene) : Status{};
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Holds contact against brute force in double.", "bolt-truth");
    Options options;
    options.near.threads = std::max(1U, std::thread::hardware_concurrency());
    int exit_code = 0;
    app.add_option("assembly", options.assembly, "Folder, file or name of an assembly");
    app.add_option("--poses", options.near.poses, "Near poses")->capture_default_str();
    app.add_option("--ways", options.ways, "Ways of a hand through everything, and times at nuts")
        ->capture_default_str();
    app.add_option("--seed", options.near.seed)->capture_default_str();
    app.add_option("--threads", options.near.threads)->capture_default_str();
    app.callback([&] {
        const Status done = run(options);
        exit_code = done ? 0 : complain(done.error());
    });
    return cli::run_program(app, argc, argv, exit_code);
}
