// bolt-contact-validation: compares contact queries and the god-object on an assembly with the contact
// oracle. It runs for minutes; tests/contact_validation runs a few hundred of the same poses.
#include <algorithm>
#include <thread>

#include <CLI/CLI.hpp>

#include "content/format/assembly.hpp"
#include "engine/base/result.hpp"
#include "engine/program/program.hpp"
#include "game/session/contact_models.hpp"
#include "game/session/lesson_session.hpp"
#include "tools/verify/contact/near_poses.hpp"
#include "tools/verify/contact/penetration_runs.hpp"

namespace {

using namespace bolt;

struct ContactValidationOptions {
    std::string assembly = "zq350";
    contact_validation::NearOptions near;
    int motions = 200;
};

Status check_near_poses(const ContactValidationOptions& options, const servo::ToolContact& contact,
                        const contact_validation::ContactScene& scene) {
    const std::vector<contact_validation::NearPose> poses =
        contact_validation::near_poses(scene, contact.world, contact.wrench, options.near);
    const contact_validation::NearSummary near = contact_validation::summarize(poses, options.near.band);
    if (Status printed = print(contact_validation::to_text(near)); !printed) return printed;
    for (const contact_validation::NearPose& pose : poses)
        if (contact_validation::reported_outside(pose))
            if (Status printed =
                    print("inside, reported as outside: " + contact_validation::to_text(pose.tool) + "\n");
                !printed)
                return printed;
    return near.missed == 0
               ? Status{}
               : fail(ErrorCode::failed, "contact: a crossing deeper than 0.1 mm is not reported",
                      "a contact within 0.1 mm");
}

Status check_motions(const ContactValidationOptions& options, const servo::Setup& setup, servo::State& state,
                     const contact_validation::ContactScene& scene) {
    double deepest = 0.0;
    const auto report = [&](const Result<contact_validation::PenetrationRun>& run) -> Status {
        if (!run) return fail(run.error());
        deepest = std::max(deepest, run->depth);
        return print(contact_validation::to_text(*run));
    };
    const collision::ToolShape& tool = state.tool_contact->wrench;
    const proxy::GodObjectParameters& parameters = state.tool_contact->parameters;
    const std::uint64_t seed = options.near.seed;
    if (Status reported = report(contact_validation::run_flicks(tool, parameters, seed, 4 * options.motions));
        !reported)
        return reported;
    if (Status reported = report(contact_validation::run_in_slot(
            tool, parameters, collision::thickness(setup.wrench.head), seed, 1000 * options.motions));
        !reported)
        return reported;
    if (Status reported =
            report(contact_validation::run_onto_nuts(setup, state, scene, seed, options.motions));
        !reported)
        return reported;
    if (Status reported =
            report(contact_validation::run_through_obstacles(setup, state, scene, seed, options.motions));
        !reported)
        return reported;
    if (deepest > 0.1e-3)
        return fail(ErrorCode::failed, "god-object: the wrench is deeper than 0.1 mm in an obstacle",
                    "at most 0.1 mm");
    return {};
}

Status run(const ContactValidationOptions& options) {
    content::LoadedAssembly loaded = content::load_assembly(options.assembly);
    if (!loaded.ok()) return fail(loaded.errors.front());
    const servo::Setup setup = session::make_setup(loaded.assembly, joint::Law::mechanistic, {}, 1, 0.001);
    Result<std::optional<servo::ToolContact>> contact = session::load_tool_contact(loaded.assembly, setup);
    if (!contact) return fail(contact.error());
    if (!contact->has_value())
        return fail(ErrorCode::bad_content, options.assembly + ": has no contact model",
                    "\"contact_model\" in assembly.json");
    servo::State state = servo::initial_state(setup);
    state.tool_contact = std::move(*contact);
    const contact_validation::ContactScene scene =
        contact_validation::make_scene(state.tool_contact->world, state.tool_contact->wrench);
    if (options.near.poses > 0)
        if (Status checked = check_near_poses(options, *state.tool_contact, scene); !checked) return checked;
    return options.motions > 0 ? check_motions(options, setup, state, scene) : Status{};
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Compares contact queries with brute force in double precision.", "bolt-contact-validation");
    ContactValidationOptions options;
    options.near.threads = std::max(1U, std::thread::hardware_concurrency());
    int exit_code = 0;
    app.add_option("assembly", options.assembly, "Folder, file or name of an assembly");
    app.add_option("--poses", options.near.poses, "Number of poses near obstacles")->capture_default_str();
    app.add_option("--motions", options.motions, "Motions of a hand through the obstacles and onto nuts")
        ->capture_default_str();
    app.add_option("--seed", options.near.seed, "Seed of the random poses and motions")
        ->capture_default_str();
    app.add_option("--threads", options.near.threads, "Threads that check the poses")->capture_default_str();
    app.callback([&] {
        const Status done = run(options);
        exit_code = done ? 0 : print_error(done.error());
    });
    return run_command_line(app, argc, argv, exit_code);
}
