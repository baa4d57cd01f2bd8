// boltwright study: makes and checks the plan of a study, shows its progress and its results, and fills it
// with simulated participants. study_run.cpp leads a participant through it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "content/format/folders.hpp"
#include "content/format/json_document.hpp"
#include "content/studies/study.hpp"
#include "engine/base/file.hpp"
#include "game/cli/commands.hpp"
#include "game/station/station_setup.hpp"
#include "game/study/study_lesson.hpp"
#include "game/study_results/results.hpp"
#include "game/study_results/simulate.hpp"
#include "game/trainees/trainee.hpp"
#include "game/view/camera.hpp"
namespace bolt::cli {

namespace fs = std::filesystem;

namespace {

struct StudyArguments {
    std::string folder, from = "guiding", participant, html, csv, json, out;
    std::vector<std::string> effects;  // CONDITION=SHIFT
    std::size_t participants = 0;      // 0: as planned
    std::size_t studies = 500;
    std::uint64_t seed = 1;
    bool yes = false, quiet = false;
    std::string mean;
    std::size_t n = 0;
    double step = 1.0, low = 0.0;
    std::optional<double> high;
};

std::vector<std::string> example_names() {
    std::vector<std::string> names;
    std::error_code ignored;
    for (const fs::directory_entry& entry :
         fs::directory_iterator(content::content_folder() / "studies", ignored))
        if (fs::exists(entry.path() / content::study_file_name, ignored))
            names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

Status copy_content_file(const fs::path& from, const fs::path& to) {
    BOLT_TRY_ASSIGN(std::string text, read_file(from, 1U << 20U, ErrorCode::bad_content));
    // The schema stays where it is, so the path to it changes.
    const std::string schema = from.parent_path().filename() == content::forms_folder_name
                                   ? "questionnaire.schema.json"
                                   : "study.schema.json";
    const std::size_t at = text.find("/schema/" + schema);
    if (at != std::string::npos) {
        const std::size_t begin = text.rfind('"', at) + 1;
        text.replace(begin, at - begin, content::content_folder().string());
    }
    return write_file(to, text);
}

// Copies the plan and the forms that it names.
int run_new(const StudyArguments& options) {
    const std::vector<std::string> names = example_names();
    const fs::path from = content::content_folder() / "studies" / options.from;
    if (std::find(names.begin(), names.end(), options.from) == names.end())
        return print_error({ErrorCode::usage, fmt::format("there is no study \"{}\"", options.from),
                            content::suggest(options.from, names)});
    const fs::path to = options.folder;
    std::error_code problem;
    if (fs::exists(to / content::study_file_name, problem))
        return print_error({ErrorCode::usage, "there is a study already", "a new folder", to.string()});
    const fs::path forms = content::content_folder() / "questionnaires";
    const content::LoadedStudy study = content::load_study(from, forms);
    if (!study.ok()) return print_error(study.errors);
    for (const content::StudyForm& form : study.study.forms)
        if (const fs::path own = to / content::forms_folder_name / (form.id + ".json");
            fs::exists(own, problem))
            return print_error({ErrorCode::usage, "there is a form already", "a new folder", own.string()});
    fs::create_directories(to / content::forms_folder_name, problem);
    if (problem)
        return print_error({ErrorCode::failed, "cannot be created: " + problem.message(), {}, to.string()});
    for (const content::StudyForm& form : study.study.forms) {
        const std::string name = form.id + ".json";
        if (Status copied = copy_content_file(forms / name, to / content::forms_folder_name / name); !copied)
            return print_error(copied.error());
    }
    if (Status copied = copy_content_file(from / content::study_file_name, to / content::study_file_name);
        !copied)
        return print_error(copied.error());
    const Status printed =
        print(fmt::format("{}\nEdit it, then: boltwright study check {}\nMore forms to copy into {}: {}\n",
                          (to / content::study_file_name).string(), options.folder,
                          (to / content::forms_folder_name).string(), forms.string()));
    return printed ? 0 : print_error(printed.error());
}

std::string order_text(const content::Study& study, std::size_t place) {
    std::string text;
    for (const std::size_t condition : content::conditions_of(study, place))
        text += (text.empty() ? "" : ", ") + study.conditions[condition].id;
    return text;
}

int run_check(const StudyArguments& options) {
    const content::LoadedStudy loaded = content::load_study(options.folder);
    if (!loaded.ok()) return print_error(loaded.errors);
    const content::Study& study = loaded.study;
    const study::StudyCheck check = study::check_study(study, options.folder, equipment_check());
    std::string out = fmt::format("{}: {} conditions, {} participants, {} forms, {} planned comparisons\n",
                                  study.id, study.conditions.size(), study.design.participants,
                                  study.forms.size(), study.comparisons.size());
    const std::size_t rows =
        study.design.blind ? 0 : std::min(study.design.participants, content::balanced_participants(study));
    for (std::size_t place = 0; place < rows; ++place)
        out += fmt::format("  place {}: {}\n", place + 1, order_text(study, place));
    out += fmt::format("languages in which everything can be read: {}\n",
                       content::complete_languages(study).empty()
                           ? std::string("none")
                           : fmt::format("{}", fmt::join(content::complete_languages(study), ", ")));
    for (const std::string& addition : check.additions) out += "to add: " + addition + "\n";
    for (const std::string& weakness : check.weaknesses) out += "consider: " + weakness + "\n";
    if (Status printed = print(out); !printed) return print_error(printed.error());
    if (!check.errors.empty()) return print_error(check.errors);
    return content::complete_languages(study).empty() ? static_cast<int>(ErrorCode::bad_content) : 0;
}

int run_status(const StudyArguments& options) {
    const Result<content::Study> study = load_study_folder(options.folder);
    if (!study) return print_error(study.error());
    const auto states = study::list_participants(*study, options.folder);
    if (!states) return print_error(states.error());
    const std::int64_t now = study::system_time();
    if (!options.html.empty())
        if (Status written = write_file(options.html, study::progress_page(*study, *states, now)); !written)
            return print_error(written.error());
    const Status printed = print(study::progress_text(*study, *states, now));
    return printed ? 0 : print_error(printed.error());
}

int run_results(const StudyArguments& options) {
    const Result<content::Study> study = load_study_folder(options.folder);
    if (!study) return print_error(study.error());
    const auto data = study::collect(*study, options.folder);
    if (!data) return print_error(data.error());
    const study::Results results = study::analyse(*study, *data, {.resamples = 5000, .seed = options.seed});
    const fs::path folder = options.folder;
    const fs::path html = options.html.empty() ? folder / "results.html" : fs::path(options.html);
    const fs::path csv = options.csv.empty() ? folder / "results.csv" : fs::path(options.csv);
    const fs::path json = options.json.empty() ? folder / "results.json" : fs::path(options.json);
    for (const auto& [path, text] : {std::pair(html, study::results_page(*study, *data, results)),
                                     std::pair(csv, study::results_csv(*study, *data)),
                                     std::pair(csv.parent_path() / "answers.csv", study::answers_csv(*data)),
                                     std::pair(json, study::results_json(*study, *data, results))})
        if (Status written = write_file(path, text); !written) return print_error(written.error());
    std::string out = fmt::format("{} participants, {} complete, {} withdrew\n", data->participants.size(),
                                  data->completed(), data->withdrawn);
    for (const study::IncompleteForm& form : study::incomplete_forms(*study, data->participants))
        out += study::incomplete_text(form) + "\n";
    out += fmt::format("{}\n{}\n{}\n", html.string(), csv.string(), json.string());
    const Status printed = print(out);
    return printed ? 0 : print_error(printed.error());
}

// "force=0.5" for each condition; several for one condition are added.
Result<std::vector<double>> read_effects(const std::vector<std::string>& texts, const content::Study& study) {
    std::vector<double> effects(study.conditions.size(), 0.0);
    std::vector<std::string> ids;
    for (const content::StudyCondition& condition : study.conditions) ids.push_back(condition.id);
    for (const std::string& text : texts) {
        const std::size_t equals = text.find('=');
        const std::string id = text.substr(0, equals);
        const auto found = std::find(ids.begin(), ids.end(), id);
        if (found == ids.end())
            return fail(ErrorCode::usage, fmt::format("--effect: there is no condition \"{}\"", id),
                        content::suggest(id, ids));
        char* end = nullptr;
        const std::string number = equals == std::string::npos ? "" : text.substr(equals + 1);
        const double shift = std::strtod(number.c_str(), &end);
        if (number.empty() || *end != '\0' || !std::isfinite(shift))
            return fail(ErrorCode::usage, fmt::format("--effect {}: there is no number", text),
                        "CONDITION=SHIFT, such as force=0.5");
        effects[static_cast<std::size_t>(found - ids.begin())] += shift;
    }
    return effects;
}

// The person's random number chooses the profile of the trainee, so each profile is equally likely.
Result<session::LessonOutcome> play_simulated(const study::SimulatedLesson& lesson) {
    const std::vector<std::string> profiles = trainees::profile_names();
    trainees::TrainOptions train;
    train.lesson = lesson.options;
    BOLT_TRY_ASSIGN(train.trainee, trainees::find_profile(profiles[lesson.person % profiles.size()]));
    train.lesson.trainee_profile = train.trainee.name;
    if (lesson.view_help) train.view_help = view::make_view_helper();
    BOLT_TRY_ASSIGN(auto outcome, trainees::train(lesson.assembly, train, lesson.file,
                                                  [](const auto&) { return !interrupted(); }));
    if (interrupted()) return fail(ErrorCode::failed, "the simulation was interrupted", {});
    return outcome;
}

int run_simulate(const StudyArguments& options) {
    const Result<content::Study> study = load_study_folder(options.folder);
    if (!study) return print_error(study.error());
    const auto effects = read_effects(options.effects, *study);
    if (!effects) return print_error(effects.error());
    study::SimulationOptions simulation;
    simulation.participants = options.participants > 0 ? options.participants : study->design.participants;
    simulation.seed = options.seed;
    simulation.effects = *effects;
    simulation.threads = 0;
    simulation.play = play_simulated;
    catch_interruption();
    const auto progress = [&](const std::string& participant, const study::Step& step) {
        if (!options.quiet) (void)std::fputs(fmt::format("{} {}\n", participant, step.id).c_str(), stderr);
        return !interrupted();
    };
    if (Status done = study::simulate(*study, options.folder, simulation, progress); !done)
        return print_error(done.error());
    const Status printed =
        print(fmt::format("{} simulated participants in {}\n", simulation.participants, options.folder));
    return printed ? 0 : print_error(printed.error());
}

int run_power(const StudyArguments& options) {
    const Result<content::Study> study = load_study_folder(options.folder);
    if (!study) return print_error(study.error());
    const auto effects = read_effects(options.effects, *study);
    if (!effects) return print_error(effects.error());
    study::PowerOptions power;
    power.participants = options.participants > 0 ? options.participants : study->design.participants;
    power.studies = options.studies;
    power.seed = options.seed;
    power.effects = *effects;
    std::string out = fmt::format("{} simulated studies of {} participants; share with p (Holm) < {}:\n",
                                  power.studies, power.participants, power.significance);
    for (const study::Power& one : study::simulate_power(*study, power)) {
        out += fmt::format("  {:5.1f} %  {}\n", 100.0 * one.rate, study::comparison_text(*one.planned));
    }
    const std::vector<const content::PlannedComparison*> left_out = study::without_power(*study);
    if (!left_out.empty())
        out +=
            "not estimated, because nothing is known of their values before people come; they count for the "
            "correction with p = 1:\n";
    for (const content::PlannedComparison* planned : left_out)
        out += fmt::format("           {}\n", study::comparison_text(*planned));
    const Status printed = print(out);
    return printed ? 0 : print_error(printed.error());
}

int run_withdraw(const StudyArguments& options) {
    if (!options.yes)
        return print_error(
            {ErrorCode::usage,
             fmt::format("everything that {} answered and did is deleted", options.participant), "--yes"});
    if (Status done = study::withdraw(options.folder, options.participant, study::system_time()); !done)
        return print_error(done.error());
    const Status printed = print(
        fmt::format("{} withdrew; answers, recordings and results pages are deleted\n", options.participant));
    return printed ? 0 : print_error(printed.error());
}

int run_grim(const StudyArguments& options) {
    char* end = nullptr;
    const double mean = std::strtod(options.mean.c_str(), &end);
    if (options.mean.empty() || *end != '\0' || !std::isfinite(mean))
        return print_error({ErrorCode::usage, "--mean: is not a number", "the printed mean, such as 6.684"});
    const std::size_t dot = options.mean.find('.');
    const int decimals = dot == std::string::npos ? 0 : static_cast<int>(options.mean.size() - dot - 1);
    if (options.high && *options.high < options.low)
        return print_error({ErrorCode::usage,
                            fmt::format("--high {} is below --low {}", *options.high, options.low),
                            "the highest answer"});
    const double rounding = 0.5 * std::pow(10.0, -decimals) * (1.0 + 1e-9);
    const bool on_scale =
        mean >= options.low - rounding && (!options.high || mean <= *options.high + rounding);
    const bool possible =
        on_scale && statistics::is_possible_mean(mean, decimals, options.n, options.step, options.low);
    const Status printed = print(fmt::format(
        "{}: {} answers from {}{} in steps of {} {} have this mean{}\n", options.mean, options.n, options.low,
        options.high ? fmt::format(" to {}", *options.high) : "", options.step, possible ? "can" : "cannot",
        options.high || !possible ? "" : "; --high gives the highest answer"));
    if (!printed) return print_error(printed.error());
    return possible ? 0 : static_cast<int>(ErrorCode::failed);
}

}  // namespace

Result<content::Study> load_study_folder(const fs::path& folder) {
    content::LoadedStudy loaded = content::load_study(folder);
    if (loaded.ok()) return std::move(loaded.study);
    for (std::size_t i = 0; i + 1 < loaded.errors.size(); ++i) (void)print_error(loaded.errors[i]);
    return fail(loaded.errors.back());
}

namespace {

using Arguments = std::shared_ptr<StudyArguments>;

CLI::App* add_command(CLI::App& study, const char* name, const char* description, const Arguments& options,
                      int& exit_code, int (*run)(const StudyArguments&)) {
    CLI::App* command = study.add_subcommand(name, description);
    command->callback([options, &exit_code, run] { exit_code = run(*options); });
    if (std::string_view(name) != "grim")
        command->add_option("folder", options->folder, "Folder of the study")->required();
    return command;
}

void add_simulations(CLI::App& study, const Arguments& options, int& exit_code) {
    CLI::App* simulate =
        add_command(study, "simulate", "Fill a folder without participants with simulated ones", options,
                    exit_code, run_simulate);
    simulate->add_flag("--quiet", options->quiet, "Do not print each lesson");
    CLI::App* power = add_command(
        study, "power", "Estimate how often each planned comparison of a form finds a stated effect", options,
        exit_code, run_power);
    power->add_option("--studies", options->studies, "Number of simulated studies")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    for (CLI::App* command : {simulate, power}) {
        command->add_option("--participants", options->participants, "Number; default: as planned")
            ->check(CLI::Range(1, 1000));
        command->add_option("--seed", options->seed, "Seed of the answers")->capture_default_str();
        command
            ->add_option("--effect", options->effects,
                         "CONDITION=SHIFT: raises all answers in the condition by so many standard "
                         "deviations of one person's answers; may be given several times")
            ->take_all();
    }
}

}  // namespace

void add_study(CLI::App& app, int& exit_code) {
    const auto options = std::make_shared<StudyArguments>();
    CLI::App* study = app.add_subcommand("study", "Plan a study with people, run it, and analyse it");
    study->require_subcommand(1);
    CLI::App* make =
        add_command(*study, "new", "Make a study from a shipped one", options, exit_code, run_new);
    make->add_option("--from", options->from, fmt::format("One of {}", fmt::join(example_names(), ", ")))
        ->capture_default_str();
    add_command(
        *study, "check",
        "Check the plan, its forms and its lessons; list the orders, what is to be added, and weaknesses",
        options, exit_code, run_check);
    add_study_run(*study, exit_code);
    CLI::App* status = add_command(*study, "status", "List the participants and how far they are", options,
                                   exit_code, run_status);
    status->add_option("--html", options->html, "Also write a page that reloads itself");
    CLI::App* results = add_command(*study, "results", "Analyse the study: one page, a table and numbers",
                                    options, exit_code, run_results);
    results->add_option("--html", options->html, "Page; default: results.html in the folder");
    results->add_option("--csv", options->csv, "Table; default: results.csv in the folder");
    results->add_option("--json", options->json, "Numbers; default: results.json in the folder");
    results->add_option("--seed", options->seed, "Seed of the bootstrap")->capture_default_str();
    add_simulations(*study, options, exit_code);
    CLI::App* withdraw = add_command(*study, "withdraw", "Delete everything of a participant", options,
                                     exit_code, run_withdraw);
    withdraw->add_option("participant", options->participant, "Such as P03")->required();
    withdraw->add_flag("--yes", options->yes, "Delete without another question");
    CLI::App* grim = add_command(*study, "grim", "Check whether a printed mean is possible (GRIM test)",
                                 options, exit_code, run_grim);
    grim->add_option("--mean", options->mean, "As printed, with all decimals")->required();
    grim->add_option("--n", options->n, "Number of answers")->required()->check(CLI::Range(1, 100000));
    grim->add_option("--low", options->low, "Lowest answer")->capture_default_str();
    grim->add_option("--high", options->high, "Highest answer; default: none");
    grim->add_option("--step", options->step, "Difference of neighbouring answers")
        ->capture_default_str()
        ->check(CLI::Range(1e-6, 1e6));
}

}  // namespace bolt::cli
