#include "game/study/study_lesson.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "content/format/folders.hpp"
#include "content/format/json_document.hpp"
#include "engine/base/hash.hpp"
#include "game/lesson/law.hpp"

namespace bolt::study {

namespace fs = std::filesystem;

namespace {

struct NamedLesson {
    std::string name;   // for messages
    std::string place;  // JSON pointer of the object that has the lesson
    const content::StudyLesson* lesson;
};

std::vector<NamedLesson> lessons_of(const content::Study& study) {
    std::vector<NamedLesson> lessons;
    if (study.training) lessons.push_back({"training", "/training", &study.training->lesson});
    for (std::size_t i = 0; i < study.conditions.size(); ++i)
        lessons.push_back({"condition \"" + study.conditions[i].id + "\"", fmt::format("/conditions/{}", i),
                           &study.conditions[i].lesson});
    if (study.retention) lessons.push_back({"retention test", "/retention", &study.retention->lesson});
    return lessons;
}

// The mistake of a lesson's assembly, variant or tool, at its place in the plan. A file that exists and has
// mistakes keeps their places.
std::optional<Error> assembly_error(const content::StudyLesson& lesson, const std::string& place,
                                    const fs::path& folder) {
    const auto at = [&](const char* member, const Error& error) {
        return content::plan_error(folder, content::lesson_pointers(place, member), error.what,
                                   error.expected);
    };
    const fs::path where = assembly_of(lesson, folder);
    const content::LoadedAssembly plain = content::load_assembly(where);
    if (!plain.ok()) {
        const Error& error = plain.errors.front();
        if (error.line > 0) return error;
        Error missing = at("assembly", error);
        missing.what = fmt::format("{} {}", content::in_quotes(lesson.assembly), error.what);
        return missing;
    }
    const auto known = [&](const content::AssemblyVariant& v) { return v.name == lesson.variant; };
    const std::vector<content::AssemblyVariant>& variants = plain.assembly.variants;
    if (!lesson.variant.empty() && std::none_of(variants.begin(), variants.end(), known)) {
        std::vector<std::string> names;
        for (const content::AssemblyVariant& v : variants) names.push_back(v.name);
        Error error;
        error.what = fmt::format("{} has no variant {}", lesson.assembly, content::in_quotes(lesson.variant));
        error.expected = names.empty() ? "no \"variant\"" : content::suggest(lesson.variant, names);
        return at("variant", error);
    }
    content::LoadedAssembly loaded = content::load_assembly(where, lesson.variant);
    if (!loaded.ok()) return loaded.errors.front();
    if (!lesson.tool.empty())
        if (const Status chosen = content::choose_tool(loaded.assembly, lesson.tool); !chosen) {
            Error error = chosen.error();
            error.what = fmt::format("{} has no tool {}", lesson.assembly, content::in_quotes(lesson.tool));
            return at("tool", error);
        }
    const auto whole = load_lesson_assembly(lesson, folder);
    return whole ? std::nullopt : std::optional(whole.error());
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
    options.mode = lesson::mode_names.find(lesson.mode).value_or(lesson::Mode::guided);
    options.task = lesson::task_names.find(lesson.task).value_or(lesson::Task::tighten);
    options.law = joint::law_named(lesson.law).value_or(assembly_law);
    options.obstacles = session::ObstacleUse::if_any;
    options.guiding_force = lesson.guiding_force;
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

namespace {

// Adds the errors of one lesson, unless they are there already.
void add_missing(const NamedLesson& named, const fs::path& folder, const EquipmentCheck& equipment,
                 std::vector<Error>& errors) {
    const content::StudyLesson& lesson = *named.lesson;
    const auto add = [&](const char* member, const Status& usable) {
        if (usable) return;
        Error error = content::plan_error(folder, content::lesson_pointers(named.place, member),
                                          usable.error().what, usable.error().expected);
        error.code = usable.error().code;
        const auto same = [&](const Error& other) { return other.message() == error.message(); };
        if (std::none_of(errors.begin(), errors.end(), same)) errors.push_back(std::move(error));
    };
    if (equipment.devices && !lesson.devices.empty()) add("devices", equipment.devices(lesson.devices));
    if (equipment.headset && lesson.display == "headset") add("display", equipment.headset());
    if (equipment.walls && lesson.display == "walls")
        add("displays", equipment.walls(display_file_of(lesson, folder)));
    if (equipment.glove && !lesson.glove.empty() && lesson.glove != "none")
        add("glove", equipment.glove(lesson.glove));
}

}  // namespace

std::string display_file_of(const content::StudyLesson& lesson, const fs::path& study_folder) {
    std::error_code ignored;
    const fs::path own = study_folder / lesson.displays;
    return fs::exists(own, ignored) ? own.string() : lesson.displays;
}

std::vector<Error> check_equipment(const content::Study& study, const fs::path& folder,
                                   const EquipmentCheck& equipment) {
    std::vector<Error> errors;
    for (const NamedLesson& lesson : lessons_of(study)) add_missing(lesson, folder, equipment, errors);
    return errors;
}

std::vector<Error> check_equipment(const content::Study& study, const fs::path& folder,
                                   std::span<const Step> steps, const EquipmentCheck& equipment) {
    std::vector<Error> errors;
    for (const Step& step : steps) {
        if (step.kind == StudyStepKind::training)
            add_missing({{}, "/training", &study.training->lesson}, folder, equipment, errors);
        if (step.kind == StudyStepKind::retention)
            add_missing({{}, "/retention", &study.retention->lesson}, folder, equipment, errors);
        if (step.kind == StudyStepKind::lesson)
            add_missing(
                {{}, fmt::format("/conditions/{}", step.condition), &study.conditions[step.condition].lesson},
                folder, equipment, errors);
    }
    return errors;
}

StudyCheck check_study(const content::Study& study, const fs::path& folder, const EquipmentCheck& equipment) {
    StudyCheck check;
    std::set<std::string> reported;
    for (const NamedLesson& lesson : lessons_of(study)) {
        std::optional<Error> error = assembly_error(*lesson.lesson, lesson.place, folder);
        if (!error || !reported.insert(error->message()).second) continue;
        error->what = fmt::format("{} (lesson of the {})", error->what, lesson.name);
        check.errors.push_back(std::move(*error));
    }
    for (Error& error : check_equipment(study, folder, equipment)) check.errors.push_back(std::move(error));
    check_texts(study, folder, check);
    for (const Error& weakness : content::plan_weaknesses(study, folder))
        check.weaknesses.push_back(weakness.message());
    check_design(study, check);
    return check;
}

}  // namespace bolt::study
