// boltwright study run: leads a participant through a study in a window, a headset or before walls.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "content/studies/study.hpp"
#include "content/words/words.hpp"
#include "engine/base/file.hpp"
#include "engine/platform/window.hpp"
#include "game/cli/commands.hpp"
#include "game/cli/train_arguments.hpp"
#include "game/study/measures.hpp"
#include "game/study/study_lesson.hpp"
#include "game/study_journal/known_studies.hpp"
#include "game/study_results/results.hpp"
#include "game/trainer/app.hpp"

namespace bolt::cli {

namespace {

struct StudyRunArguments {
    std::string folder, participant;
    bool accept_change = false, accept_clock = false;
    TrainArguments window;
};

// Fails if a lesson that the participant has still to do needs a device or a display that this computer does
// not have.
Status check_remaining_equipment(const study::Participation& participation, const std::string& folder) {
    const auto remaining = std::span(participation.steps()).subspan(participation.due_index());
    const auto errors = study::check_equipment(participation.study(), folder, remaining, equipment_check());
    return errors.empty() ? Status() : fail(errors.front());
}

// Continues the participation. Entries from the future are a sign of a wrong clock, which would make the
// participant come again on a wrong day.
Result<study::Participation> resume_participation(const content::Study& study, const std::string& participant,
                                                  const StudyRunArguments& options) {
    BOLT_TRY_ASSIGN(auto participation,
                    study::Participation::resume(study, options.folder, participant, options.accept_change));
    if (participation.clock_behind() > study::tolerated_set_back) {
        if (!options.accept_clock)
            return fail(
                ErrorCode::usage,
                fmt::format("{}: the last entry is of {}, but the clock of this computer says {}",
                            participant, study::time_text(participation.progress().latest),
                            study::time_text(study::system_time())),
                "the right date and time on this computer, or --accept-clock if they are right and the entry "
                "has the wrong time");
        BOLT_TRY(participation.accept_clock());
    }
    BOLT_TRY(check_remaining_equipment(participation, options.folder));
    return participation;
}

// The participation that --participant names, or that of the person whom --trainee names, or else a new one.
Result<study::Participation> find_participation(const content::Study& study,
                                                const StudyRunArguments& options) {
    BOLT_TRY_ASSIGN(const auto data, user_data_folder());
    if (!options.participant.empty()) {
        BOLT_TRY(study::remember_study(data, options.folder));  // it may have been moved since
        return resume_participation(study, options.participant, options);
    }
    if (options.window.trainee.empty())
        return fail(ErrorCode::usage, "nobody takes part",
                    "--trainee NAME for a person, or --participant P03 for one who has begun");
    BOLT_TRY_ASSIGN(const auto person,
                    person_argument(options.window.trainee, data / "gloves", NewPerson::added));
    BOLT_TRY_ASSIGN(const auto states, study::list_participants(study, options.folder));
    BOLT_TRY(study::remember_study(data, options.folder));
    for (const study::ParticipantState& state : states)
        if (!state.withdrawn && state.progress.person == person.code)
            return resume_participation(study, state.participant, options);
    if (const auto errors = study::check_equipment(study, options.folder, equipment_check()); !errors.empty())
        return fail(errors.front());
    return study::Participation::enrol(study, options.folder, person.code, false);
}

// The page for the experimenter. A page that cannot be written must not stop the participant.
void write_progress(const content::Study& study, const std::string& folder) {
    const auto states = study::list_participants(study, folder);
    if (!states) {
        (void)print_error(states.error());
        return;
    }
    const std::string page = study::progress_page(study, *states, study::system_time());
    if (Status written = write_file(std::filesystem::path(folder) / "progress.html", page); !written)
        (void)print_error(written.error());
}

Status run(const StudyRunArguments& options) {
    BOLT_TRY_ASSIGN(const auto study, load_study_folder(options.folder));
    const study::StudyCheck check = study::check_study(study, options.folder);
    if (!check.errors.empty()) return fail(check.errors.front());
    if (content::names_displays(study) && (options.window.hmd || !options.window.displays.empty()))
        return fail(ErrorCode::usage, "the plan names the displays of its lessons",
                    "no --hmd and no --displays");
    const std::vector<std::string> own = words::languages(words::words_folder());
    const std::vector<std::string> readable = content::complete_languages(study);
    const bool any = std::any_of(readable.begin(), readable.end(), [&](const std::string& language) {
        return std::find(own.begin(), own.end(), language) != own.end();
    });
    if (!any)
        return fail(ErrorCode::bad_content,
                    "there is no language of the program in which everything can be read",
                    "the texts that `boltwright study check` lists");
    // Devices and desktop are checked first, so that a failure enrols no participant.
    BOLT_TRY(equipment_of(options.window));
    BOLT_TRY(platform::Desktop::open());
    BOLT_TRY_ASSIGN(auto participation, find_participation(study, options));
    if (participation.progress().simulated)
        return fail(ErrorCode::usage, participation.participant() + " is a simulated participant",
                    "a person");
    BOLT_TRY(study::count_finished_lesson(participation));
    if (participation.due() == nullptr && options.accept_change) {
        (void)std::fputs(
            fmt::format("{} has done every step; the change is recorded\n", participation.participant())
                .c_str(),
            stderr);
        return {};
    }
    if (participation.due() == nullptr)
        return fail(ErrorCode::usage, fmt::format("{} has done every step", participation.participant()),
                    "another participant");
    (void)std::fputs(fmt::format("{}: {}\n", participation.participant(), participation.due()->id).c_str(),
                     stderr);
    TrainArguments window = options.window;
    window.out = options.folder;
    trainer::StudyRun run{std::move(participation), options.folder,
                          [&] { write_progress(study, options.folder); }};
    return run_study(window, std::move(run));
}

}  // namespace

void add_study_run(CLI::App& study, int& exit_code) {
    const auto options = std::make_shared<StudyRunArguments>();
    CLI::App* command = study.add_subcommand(
        "run", "Lead a participant through the study in a window; continues where it ended");
    command->add_option("folder", options->folder, "Folder of the study")->required();
    command->add_option("--participant", options->participant, "One who has begun, such as P03");
    command->add_flag("--accept-change", options->accept_change,
                      "Continue although the plan was changed; the journal records it");
    command->add_flag(
        "--accept-clock", options->accept_clock,
        "Continue although earlier entries are ahead of this computer's clock, because their time was "
        "wrong; the journal records it");
    add_study_options(*command, options->window);
    command->callback([options, &exit_code] {
        const Status done = run(*options);
        exit_code = done ? 0 : print_error(done.error());
    });
}

}  // namespace bolt::cli
