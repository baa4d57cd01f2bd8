#include "game/study/study_lesson.hpp"

#include <fmt/format.h>

#include <set>

#include "content/format/folders.hpp"
#include "engine/base/hash.hpp"

namespace bolt::study {

namespace fs = std::filesystem;

namespace {

// All lessons of the study with a name for messages.
std::vector<std::pair<std::string, const content::StudyLesson*>> lessons_of(const content::Study& study) {
    std::vector<std::pair<std::string, const content::StudyLesson*>> lessons;
    if (study.training) lessons.emplace_back("training", &study.training->lesson);
    for (const content::StudyCondition& condition : study.conditions)
        lessons.emplace_back("condition \"" + condition.id + "\"", &condition.lesson);
    if (study.retention) lessons.emplace_back("retention test", &study.retention->lesson);
    return lessons;
}

void check_texts(const content::Study& study, const fs::path& folder, StudyCheck& check) {
    for (const content::Questionnaire& form : study.questionnaires)
        for (const auto& [language, title] : study.titles) {
            const std::vector<std::string> missing = content::missing_texts(form, language);
            if (missing.empty()) continue;
            check.additions.push_back(fmt::format(
                "{}: {} of {} items have no text in \"{}\"; expected the texts that your licence permits",
                (folder / content::forms_folder_name / (form.id + ".json")).string(), missing.size(),
                form.items.size(), language));
        }
    const std::vector<std::string> complete = content::complete_languages(study);
    for (const auto& [language, title] : study.titles)
        if (check.additions.empty() &&
            std::find(complete.begin(), complete.end(), language) == complete.end())
            check.additions.push_back(
                fmt::format("{}: something has no text in \"{}\"; expected the information, all statements "
                            "of the consent, and the labels of all answers",
                            folder.string(), language));
    for (const auto& [language, title] : study.titles)
        if (!study.information.contains(language) || !study.consent.contains(language))
            check.additions.push_back(
                fmt::format("{}: \"information\" or \"consent\" has no text in \"{}\"; expected both, or no "
                            "title in this language",
                            (folder / content::study_file_name).string(), language));
}

void check_design(const content::Study& study, StudyCheck& check) {
    const std::size_t block = content::balanced_participants(study);
    if (study.design.participants % block != 0)
        check.weaknesses.push_back(
            fmt::format("{} participants do not balance the design; expected a multiple of {}",
                        study.design.participants, block));
    constexpr std::size_t too_few = 5;
    if (!study.comparisons.empty() && study.design.participants <= too_few)
        check.weaknesses.push_back(
            fmt::format("with {} participants no signed rank test can reach p < 0.05; expected 6 or more",
                        study.design.participants));
    for (const content::StudyForm& form : study.forms)
        if (form.id == "ssq" && !form.is_at(content::FormTime::before))
            check.weaknesses.push_back(
                "form \"ssq\" is not presented before the lessons; healthy people do not start at 0, so the "
                "difference cannot be seen");
    if (study.conditions.size() > 1 && study.comparisons.empty())
        check.weaknesses.push_back(
            "no comparison is planned; a comparison that is chosen after seeing the data proves nothing");
    if (!study.training)
        check.weaknesses.push_back(
            "there is no training, so the first lessons differ mostly because people still learn the "
            "program");
}

}  // namespace

std::string assembly_of(const content::StudyLesson& lesson, const fs::path& study_folder) {
    std::error_code ignored;
    const fs::path own = study_folder / lesson.assembly;
    return fs::exists(own, ignored) ? own.string() : lesson.assembly;
}

session::LessonOptions lesson_options(const content::StudyLesson& lesson, joint::Law assembly_law) {
    session::LessonOptions options;
    options.mode = lesson.mode == "guided"     ? lesson::Mode::guided
                   : lesson.mode == "practice" ? lesson::Mode::practice
                                               : lesson::Mode::assessment;
    options.task = lesson.task == "loosen" ? lesson::Task::loosen : lesson::Task::tighten;
    options.law = joint::law_named(lesson.law).value_or(assembly_law);
    options.obstacles = session::Obstacles::if_any;
    options.guide = lesson.guide;
    return options;
}

Result<content::Assembly> load_lesson_assembly(const content::StudyLesson& lesson,
                                               const fs::path& study_folder) {
    content::LoadedAssembly loaded =
        content::load_assembly(assembly_of(lesson, study_folder), lesson.variant);
    if (!loaded.ok()) return fail(loaded.errors.front());
    if (!lesson.tool.empty()) BOLT_TRY(content::choose_tool(loaded.assembly, lesson.tool));
    const joint::Law law = joint::law_named(lesson.law).value_or(loaded.assembly.law);
    return lesson::apply_law(std::move(loaded.assembly), law);
}

std::uint64_t lesson_seed(const content::Study& study, std::size_t place, std::string_view step) {
    Fnv1a hash;
    hash.add(fmt::format("{} {} ", study.design.seed, place));
    hash.add(step);
    return hash.value() >> 32U;  // fits every place that stores a seed
}

StudyCheck check_study(const content::Study& study, const fs::path& folder) {
    StudyCheck check;
    std::set<std::string> reported;
    for (const auto& [name, lesson] : lessons_of(study)) {
        const Result<content::Assembly> assembly = load_lesson_assembly(*lesson, folder);
        if (assembly) continue;
        Error error = assembly.error();
        if (!reported.insert(error.message()).second) continue;
        error.what = fmt::format("{} (lesson of the {})", error.what, name);
        check.errors.push_back(std::move(error));
    }
    check_texts(study, folder, check);
    check_design(study, check);
    return check;
}

}  // namespace bolt::study
