#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "content/format/embedded.hpp"
#include "content/studies/study_reader.hpp"
#include "engine/base/file.hpp"
#include "engine/base/hash.hpp"

namespace bolt::content {

namespace {

constexpr std::size_t max_study_size = 1U << 20U;  // bytes
constexpr std::string_view form_time_names[form_times] = {"before",          "after_training", "after_lesson",
                                                          "after_condition", "after",          "retention"};

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

// The settings of `own`, and those of `base` for members that it does not have.
StudyLesson read_lesson(JsonReader& json, const JsonNode& own, const StudyLesson& base) {
    StudyLesson lesson = base;
    for (const auto& [key, text] :
         {std::pair("assembly", &lesson.assembly), std::pair("variant", &lesson.variant),
          std::pair("tool", &lesson.tool), std::pair("mode", &lesson.mode), std::pair("task", &lesson.task),
          std::pair("law", &lesson.law), std::pair("hand", &lesson.hand),
          std::pair("display", &lesson.display), std::pair("displays", &lesson.displays),
          std::pair("glove", &lesson.glove)})
        if (auto given = json.text(json.member(own, key))) *text = std::move(*given);
    if (const JsonNode devices = json.member(own, "devices")) {
        lesson.devices.clear();
        for (const JsonNode& device : json.items(devices))
            lesson.devices.push_back(json.text(device).value_or(""));
    }
    lesson.guiding_force = boolean(json, own, "guide", lesson.guiding_force);
    lesson.view_help = boolean(json, own, "view_help", lesson.view_help);
    if (const auto scale = json.number(json.member(own, "force_scale"))) lesson.force_scale = scale;
    const JsonNode guide = json.member(own, "guide");
    if (guide && lesson.guiding_force && lesson.mode != "guided")
        json.report(guide.pointer, fmt::format("there is no guiding force in mode {}", lesson.mode),
                    R"("mode": "guided" with it)");
    return lesson;
}

// Reads and checks the member "lesson" of `object`. Settings that it lacks are those of `base`.
StudyLesson read_whole_lesson(JsonReader& json, const JsonNode& object, const StudyLesson& base) {
    const JsonNode own = json.member(object, "lesson");
    StudyLesson lesson = read_lesson(json, own, base);
    check_lesson(json, own, lesson);
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
        condition.lesson = read_whole_lesson(json, node, base);
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
                          read_whole_lesson(json, training, base)};
    if (const JsonNode retention = json.member(root, "retention"))
        study.retention = {json.number(json.member(retention, "after_days")).value_or(0.0),
                           read_whole_lesson(json, retention, base)};
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
