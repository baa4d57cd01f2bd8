#include "game/study/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <set>

namespace bolt::study {

namespace {

constexpr double day = 86400.0;  // s

void add_forms(const content::Study& study, content::FormTime time, const std::string& prefix,
               const Step& like, std::vector<Step>& steps) {
    for (std::size_t i = 0; i < study.forms.size(); ++i) {
        if (!study.forms[i].is_at(time)) continue;
        Step step = like;
        step.kind = StudyStepKind::form;
        step.form = i;
        step.id = prefix + study.forms[i].id;
        steps.push_back(std::move(step));
    }
}

void add_condition(const content::Study& study, std::size_t part, std::size_t condition,
                   std::vector<Step>& steps) {
    const std::string prefix = fmt::format("part-{}/", part + 1);
    Step step{StudyStepKind::lesson, {}, no_index, part, condition, 0};
    for (std::size_t lesson = 0; lesson < study.design.lessons; ++lesson) {
        step.lesson = lesson;
        step.id = fmt::format("{}lesson-{}", prefix, lesson + 1);
        steps.push_back(step);
        add_forms(study, content::FormTime::after_lesson, step.id + "/", step, steps);
    }
    step.lesson = no_index;
    add_forms(study, content::FormTime::after_condition, prefix, step, steps);
}

}  // namespace

bool is_lesson(StudyStepKind kind) {
    return kind == StudyStepKind::lesson || kind == StudyStepKind::training ||
           kind == StudyStepKind::retention;
}

std::vector<Step> steps_of(const content::Study& study, const std::vector<std::size_t>& conditions) {
    using content::FormTime;
    std::vector<Step> steps{{StudyStepKind::language, "language"},
                            {StudyStepKind::information, "information"},
                            {StudyStepKind::consent, "consent"}};
    add_forms(study, FormTime::before, "before/", {}, steps);
    if (study.training) {
        steps.push_back({StudyStepKind::training, "training"});
        add_forms(study, FormTime::after_training, "training/", {}, steps);
    }
    for (std::size_t part = 0; part < conditions.size(); ++part) {
        if (part > 0) steps.push_back({StudyStepKind::pause, fmt::format("break-{}", part), no_index, part});
        add_condition(study, part, conditions[part], steps);
    }
    add_forms(study, FormTime::after, "after/", {}, steps);
    steps.push_back({StudyStepKind::comment, "comment"});
    if (study.retention) {
        steps.push_back({StudyStepKind::end_of_visit, "end-of-visit"});
        steps.push_back({StudyStepKind::retention, "retention"});
        add_forms(study, FormTime::retention, "retention/", {}, steps);
    }
    steps.push_back({StudyStepKind::farewell, "farewell"});
    return steps;
}

Progress progress_of(std::span<const JournalEntry> entries, bool simulated) {
    Progress progress;
    progress.simulated = simulated;
    if (!entries.empty()) progress.begun = entries.front().time;
    std::set<std::string> open_lessons, interrupted;  // steps
    const auto interrupt = [&](const std::string& step, std::vector<std::string>& outcome) {
        if (interrupted.insert(step).second) ++progress.interrupted_lessons;
        outcome.push_back(step);
    };
    bool training_begun = false;  // a lesson of the training, whose measures follow
    for (const JournalEntry& entry : entries) {
        progress.latest = entry.time;
        switch (entry.kind) {
            case JournalKind::enrolled:
                progress.person = entry.text;
                progress.place = static_cast<std::size_t>(entry.value.value_or(0.0));
                progress.checksum = std::strtoull(entry.item.c_str(), nullptr, 16);
                break;
            case JournalKind::assigned:
                progress.conditions.push_back(entry.item);
                break;
            case JournalKind::plan_changed:
                ++progress.plan_changes;
                progress.checksum = std::strtoull(entry.item.c_str(), nullptr, 16);
                break;
            case JournalKind::language:
                progress.language = entry.text;
                break;
            case JournalKind::answered:
                progress.answers[entry.step][entry.item] = entry.value;
                break;
            case JournalKind::agreed:
                if (entry.value == 0.0)
                    progress.answers[entry.step].erase(entry.item);
                else
                    progress.answers[entry.step][entry.item] = 1.0;
                break;
            case JournalKind::commented:
                progress.comment = entry.text;
                break;
            case JournalKind::lesson_begun:
                if (!open_lessons.insert(entry.step).second) interrupt(entry.step, progress.begun_again);
                progress.lesson_folders[entry.step] = entry.text;
                training_begun = training_begun || entry.step == "training";
                break;
            case JournalKind::lesson_continued:
                interrupt(entry.step, progress.continued);
                progress.lesson_folders[entry.step] = entry.text;
                break;
            case JournalKind::measured:
                open_lessons.erase(entry.step);
                interrupted.erase(entry.step);
                if (entry.value) progress.measures[entry.step][entry.item] = *entry.value;
                if (entry.step == "training" && entry.value) {
                    if (training_begun || progress.training_lessons.empty())
                        progress.training_lessons.emplace_back();
                    training_begun = false;
                    progress.training_lessons.back()[entry.item] = *entry.value;
                }
                if (entry.step == "training" && entry.item == "duration_s")
                    progress.training_seconds += entry.value.value_or(0.0);
                break;
            case JournalKind::step_done:
                progress.done.emplace(entry.step, entry.time);
                break;
            case JournalKind::clock_set_back:
                progress.clock_set_back += entry.value.value_or(0.0);
                // A recorded time later than this one is wrong: a waiting time that began then begins now.
                for (auto& [step, time] : progress.done) time = std::min(time, entry.time);
                break;
        }
    }
    return progress;
}

std::size_t due_step(const std::vector<Step>& steps, const Progress& progress) {
    return static_cast<std::size_t>(
        std::find_if(steps.begin(), steps.end(),
                     [&](const Step& step) { return !progress.done.contains(step.id); }) -
        steps.begin());
}

Result<std::vector<std::size_t>> assigned_conditions(const content::Study& study, const Progress& progress) {
    std::vector<std::size_t> conditions;
    for (const std::string& id : progress.conditions) {
        const auto found = std::find_if(study.conditions.begin(), study.conditions.end(),
                                        [&](const content::StudyCondition& c) { return c.id == id; });
        if (found == study.conditions.end())
            return fail(
                ErrorCode::bad_content,
                fmt::format("the plan does not have condition \"{}\", which a participant was given", id),
                "a plan with this condition");
        conditions.push_back(static_cast<std::size_t>(found - study.conditions.begin()));
    }
    return conditions;
}

std::optional<std::int64_t> retention_due(const content::Study& study, const Progress& progress) {
    const auto visit = progress.done.find("end-of-visit");
    if (!study.retention || visit == progress.done.end()) return std::nullopt;
    const double days = study.retention->after_days;
    if (days < 1.0) return visit->second + static_cast<std::int64_t>(days * day);
    const auto end = static_cast<std::time_t>(visit->second);
    std::tm date{};
    localtime_r(&end, &date);
    date.tm_mday += static_cast<int>(std::floor(days));
    date.tm_hour = date.tm_min = date.tm_sec = 0;
    date.tm_isdst = -1;
    return mktime(&date);
}

}  // namespace bolt::study
