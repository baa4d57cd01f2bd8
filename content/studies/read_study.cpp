#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "content/format/embedded.hpp"
#include "content/format/reader.hpp"
#include "content/studies/study.hpp"
#include "engine/base/file.hpp"
#include "engine/base/hash.hpp"

namespace bolt::content {

namespace {

constexpr std::size_t max_study_size = 1U << 20U;  // bytes
constexpr std::string_view form_time_names[form_times] = {"before",          "after_training", "after_lesson",
                                                          "after_condition", "after",          "retention"};

// A study while it is read.
struct StudyReader {
    JsonReader json;
    const std::vector<Questionnaire>* questionnaires;  // null: unknown
    Study study;
    std::vector<std::string> condition_ids;
    bool conditions_valid = false;  // false: an unknown condition may be the consequence of a mistake
};

std::string id_of(JsonReader& json, const JsonNode& object) {
    const JsonNode node = json.member(object, "id");
    std::string id = json.text(node).value_or("");
    const auto allowed = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
               c == '_';
    };
    if (!std::all_of(id.begin(), id.end(), allowed))
        json.report(node.pointer, fmt::format("the id {} has characters that are not allowed", in_quotes(id)),
                    "letters a to z and A to Z, digits, - and _");
    return id;
}

// A whole number, which the schema has checked.
std::size_t whole(JsonReader& json, const JsonNode& object, const char* key, std::size_t fallback) {
    const std::optional<double> number = json.number(json.member(object, key));
    return number ? static_cast<std::size_t>(*number) : fallback;
}

bool boolean(JsonReader& json, const JsonNode& object, const char* key, bool fallback) {
    return json.boolean(json.member(object, key)).value_or(fallback);
}

// The settings of `own`, and those of `base` for members that it does not have.
StudyLesson read_lesson(JsonReader& json, const JsonNode& own, const StudyLesson& base) {
    StudyLesson lesson = base;
    for (const auto& [key, text] :
         {std::pair("assembly", &lesson.assembly), std::pair("variant", &lesson.variant),
          std::pair("tool", &lesson.tool), std::pair("mode", &lesson.mode), std::pair("task", &lesson.task),
          std::pair("law", &lesson.law), std::pair("hand", &lesson.hand)})
        if (auto given = json.text(json.member(own, key))) *text = std::move(*given);
    if (const JsonNode devices = json.member(own, "devices")) {
        lesson.devices.clear();
        for (const JsonNode& device : json.items(devices))
            lesson.devices.push_back(json.text(device).value_or(""));
    }
    lesson.guide = boolean(json, own, "guide", lesson.guide);
    lesson.view_help = boolean(json, own, "view_help", lesson.view_help);
    if (const auto scale = json.number(json.member(own, "force_scale"))) lesson.force_scale = scale;
    const JsonNode guide = json.member(own, "guide");
    if (guide && lesson.guide && lesson.mode != "guided")
        json.report(guide.pointer, fmt::format("there is no guiding force in mode {}", lesson.mode),
                    R"("mode": "guided" with it)");
    return lesson;
}

void read_design(StudyReader& reader) {
    JsonReader& json = reader.json;
    const JsonNode node = json.member(json.root(), "design");
    StudyDesign& design = reader.study.design;
    if (json.text(json.member(node, "subjects")) == "between") design.subjects = StudySubjects::between;
    const JsonNode order = json.member(node, "order");
    if (json.text(order) == "random") design.order = StudyOrder::random;
    if (order && design.subjects == StudySubjects::between)
        json.report(order.pointer, "each participant gets one condition between subjects, so it has no order",
                    "no such member", JsonPart::key);
    design.participants = whole(json, node, "participants", 1);
    design.lessons = whole(json, node, "lessons", 1);
    design.seed = whole(json, node, "seed", 1);
    design.blind = boolean(json, node, "blind", false);
    design.shortest_break = 60.0 * json.number(json.member(node, "break_minutes")).value_or(0.0);
    design.show_results = boolean(json, node, "show_results", false);
}

// Reports a condition that repeats an earlier one, or whose factors differ from those of the first one.
void check_condition(StudyReader& reader, const JsonNode& node) {
    const std::vector<StudyCondition>& all = reader.study.conditions;
    const StudyCondition& last = all.back();
    for (std::size_t i = 0; i + 1 < all.size(); ++i) {
        if (last.id == all[i].id && !last.id.empty())
            reader.json.report(node.pointer + "/id",
                               fmt::format("there is another condition {}", in_quotes(last.id)),
                               "an id of its own");
        else if (last.lesson == all[i].lesson)
            reader.json.report(node.pointer,
                               fmt::format("the lessons are those of condition {}", in_quotes(all[i].id)),
                               "a setting that differs", JsonPart::value);
    }
    const auto factors = [](const StudyCondition& condition) {
        std::vector<std::string> names;
        for (const auto& [factor, level] : condition.levels) names.push_back(factor);
        return names;
    };
    if (factors(last) != factors(all.front()))
        reader.json.report(
            node.pointer, fmt::format("the factors are not those of condition {}", in_quotes(all.front().id)),
            "a level of the same factors in every condition");
}

void read_conditions(StudyReader& reader, const StudyLesson& base) {
    JsonReader& json = reader.json;
    const JsonNode list = json.member(json.root(), "conditions");
    reader.conditions_valid = json.is_valid(list.pointer);
    for (const JsonNode& node : json.items(list)) {
        StudyCondition condition;
        condition.id = id_of(json, node);
        condition.titles = json.texts(json.member(node, "title"));
        condition.lesson = read_lesson(json, json.member(node, "lesson"), base);
        condition.levels = json.texts(json.member(node, "levels"));
        reader.condition_ids.push_back(condition.id);
        reader.study.conditions.push_back(std::move(condition));
        check_condition(reader, node);
    }
}

void read_forms(StudyReader& reader) {
    JsonReader& json = reader.json;
    for (const JsonNode& node : json.items(json.member(json.root(), "forms"))) {
        StudyForm form;
        const JsonNode id = json.member(node, "form");
        form.id = json.text(id).value_or("");
        for (const StudyForm& other : reader.study.forms)
            if (other.id == form.id)
                json.report(id.pointer, fmt::format("form {} is listed twice", in_quotes(form.id)),
                            "each form once, with all its times in \"when\"");
        for (const JsonNode& when : json.items(json.member(node, "when"))) {
            const std::string text = json.text(when).value_or("");
            const auto* found = std::find(std::begin(form_time_names), std::end(form_time_names), text);
            if (found == std::end(form_time_names)) continue;  // the schema has reported it
            const auto time = static_cast<FormTime>(found - form_time_names);
            if (time == FormTime::after_training && !reader.study.training)
                json.report(when.pointer, "the study has no training", "another time, or \"training\"");
            if (time == FormTime::retention && !reader.study.retention)
                json.report(when.pointer, "the study has no retention test",
                            "another time, or \"retention\"");
            form.at[static_cast<std::size_t>(time)] = true;
        }
        reader.study.forms.push_back(std::move(form));
    }
}

// Reports a measure that no lesson and no form of the study gives.
std::string read_measure(StudyReader& reader, const JsonNode& object, std::optional<FormTime> required) {
    const JsonNode node = reader.json.member(object, "measure");
    std::string measure = reader.json.text(node).value_or("");
    if (!node) return measure;
    std::vector<std::string> known(std::begin(objective_measures), std::end(objective_measures));
    const std::size_t dot = measure.find('.');
    for (const StudyForm& form : reader.study.forms) {
        const bool has_time =
            required
                ? form.is_at(*required)
                : form.is_at(FormTime::after_lesson) || form.is_at(FormTime::after_condition) ||
                      (reader.study.design.subjects == StudySubjects::between && form.is_at(FormTime::after));
        if (dot != std::string::npos && measure.substr(0, dot) == form.id && !has_time)
            reader.json.report(node.pointer,
                               fmt::format("form {} is not presented {}", in_quotes(form.id),
                                           required ? "after the retention test" : "in the conditions"),
                               required ? R"("retention" among its times)"
                                        : R"("after_lesson" or "after_condition" among its times)");
        if (reader.questionnaires == nullptr) {
            if (dot != std::string::npos && measure.substr(0, dot) == form.id) return measure;
            continue;
        }
        for (const Questionnaire& questionnaire : *reader.questionnaires)
            if (questionnaire.id == form.id)
                for (const QuestionnaireScale& scale : questionnaire.scales)
                    known.push_back(form.id + "." + scale.id);
    }
    if (std::find(known.begin(), known.end(), measure) == known.end())
        reader.json.report(node.pointer, fmt::format("there is no measure {}", in_quotes(measure)),
                           suggest(measure, known));
    return measure;
}

std::vector<ComparedGroup> groups_of_factor(StudyReader& reader, const JsonNode& node) {
    const std::string factor = reader.json.text(node).value_or("");
    std::vector<ComparedGroup> groups;
    const std::vector<StudyCondition>& conditions = reader.study.conditions;
    for (std::size_t i = 0; i < conditions.size(); ++i) {
        const auto level = conditions[i].levels.find(factor);
        if (level == conditions[i].levels.end()) continue;
        const auto same = std::find_if(groups.begin(), groups.end(),
                                       [&](const ComparedGroup& g) { return g.name == level->second; });
        if (same == groups.end())
            groups.push_back({level->second, {i}});
        else
            same->conditions.push_back(i);
    }
    std::vector<std::string> known;
    if (!conditions.empty())
        for (const auto& [name, level] : conditions.front().levels) known.push_back(name);
    if (groups.empty() && reader.conditions_valid)
        reader.json.report(node.pointer, fmt::format("there is no factor {}", in_quotes(factor)),
                           known.empty() ? "\"levels\" in the conditions" : suggest(factor, known));
    else if (groups.size() == 1)
        reader.json.report(node.pointer,
                           fmt::format("all conditions have the same level of {}", in_quotes(factor)),
                           "a factor with two or more levels");
    return groups;
}

std::vector<ComparedGroup> groups_of_conditions(StudyReader& reader, const JsonNode& list) {
    std::vector<ComparedGroup> groups;
    if (!list) {
        for (std::size_t i = 0; i < reader.condition_ids.size(); ++i)
            groups.push_back({reader.condition_ids[i], {i}});
        return groups;
    }
    for (const JsonNode& node : reader.json.items(list)) {
        const std::string id = reader.json.text(node).value_or("");
        const auto found = std::find(reader.condition_ids.begin(), reader.condition_ids.end(), id);
        if (found == reader.condition_ids.end()) {
            if (reader.conditions_valid)
                reader.json.report(node.pointer, fmt::format("there is no condition {}", in_quotes(id)),
                                   suggest(id, reader.condition_ids));
            continue;
        }
        if (std::any_of(groups.begin(), groups.end(), [&](const auto& g) { return g.name == id; }))
            reader.json.report(node.pointer, fmt::format("{} is listed twice", in_quotes(id)),
                               "each condition once");
        groups.push_back({id, {static_cast<std::size_t>(found - reader.condition_ids.begin())}});
    }
    return groups;
}

void read_comparisons(StudyReader& reader) {
    JsonReader& json = reader.json;
    for (const JsonNode& node : json.items(json.member(json.root(), "comparisons"))) {
        PlannedComparison comparison;
        comparison.retention = boolean(json, node, "retention", false);
        if (comparison.retention && !reader.study.retention)
            json.report(node.pointer + "/retention", "the study has no retention test",
                        "no such member, or \"retention\" in the study");
        comparison.measure = read_measure(
            reader, node, comparison.retention ? std::optional(FormTime::retention) : std::nullopt);
        const JsonNode factor = json.member(node, "factor"), conditions = json.member(node, "conditions");
        if (factor && conditions)
            json.report(node.pointer, "both \"factor\" and \"conditions\" are given", "one of them");
        comparison.factor = json.text(factor).value_or("");
        comparison.groups =
            factor ? groups_of_factor(reader, factor) : groups_of_conditions(reader, conditions);
        const bool between = reader.study.design.subjects == StudySubjects::between;
        if (between && comparison.groups.size() > 2)
            json.report(node.pointer,
                        fmt::format("{} groups of different people are compared", comparison.groups.size()),
                        "two of them in each comparison, in \"conditions\"");
        if (comparison.retention && !between)
            json.report(node.pointer + "/retention",
                        "the retention test cannot compare conditions: each participant had all of them",
                        R"("subjects": "between")");
        if (comparison.groups.size() < 2 && reader.conditions_valid && !factor && !conditions)
            json.report(node.pointer, "one condition cannot be compared", "two or more conditions");
        reader.study.comparisons.push_back(std::move(comparison));
    }
}

void read_published(StudyReader& reader) {
    JsonReader& json = reader.json;
    for (const JsonNode& node : json.items(json.member(json.root(), "published"))) {
        PublishedValue value;
        value.measure = read_measure(reader, node, std::nullopt);
        value.min = json.number(json.member(node, "min"));
        value.max = json.number(json.member(node, "max"));
        value.n = whole(json, node, "n", 1);
        value.source = json.text(json.member(node, "source")).value_or("");
        const JsonNode mean = json.member(node, "mean");
        const std::string text = json.text(mean).value_or("0");
        char* end = nullptr;
        value.mean = std::strtod(text.c_str(), &end);
        const std::size_t dot = text.find('.');
        value.decimals = dot == std::string::npos ? 0 : static_cast<int>(text.size() - dot - 1);
        if (mean && (*end != '\0' || text.find_first_not_of("-0123456789.") != std::string::npos))
            json.report(mean.pointer, fmt::format("{} is no number", in_quotes(text)),
                        "a decimal number as printed, such as \"8.263\"");
        reader.study.published.push_back(std::move(value));
    }
}

void read_members(StudyReader& reader) {
    JsonReader& json = reader.json;
    const JsonNode root = json.root();
    Study& study = reader.study;
    study.id = id_of(json, root);
    study.titles = json.texts(json.member(root, "title"));
    study.information = json.texts(json.member(root, "information"));
    for (const JsonNode& statements : json.items(json.member(root, "consent")))
        for (const JsonNode& statement : json.items(statements))
            study.consent[last_token(statements.pointer)].push_back(json.text(statement).value_or(""));
    read_design(reader);
    const StudyLesson base = read_lesson(json, json.member(root, "lesson"), {});
    if (const JsonNode training = json.member(root, "training"))
        study.training = {60.0 * json.number(json.member(training, "minutes")).value_or(0.0),
                          read_lesson(json, json.member(training, "lesson"), base)};
    if (const JsonNode retention = json.member(root, "retention"))
        study.retention = {json.number(json.member(retention, "after_days")).value_or(0.0),
                           read_lesson(json, json.member(retention, "lesson"), base)};
    read_conditions(reader, base);
    read_forms(reader);
    read_comparisons(reader);
    read_published(reader);
}

const JsonSchema& study_schema() {
    static const JsonSchema schema(study_schema_text());
    return schema;
}

// Reads the forms that the study names, in its order. A form that cannot be read is a mistake of the study.
std::vector<Questionnaire> load_forms(const std::filesystem::path& folder, const Study& study, Fnv1a& hash,
                                      std::vector<Error>& errors) {
    std::vector<Questionnaire> forms;
    for (const StudyForm& form : study.forms) {
        const std::filesystem::path file = folder / (form.id + ".json");
        const Result<std::string> text = read_file(file, max_study_size, ErrorCode::bad_content);
        if (!text) {
            errors.push_back(text.error());
            continue;
        }
        hash.add(*text);
        LoadedQuestionnaire loaded = parse_questionnaire(*text, file.string());
        errors.insert(errors.end(), loaded.errors.begin(), loaded.errors.end());
        if (loaded.ok() && loaded.questionnaire.id != form.id) {
            Error error;
            error.code = ErrorCode::bad_content;
            error.file = file.string();
            error.what = fmt::format("the id is {}", in_quotes(loaded.questionnaire.id));
            error.expected = fmt::format("{}, as the file is named", in_quotes(form.id));
            errors.push_back(std::move(error));
        }
        forms.push_back(std::move(loaded.questionnaire));
    }
    return forms;
}

}  // namespace

std::string_view name(FormTime time) { return form_time_names[static_cast<std::size_t>(time)]; }

const Questionnaire* Study::form_of(std::string_view measure) const {
    for (const Questionnaire& questionnaire : questionnaires)
        if (measure.starts_with(questionnaire.id + ".")) return &questionnaire;
    return nullptr;
}

LoadedStudy parse_study(std::string_view text, const std::string& file,
                        const std::vector<Questionnaire>* forms) {
    LoadedStudy loaded;
    const auto document = JsonDocument::parse(text, file, loaded.errors);
    if (!document) return loaded;
    StudyReader reader{JsonReader(*document, study_schema()), forms, {}, {}, false};
    read_members(reader);
    loaded.study = std::move(reader.study);
    for (Error& error : reader.json.take_errors()) loaded.errors.push_back(std::move(error));
    sort_by_position(loaded.errors);
    return loaded;
}

LoadedStudy load_study(const std::filesystem::path& folder, const std::filesystem::path& forms_folder) {
    LoadedStudy loaded;
    const std::string file = (folder / study_file_name).string();
    const Result<std::string> text = read_file(file, max_study_size, ErrorCode::bad_content);
    if (!text) {
        loaded.errors.push_back(text.error());
        return loaded;
    }
    Fnv1a hash;
    hash.add(*text);
    std::vector<Error> form_errors;
    // The first reading finds the names of the forms, whose scales the second one checks.
    const std::vector<Questionnaire> forms =
        load_forms(forms_folder.empty() ? folder / forms_folder_name : forms_folder,
                   parse_study(*text, file).study, hash, form_errors);
    loaded = parse_study(*text, file, form_errors.empty() ? &forms : nullptr);
    loaded.errors.insert(loaded.errors.end(), form_errors.begin(), form_errors.end());
    loaded.study.questionnaires = forms;
    loaded.study.checksum = hash.value();
    return loaded;
}

namespace {

bool has_texts(const Questionnaire& form, const std::string& language) {
    if (!missing_texts(form, language).empty()) return false;
    const auto has = [&](const AnswerLabels& labels) { return labels.empty() || labels.contains(language); };
    return has(form.answer_scale.labels) &&
           std::all_of(form.items.begin(), form.items.end(),
                       [&](const QuestionnaireItem& item) { return has(item.labels); });
}

}  // namespace

std::vector<std::string> complete_languages(const Study& study) {
    std::size_t statements = 0;
    for (const auto& [language, texts] : study.consent) statements = std::max(statements, texts.size());
    std::vector<std::string> languages;
    for (const auto& title : study.titles) {
        const std::string& language = title.first;
        const auto consent = study.consent.find(language);
        const bool reads = study.information.contains(language) && consent != study.consent.end() &&
                           consent->second.size() == statements;
        const bool forms = std::all_of(study.questionnaires.begin(), study.questionnaires.end(),
                                       [&](const Questionnaire& form) { return has_texts(form, language); });
        if (reads && forms) languages.push_back(language);
    }
    return languages;
}

}  // namespace bolt::content
