// Interactions, comparisons of two times, incomplete forms, and the paragraph about the methods.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/study/study_data.hpp"

namespace study_analysis_test {

using namespace bolt;
using namespace bolt::study;
using namespace study_test;
using doctest::Approx;

TEST_CASE(
    "Study results: the interaction of two factors is a signed rank test of the differences of differences") {
    StudyFolder folder;
    folder.edit(R"({ "id": "a", "title": { "en": "A" } },)",
                R"({ "id": "a", "title": { "en": "A" }, "levels": { "f": "off", "v": "off" } },
                   { "id": "c", "title": { "en": "C" }, "lesson": { "task": "loosen" }, "levels": { "f": "off", "v": "on" } },
                   { "id": "d", "title": { "en": "D" }, "lesson": { "mode": "assessment" }, "levels": { "f": "on", "v": "off" } },)");
    folder.edit(R"("lesson": { "mode": "guided" } })",
                R"("lesson": { "mode": "guided" }, "levels": { "f": "on", "v": "on" } })");
    folder.edit(R"({ "measure": "duration_s" })",
                R"({ "measure": "duration_s", "factor": "f", "interaction": "v" })");
    const content::Study study = folder.load();
    // Darwin's maize as (a − c) − (d − b): both main effects are zero.
    std::vector<std::vector<double>> rows;
    for (const double x : {6, 8, 14, 16, 23, 24, 28, 29, 41, -48, 49, 56, 60, -67, 75})
        rows.push_back({100.0 + x / 4.0, 100.0 - x / 4.0, 100.0 - x / 4.0, 100.0 + x / 4.0});
    StudyData data = data_of(study, "duration_s", rows);
    const ComparisonResult interaction = compare(study, data)[2];
    REQUIRE(interaction.signed_rank);
    CHECK(interaction.n == 15);
    CHECK(interaction.signed_rank->negative == 24.0);
    CHECK(interaction.p == 0.041259765625);
    CHECK(interaction.shift->estimate == Approx(25.0));
    CHECK(interaction.groups[0].name == "f off: v off − on");
    CHECK(has(results_page(study, data, analyse(study, data, {.resamples = 10})), "interaction of f and v"));
    // A participant without one of the four cells is left out.
    std::erase_if(data.observations,
                  [](const Observation& o) { return o.participant == 0 && o.condition == 1; });
    CHECK(compare(study, data)[2].n == 14);
}

TEST_CASE("Study results: the answers before and after are compared in pairs, in both designs") {
    for (const char* subjects : {"within", "between"}) {
        StudyFolder folder;
        folder.edit(R"("subjects": "within")", fmt::format(R"("subjects": "{}")", subjects));
        folder.edit(R"("when": ["after_condition", "after"])", R"("when": ["before", "after"])");
        folder.edit(R"({ "measure": "tlx.workload" })",
                    R"({ "measure": "tlx.workload", "times": ["before", "after"] })");
        const content::Study study = folder.load();
        for (int person = 0; person < 6; ++person) {
            Participation participation = required(Participation::enrol(
                study, folder.path(), fmt::format("T-{}", person), false, folder.clock()));
            while (participation.due() != nullptr && participation.due()->kind != StudyStepKind::retention) {
                folder.now += static_cast<std::int64_t>(participation.remaining_wait());
                if (participation.due()->id != "before/tlx") {
                    do_step(participation);
                    continue;
                }
                for (const content::QuestionnaireItem& item : study.questionnaires[2].items)
                    REQUIRE(participation.answer(item.id, 10.0 * person));
                REQUIRE(participation.complete());
            }
        }
        const StudyData data = required(collect(study, folder.path()));
        const ComparisonResult times = compare(study, data)[1];
        REQUIRE(times.signed_rank);
        CHECK(times.n == 6);
        CHECK(times.groups[0].quartiles.median == 25.0);
        CHECK(times.groups[1].quartiles.median == 100.0);
        CHECK(times.p == 0.03125);  // all six rise
    }
}

TEST_CASE("Study results: the methods say what was done, and describe only the tests that were used") {
    StudyFolder folder;
    const content::Study study = folder.load();
    const auto methods = [](const content::Study& plan, const StudyData& data) {
        const std::string page = results_page(plan, data, analyse(plan, data, {.resamples = 10}));
        return page.substr(page.find("<h2>Methods</h2>"));
    };
    StudyData data = data_of(study, "duration_s", {{1, 2}});
    std::string text = methods(study, data);
    CHECK(has(text, "1 participant is analysed"));
    CHECK(has(text, "Nobody withdrew"));
    CHECK(has(text, "A retention test after 7 days was planned; nobody has taken it yet."));
    CHECK(has(text, "was planned; nobody has trained yet"));
    CHECK(has(text, "Wilcoxon"));
    CHECK_FALSE(has(text, "Friedman"));
    CHECK_FALSE(has(text, "rank sum"));
    ParticipantState& state = data.participants[0];
    state.progress.training_seconds = 660.0;
    state.progress.done = {{"end-of-visit", 1000}, {"retention", 1000 + 9 * 86400}};
    text = methods(study, data);
    CHECK(has(text, "1 participant trained for 11.0 min in lessons (planned: 8 min 00 s)"));
    CHECK(has(text, "followed after 9.0 days (planned: 7 days); 1 of 1 participants took it"));
    content::Study plain = study;
    plain.comparisons.clear();
    text = methods(plain, data_of(plain, "duration_s", {{1, 2}}));
    CHECK(has(text, "No comparison was planned, so nothing was tested."));
    for (const char* absent : {"Wilcoxon", "Friedman", "rank sum", "Holm", "The 0"})
        CHECK_FALSE(has(text, absent));
}

TEST_CASE("Study results: a form with an item that was not answered is named on page, console and status") {
    StudyFolder folder;
    const content::Study study = folder.load();
    Participation participation =
        required(Participation::enrol(study, folder.path(), "T-1", false, folder.clock()));
    while (participation.due()->id != "part-1/tlx") do_step(participation);
    const auto& items = study.questionnaires[2].items;
    for (std::size_t i = 0; i < items.size(); ++i)
        REQUIRE(participation.answer(items[i].id, i == 1 ? std::nullopt : std::optional(50.0)));
    REQUIRE(participation.complete());
    folder.now += 120;
    do_step(participation);
    do_step(participation);
    REQUIRE(participation.answer(study.questionnaires[1].items[0].id, 5.0));  // left here
    const auto states = required(list_participants(study, folder.path()));
    const StudyData data = required(collect(study, folder.path()));
    const auto forms = incomplete_forms(study, states);
    REQUIRE(forms.size() == 2);
    CHECK(
        incomplete_text(forms[0]) ==
        fmt::format("P01 part-1/tlx: item {} not answered by choice, so there is no Workload", items[1].id));
    CHECK(forms[1].unanswered.size() == 3);
    CHECK(has(progress_text(study, states, folder.now), "; not answered: part-1/tlx"));
    const std::string page = results_page(study, data, analyse(study, data, {.resamples = 10}));
    CHECK(has(page, "Forms that were not answered completely"));
    CHECK(has(page, "<td class=\"w\">" + items[1].id + "</td><td class=\"w\">Workload</td>"));
    CHECK(nlohmann::json::parse(
              results_json(study, data, analyse(study, data, {.resamples = 10})))["incomplete_forms"]
              .size() == 2);
    // A row without a value stays in the table.
    StudyFolder after;
    after.edit(R"("when": ["after_condition", "after"])", R"("when": ["after"])");
    after.edit(R"({ "measure": "tlx.workload" }, )", "");
    const content::Study other = after.load();
    Participation last = required(Participation::enrol(other, after.path(), "T-1", false, after.clock()));
    while (last.due()->id != "after/tlx") {
        after.now += static_cast<std::int64_t>(last.remaining_wait());
        do_step(last);
    }
    for (const auto& item : other.questionnaires[2].items) REQUIRE(last.answer(item.id, std::nullopt));
    REQUIRE(last.complete());
    const StudyData declined = required(collect(other, after.path()));
    CHECK(has(results_page(other, declined, analyse(other, declined, {.resamples = 10})),
              "<td class=\"w\">Workload <span class=\"of\">points</span></td><td class=\"w\">after</td><td "
              "class=\"n\">0</td>"));
}

TEST_CASE("Study results: lessons of the training and the retention test are in the table and on the curve") {
    StudyFolder folder;
    const content::Study study = folder.load();
    for (const char* person : {"T-1", "T-2"}) {
        Participation participation =
            required(Participation::enrol(study, folder.path(), person, false, folder.clock()));
        while (participation.due() != nullptr) {
            folder.now += static_cast<std::int64_t>(participation.remaining_wait());
            do_step(participation, 240.0 + 10.0 * static_cast<double>(folder.now % 7));
        }
    }
    const StudyData data = required(collect(study, folder.path()));
    const auto trained = std::count_if(
        data.observations.begin(), data.observations.end(),
        [](const Observation& o) { return o.time == ObservationTime::training && o.measure == "score"; });
    CHECK(trained >= 4);
    CHECK(count(results_csv(study, data), ",training,score,90") == static_cast<std::size_t>(trained));
    const std::string page = results_page(study, data, analyse(study, data, {.resamples = 10}));
    const std::string curves = page.substr(page.find("Over the lessons"));
    for (const char* part : {">training<", ">retention<", ">P01<", ">P02<"})
        CHECK_MESSAGE(has(curves, part), part);
    CHECK(has(page, "<td class=\"w\">training</td>"));
    CHECK(has(answers_csv(data), "participant,simulated,step,item,value,text\r\nP01,0,"));
}

}  // namespace study_analysis_test
