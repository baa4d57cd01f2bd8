// bolt-contact-validation: compares contact queries and the god-object on an assembly with the contact
// oracle. Takes minutes; tests/contact_validation runs a few hundred of the same poses.
#include <algorithm>
#include <thread>

#include <CLI/CLI.hpp>

#include "content/format/assembly.hpp"
#include "engine/base/program.hpp"
#include "engine/base/result.hpp"
#include "game/session/contact_models.hpp"
#include "game/session/lesson_session.hpp"
#include "tools/verify/contact/near_poses.hpp"
#include "tools/verify/contact/penetration_runs.hpp"

namespace {

using namespace bolt;

struct Options {
    std::string assembly = "zq350";
    contact_validation::NearOptions near;
    int ways = 200;
};

Status ask(const Options& options, const servo::ToolContact& touch, const contact_validation::Scene& scene) {
    const std::vector<contact_validation::NearPose> poses =
        contact_validation::near_poses(scene, touch.world, touch.wrench, options.near);
    const contact_validation::NearSummary near = contact_validation::summarize(poses, options.near.band);
    if (Status said = print(contact_validation::to_text(near)); !said) return said;
    for (const contact_validation::NearPose& pose : poses)
        if (contact_validation::told_outside(pose))
            if (Status said =
                    print("inside, reported as outside: " + contact_validation::to_text(pose.tool) + "\n");
                !said)
                return said;
    return near.missed == 0 ? Status{}
                            : fail(ErrorCode::failed,
                                   "contact: a crossing deeper than 0.1 mm is not reported; expected a "
                                   "contact within 0.1 mm");
}

Status lead(const Options& options, const servo::Setup& setup, servo::State& state,
            const contact_validation::Scene& scene) {
    double deepest = 0.0;
    const auto tell = [&](const Result<contact_validation::PenetrationRun>& run) -> Status {
        if (!run) return fail(run.error());
        deepest = std::max(deepest, run->depth);
        return print(contact_validation::to_text(*run));
    };
    const collision::ToolShape& tool = state.tool_contact->wrench;
    const proxy::GodObjectParameters& parameters = state.tool_contact->parameters;
    const std::uint64_t seed = options.near.seed;
    if (Status told = tell(contact_validation::flicked(tool, parameters, seed, 4 * options.ways)); !told)
        return told;
    if (Status told = tell(contact_validation::in_a_slot(tool, parameters, setup.wrench.jaw.thickness, seed,
                                                         1000 * options.ways));
        !told)
        return told;
    if (Status told = tell(contact_validation::at_nuts(setup, state, scene, seed, options.ways)); !told)
        return told;
    if (Status told = tell(contact_validation::pulled_through(setup, state, scene, seed, options.ways));
        !told)
        return told;
    if (deepest > 0.1e-3)
        return fail(ErrorCode::failed,
                    "god-object: the wrench is deeper than 0.1 mm in an obstacle; expected at most 0.1 mm");
    return {};
}

Status run(const Options& options) {
    content::Loaded loaded = content::load_assembly(options.assembly);
    if (!loaded.ok()) return fail(loaded.errors.front());
    const servo::Setup setup = session::make_setup(loaded.assembly, joint::Law::mechanistic, {}, 1, 0.001);
    Result<std::optional<servo::ToolContact>> touch = session::load_tool_contact(loaded.assembly, setup);
    if (!touch) return fail(touch.error());
    if (!touch->has_value())
        return fail(ErrorCode::bad_content,
                    options.assembly + ": has no contact model; expected \"contact_model\" in assembly.json");
    servo::State state = servo::initial_state(setup);
    state.tool_contact = std::move(*touch);
    const contact_validation::Scene scene =
        contact_validation::make_scene(state.tool_contact->world, state.tool_contact->wrench);
    if (options.near.poses > 0)
        if (Status held = ask(options, *state.tool_contact, scene); !held) return held;
    return options.ways > 0 ? lead(options, setup, state, scene) : Status{};
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Compares contact queries with brute force in double precision.", "bolt-contact-validation");
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
        exit_code = done ? 0 : print_error(done.error());
    });
    return run_command_line(app, argc, argv, exit_code);
}
