// The planned comparisons of a study, and the published values that its page prints.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "content/studies/study_reader.hpp"

namespace bolt::content {

namespace {

// Reports a measure that no lesson and no form of the study gives.
std::string read_measure(StudyReader& reader, const JsonNode& object, const std::vector<FormTime>& required) {
    const JsonNode node = reader.json.member(object, "measure");
    std::string measure = reader.json.text(node).value_or("");
    if (!node) return measure;
    std::vector<std::string> known;
    if (required.size() < 2) known.assign(std::begin(objective_measures), std::end(objective_measures));
    const std::size_t dot = measure.find('.');
    for (const StudyForm& form : reader.study.forms) {
        const bool of_form = dot != std::string::npos && measure.substr(0, dot) == form.id;
        const bool in_conditions =
            form.is_at(FormTime::after_lesson) || form.is_at(FormTime::after_condition) ||
            (reader.study.design.subjects == StudySubjects::between && form.is_at(FormTime::after));
        if (of_form && required.empty() && !in_conditions)
            reader.json.report(
                node.pointer, fmt::format("form {} is not presented in the conditions", in_quotes(form.id)),
                form.is_at(FormTime::before)
                    ? R"("times" for a comparison of two times, or "after_lesson" or "after_condition" among its times)"
                    : R"("after_lesson" or "after_condition" among its times)");
        for (const FormTime time : required)
            if (of_form && !form.is_at(time))
                reader.json.report(
                    node.pointer,
                    fmt::format("form {} is not presented {}", in_quotes(form.id),
                                time == FormTime::retention ? "after the retention test"
                                                            : "at the time " + in_quotes(name(time))),
                    fmt::format("{} among its times", in_quotes(name(time))));
        if (reader.questionnaires == nullptr) {
            if (of_form) return measure;
            continue;
        }
        for (const Questionnaire& questionnaire : *reader.questionnaires)
            if (questionnaire.id == form.id)
                for (const QuestionnaireScale& scale : questionnaire.scales)
                    known.push_back(form.id + "." + scale.id);
    }
    if (std::find(known.begin(), known.end(), measure) == known.end())
        reader.json.report(node.pointer,
                           fmt::format("there is no measure {}{}", in_quotes(measure),
                                       required.size() < 2 ? "" : " of a form"),
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

// Reports each pair of a level of the factor and a level of the interaction that no condition has.
void check_cells(StudyReader& reader, const JsonNode& node, const PlannedComparison& comparison) {
    for (const ComparedGroup& a : comparison.groups)
        for (const ComparedGroup& b : comparison.interaction_groups)
            if (conditions_in_both(a, b).empty())
                reader.json.report(node.pointer,
                                   fmt::format("no condition has the levels {} of {} and {} of {}",
                                               in_quotes(a.name), in_quotes(comparison.factor),
                                               in_quotes(b.name), in_quotes(comparison.interaction)),
                                   "a condition for each pair of levels");
}

void read_interaction(StudyReader& reader, const JsonNode& object, PlannedComparison& comparison) {
    JsonReader& json = reader.json;
    const JsonNode node = json.member(object, "interaction");
    if (!node) return;
    comparison.interaction = json.text(node).value_or("");
    comparison.interaction_groups = groups_of_factor(reader, node);
    if (comparison.factor.empty())
        return json.report(node.pointer, "the interaction has only one factor", "\"factor\" too");
    if (comparison.factor == comparison.interaction)
        return json.report(node.pointer, "a factor has no interaction with itself", "another factor");
    if (reader.study.design.subjects == StudySubjects::between)
        return json.report(node.pointer, "the interaction is tested within participants only",
                           R"("subjects": "within", or no such member)");
    for (const auto& [name, groups] : {std::pair(comparison.factor, &comparison.groups),
                                       std::pair(comparison.interaction, &comparison.interaction_groups)})
        if (groups->size() > 2)
            return json.report(node.pointer, fmt::format("{} has {} levels", in_quotes(name), groups->size()),
                               "two levels of each factor of an interaction");
    if (comparison.groups.size() == 2 && comparison.interaction_groups.size() == 2)
        check_cells(reader, node, comparison);
}

// The two times of "times"; empty without it.
std::vector<FormTime> read_times(StudyReader& reader, const JsonNode& object, PlannedComparison& comparison) {
    JsonReader& json = reader.json;
    const JsonNode list = json.member(object, "times");
    std::vector<FormTime> times;
    for (const JsonNode& node : json.items(list)) {
        const std::string text = json.text(node).value_or("");
        for (std::size_t i = 0; i < form_times; ++i)
            if (const auto time = static_cast<FormTime>(i); name(time) == text) {
                if (!times.empty() && times.front() == time)
                    json.report(node.pointer, fmt::format("{} is listed twice", in_quotes(text)),
                                "two times");
                times.push_back(time);
                comparison.groups.push_back({text, {}});
            }
    }
    if (!list) return times;
    for (const char* key : {"factor", "conditions", "interaction", "retention"})
        if (const JsonNode other = json.member(object, key))
            json.report(other.pointer, fmt::format("both \"times\" and \"{}\" are given", key), "one of them",
                        JsonPart::key);
    return times;
}

std::vector<FormTime> required_times(const PlannedComparison& comparison) {
    if (!comparison.times.empty()) return comparison.times;
    return comparison.retention ? std::vector{FormTime::retention} : std::vector<FormTime>{};
}

void read_groups(StudyReader& reader, const JsonNode& node, PlannedComparison& comparison) {
    JsonReader& json = reader.json;
    const JsonNode factor = json.member(node, "factor"), conditions = json.member(node, "conditions");
    if (factor && conditions)
        json.report(node.pointer, "both \"factor\" and \"conditions\" are given", "one of them");
    comparison.factor = json.text(factor).value_or("");
    comparison.groups = factor ? groups_of_factor(reader, factor) : groups_of_conditions(reader, conditions);
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
    read_interaction(reader, node, comparison);
}

}  // namespace

void read_comparisons(StudyReader& reader) {
    JsonReader& json = reader.json;
    for (const JsonNode& node : json.items(json.member(json.root(), "comparisons"))) {
        PlannedComparison comparison;
        comparison.retention = boolean(json, node, "retention", false);
        if (comparison.retention && !reader.study.retention)
            json.report(node.pointer + "/retention", "the study has no retention test",
                        "no such member, or \"retention\" in the study");
        comparison.times = read_times(reader, node, comparison);
        comparison.measure = read_measure(reader, node, required_times(comparison));
        if (comparison.times.empty()) read_groups(reader, node, comparison);
        reader.study.comparisons.push_back(std::move(comparison));
    }
}

namespace {

// Reports a value that the measure's scale does not have.
void check_published_range(StudyReader& reader, const JsonNode& object, const PublishedValue& value) {
    JsonReader& json = reader.json;
    const JsonNode mean = json.member(object, "mean");
    const double rounding = 0.5 * std::pow(10.0, -value.decimals) * (1.0 + 1e-9);
    if (value.min && value.max && *value.min > *value.max)
        return json.report(
            object.pointer + "/max",
            fmt::format("the maximum {:g} is less than the minimum {:g}", *value.max, *value.min),
            "the maximum as printed");
    if ((value.min && value.mean < *value.min - rounding) ||
        (value.max && value.mean > *value.max + rounding))
        return json.report(mean.pointer,
                           fmt::format("the mean {:g} is not between minimum and maximum", value.mean),
                           "the mean as printed");
    if (reader.questionnaires == nullptr) return;
    for (const Questionnaire& form : *reader.questionnaires)
        for (const QuestionnaireScale& scale : form.scales) {
            const auto range = score_range(form, scale);
            if (form.id + "." + scale.id != value.measure || !range) continue;
            const std::string expected =
                fmt::format("{:g} to {:g}, the scale of the form", range->low, range->high);
            for (const auto& [key, number] : {std::pair("min", value.min), std::pair("max", value.max),
                                              std::pair("mean", std::optional(value.mean))})
                if (number && (*number < range->low - rounding || *number > range->high + rounding))
                    return json.report(object.pointer + "/" + key,
                                       fmt::format("{:g} is not on the scale", *number), expected);
        }
}

}  // namespace

void read_published(StudyReader& reader) {
    JsonReader& json = reader.json;
    for (const JsonNode& node : json.items(json.member(json.root(), "published"))) {
        PublishedValue value;
        value.measure = read_measure(reader, node, {});
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
        else if (mean)
            check_published_range(reader, node, value);
        reader.study.published.push_back(std::move(value));
    }
}

}  // namespace bolt::content
