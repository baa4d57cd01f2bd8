#include "game/study_results/simulate.hpp"

#include <fmt/format.h>

#include <atomic>
#include <mutex>

#include "engine/base/parallel.hpp"
#include "engine/base/random.hpp"
#include "game/study/measures.hpp"
#include "game/study/study_lesson.hpp"
#include "game/study_results/results.hpp"

namespace bolt::study {

namespace fs = std::filesystem;

namespace {

// One simulated participant, with a clock of its own that its lessons and breaks advance.
struct SimulatedPerson {
    Participation participation;
    std::shared_ptr<std::int64_t> now;
    Random random;
    double trait;      // standard deviations, of all its answers
    std::size_t kind;  // SimulatedLesson::person
};

// All that the persons share.
struct Simulation {
    const content::Study& study;
    const fs::path& folder;
    const SimulationOptions& options;
    const SimulationProgress& progress;
    std::mutex progress_mutex{};
    std::atomic<bool> stopped{false};
};

Status answer_form(const Simulation& simulation, SimulatedPerson& person, const Step& step) {
    const content::Questionnaire& form = simulation.study.questionnaires[step.form];
    const std::vector<double>& effects = simulation.options.effects;
    const bool between = simulation.study.design.subjects == content::StudySubjects::between;
    const std::size_t condition = between ? person.participation.conditions().front() : step.condition;
    const double effect = condition < effects.size() ? effects[condition] : 0.0;
    for (std::size_t item = 0; item < form.items.size(); ++item) {
        const double latent = person.trait + effect + person.random.normal();
        BOLT_TRY(person.participation.answer(form.items[item].id, simulated_answer(form, item, latent)));
    }
    *person.now += static_cast<std::int64_t>(5 * form.items.size());
    return person.participation.complete();
}

Status play_lesson(const Simulation& simulation, SimulatedPerson& person, const Step& step) {
    const content::StudyLesson& lesson = person.participation.lesson();
    BOLT_TRY_ASSIGN(const auto assembly, load_lesson_assembly(lesson, simulation.folder));
    session::LessonOptions options = lesson_options(lesson, assembly.law);
    options.seed = lesson_seed(simulation.study, person.participation.progress().place, step.id);
    options.trainee = person.participation.progress().person;
    BOLT_TRY_ASSIGN(const auto out, person.participation.begin_lesson());
    const fs::path session = out / lesson_session_name;
    BOLT_TRY_ASSIGN(const auto outcome, simulation.options.play({assembly, std::move(options), person.kind,
                                                                 lesson.view_help, session}));
    *person.now += static_cast<std::int64_t>(outcome.result.duration);
    BOLT_TRY_ASSIGN(const auto measures, measure_session(session));
    return person.participation.end_lesson(measures);
}

Status do_step(const Simulation& simulation, SimulatedPerson& person) {
    const Step& step = *person.participation.due();
    *person.now += static_cast<std::int64_t>(person.participation.remaining_wait());
    switch (step.kind) {
        case StudyStepKind::language:
            BOLT_TRY(
                person.participation.choose_language(content::complete_languages(simulation.study).front()));
            break;
        case StudyStepKind::consent:
            for (std::size_t i = 0; i < simulation.study.consent.begin()->second.size(); ++i)
                BOLT_TRY(person.participation.agree(i));
            break;
        case StudyStepKind::form:
            return answer_form(simulation, person, step);
        case StudyStepKind::training:
            *person.now += static_cast<std::int64_t>(simulation.study.training->duration);
            return person.participation.end_lesson({{"duration_s", simulation.study.training->duration}});
        case StudyStepKind::lesson:
        case StudyStepKind::retention:
            return play_lesson(simulation, person, step);
        default:
            break;
    }
    return person.participation.complete();
}

Status do_all_steps(Simulation& simulation, SimulatedPerson& person) {
    while (person.participation.due() != nullptr && !simulation.stopped) {
        const Step step = *person.participation.due();
        BOLT_TRY(do_step(simulation, person));
        if (step.kind != StudyStepKind::lesson && step.kind != StudyStepKind::retention) continue;
        const std::lock_guard lock(simulation.progress_mutex);
        if (!simulation.progress(person.participation.participant(), step)) simulation.stopped = true;
    }
    return {};
}

Result<std::vector<SimulatedPerson>> enrol_persons(const Simulation& simulation) {
    std::vector<SimulatedPerson> persons;
    for (std::size_t i = 0; i < simulation.options.participants; ++i) {
        const auto now = std::make_shared<std::int64_t>(system_time());
        BOLT_TRY_ASSIGN(auto participation, Participation::enrol(simulation.study, simulation.folder,
                                                                 fmt::format("simulated-{}", i + 1), true,
                                                                 [now] { return *now; }));
        Random random(simulation.options.seed, i);
        const double trait = random.normal();
        const std::size_t kind = random.bits();
        persons.push_back({std::move(participation), now, random, trait, kind});
    }
    return persons;
}

}  // namespace

Status simulate(const content::Study& study, const fs::path& folder, const SimulationOptions& options,
                const SimulationProgress& progress) {
    if (content::complete_languages(study).empty())
        return fail(ErrorCode::bad_content, "there is no language in which everything can be read",
                    "the texts that `boltwright study check` lists");
    BOLT_TRY_ASSIGN(const auto present, list_participants(study, folder));
    if (!present.empty()) {
        Error error;
        error.file = (folder / participants_folder_name).string();
        error.what = fmt::format("has {} participants", present.size());
        error.expected =
            "a folder of the study without participants, because simulated ones are never mixed with people";
        return fail(std::move(error));
    }
    Simulation simulation{study, folder, options, progress};
    BOLT_TRY_ASSIGN(auto persons, enrol_persons(simulation));
    std::vector<Status> results(persons.size());
    const auto play = [&](std::size_t i) {
        results[i] = do_all_steps(simulation, persons[i]);
        if (!results[i]) simulation.stopped = true;
    };
    for_each_in_parallel(persons.size(), play, options.threads);
    for (Status& result : results) BOLT_TRY(std::move(result));
    if (simulation.stopped) return fail(ErrorCode::failed, "the simulation was stopped", {});
    return {};
}

}  // namespace bolt::study
