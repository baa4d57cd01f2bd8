#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "content/format/json_document.hpp"
#include "content/studies/study.hpp"
#include "engine/base/file.hpp"

namespace bolt::content {

namespace {

constexpr std::size_t max_plan_size = 1U << 20U;  // bytes

// True if the levels of one factor determine those of the other one in all conditions.
bool change_together(const Study& study, const std::string& a, const std::string& b) {
    std::map<std::string, std::string> of_a, of_b;
    for (const StudyCondition& condition : study.conditions) {
        const std::string &level_a = condition.levels.at(a), &level_b = condition.levels.at(b);
        if (of_a.try_emplace(level_a, level_b).first->second != level_b) return false;
        if (of_b.try_emplace(level_b, level_a).first->second != level_a) return false;
    }
    return of_a.size() > 1;
}

void check_factors(const Study& study, const std::filesystem::path& folder, std::vector<Error>& found) {
    const std::map<std::string, std::string>& levels = study.conditions.front().levels;
    for (auto a = levels.begin(); a != levels.end(); ++a)
        for (auto b = std::next(a); b != levels.end(); ++b)
            if (change_together(study, a->first, b->first))
                found.push_back(plan_error(
                    folder, {"/conditions/0/levels/" + b->first},
                    fmt::format(
                        "the factors {} and {} change together in all conditions, so their effects cannot be "
                        "told apart",
                        in_quotes(a->first), in_quotes(b->first)),
                    "conditions in which only one of them changes, or one factor"));
}

void check_hand(const StudyLesson& lesson, const std::string& place, const nlohmann::json& plan,
                const std::filesystem::path& folder, std::vector<Error>& found) {
    if (lesson.hand == "helped" || lesson.devices.empty()) return;
    for (const std::string& pointer : lesson_pointers(place, "hand")) {
        if (!plan.contains(nlohmann::json::json_pointer(pointer))) continue;
        Error error = plan_error(folder, {pointer}, "the devices move the hand, so \"hand\" has no effect",
                                 "\"hand\" in lessons without \"devices\"");
        if (std::none_of(found.begin(), found.end(),
                         [&](const Error& e) { return e.message() == error.message(); }))
            found.push_back(std::move(error));
        return;
    }
}

void check_repeated_comparisons(const Study& study, const std::filesystem::path& folder,
                                std::vector<Error>& found) {
    const std::vector<PlannedComparison>& all = study.comparisons;
    for (std::size_t i = 0; i < all.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            if (all[i] == all[k]) {
                found.push_back(
                    plan_error(folder, {fmt::format("/comparisons/{}", i)},
                               fmt::format("comparison {} repeats comparison {}, so Holm's correction "
                                           "makes all p-values larger",
                                           i + 1, k + 1),
                               "each comparison once"));
                break;
            }
}

}  // namespace

std::vector<std::size_t> conditions_in_both(const ComparedGroup& a, const ComparedGroup& b) {
    std::vector<std::size_t> both;
    for (const std::size_t condition : a.conditions)
        if (std::find(b.conditions.begin(), b.conditions.end(), condition) != b.conditions.end())
            both.push_back(condition);
    return both;
}

std::vector<std::string> lesson_pointers(const std::string& lesson, const std::string& member) {
    return {lesson + "/lesson/" + member, "/lesson/" + member, lesson, ""};
}

Error plan_error(const std::filesystem::path& folder, const std::vector<std::string>& pointers,
                 std::string what, std::string expected) {
    const std::string file = (folder / study_file_name).string();
    const auto text = read_file(file, max_plan_size, ErrorCode::bad_content);
    std::vector<Error> ignored;
    if (const auto document = text ? JsonDocument::parse(*text, file, ignored) : nullptr)
        for (const std::string& pointer : pointers)
            if (document->root().contains(nlohmann::json::json_pointer(pointer))) {
                Error error = document->error(pointer, JsonPart::value, std::move(what), std::move(expected));
                error.code = ErrorCode::bad_content;
                return error;
            }
    Error error;
    error.code = ErrorCode::bad_content;
    error.file = file;
    error.what = std::move(what);
    error.expected = std::move(expected);
    return error;
}

std::vector<Error> plan_weaknesses(const Study& study, const std::filesystem::path& folder) {
    std::vector<Error> found;
    const std::string file = (folder / study_file_name).string();
    const auto text = read_file(file, max_plan_size, ErrorCode::bad_content);
    std::vector<Error> ignored;
    const auto document = text ? JsonDocument::parse(*text, file, ignored) : nullptr;
    if (!document) return found;
    for (std::size_t i = 0; i < study.conditions.size(); ++i)
        check_hand(study.conditions[i].lesson, fmt::format("/conditions/{}", i), document->root(), folder,
                   found);
    if (study.training) check_hand(study.training->lesson, "/training", document->root(), folder, found);
    if (study.retention) check_hand(study.retention->lesson, "/retention", document->root(), folder, found);
    check_factors(study, folder, found);
    check_repeated_comparisons(study, folder, found);
    return found;
}

}  // namespace bolt::content
