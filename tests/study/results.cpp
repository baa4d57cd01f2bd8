// The analysis of a study and its pages, and simulated participants.
#include "game/study_results/results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "content/format/embedded.hpp"
#include "game/study/study_lesson.hpp"
#include "game/study_results/simulate.hpp"
#include "game/trainees/trainee.hpp"
#include "tests/study/study_data.hpp"

namespace study_results_test {

using namespace bolt;
using namespace bolt::study;
using namespace study_test;
using doctest::Approx;

namespace {

SimulationOptions two_simulated() {
    SimulationOptions options;
    options.participants = 2;
    options.seed = 3;
    options.threads = 2;
    options.play = [](const SimulatedLesson& lesson) -> Result<session::LessonOutcome> {
        trainees::TrainOptions train;
        train.lesson = lesson.options;
        train.trainee = required(trainees::find_profile(lesson.person % 2 == 0 ? "expert" : "novice"));
        return trainees::train(lesson.assembly, train, lesson.file, [](const auto&) { return true; });
    };
    return options;
}

const SimulationProgress goes_on = [](const std::string&, const Step&) { return true; };

}  // namespace

TEST_CASE("Study results: a planned comparison of two conditions is Wilcoxon's test of Darwin's maize") {
    StudyFolder folder;
    const content::Study study = folder.load();
    std::vector<std::vector<double>> rows;
    for (const double x : {6, 8, 14, 16, 23, 24, 28, 29, 41, -48, 49, 56, 60, -67, 75})
        rows.push_back({100.0 + x, 100.0});
    const std::vector<ComparisonResult> results = compare(study, data_of(study, "duration_s", rows));
    REQUIRE(results.size() == 3);
    const ComparisonResult& duration = results[2];
    REQUIRE(duration.signed_rank);
    CHECK(duration.n == 15);
    CHECK(duration.signed_rank->negative == 24.0);
    CHECK(duration.p == 0.041259765625);
    CHECK(duration.signed_rank->rank_biserial == Approx(0.6));
    CHECK(duration.shift->estimate == 25.0);
    CHECK(duration.shift->interval.low == 4.0);
    CHECK(duration.shift->interval.high == 41.5);
    // Two comparisons without data have p = 1, and Holm's correction is for all three.
    CHECK(results[0].p == 1.0);
    CHECK(duration.p_holm == 3.0 * 0.041259765625);
}

TEST_CASE("Study results: participants without a value in every condition are left out of a test") {
    StudyFolder folder;
    const content::Study study = folder.load();
    StudyData data = data_of(study, "duration_s", {{1, 2}, {3, 5}, {4, 1}, {2, 9}});
    std::erase_if(data.observations,
                  [](const Observation& o) { return o.participant == 2 && o.condition == 1; });
    CHECK(compare(study, data)[2].n == 3);
    // The description keeps the value.
    const Results results = analyse(study, data, {.resamples = 100});
    const auto duration = std::find_if(results.measures.begin(), results.measures.end(),
                                       [](const MeasureResult& m) { return m.info.id == "duration_s"; });
    REQUIRE(duration != results.measures.end());
    CHECK(duration->conditions[0].values.size() == 4);
    CHECK(duration->conditions[1].values.size() == 3);
    CHECK(duration->conditions[0].quartiles.median == 2.5);
    CHECK(duration->conditions[0].quartiles.low == 1.75);  // type 7
}

TEST_CASE("Study results: who misses a lesson of a factor's level is left out of the test of the factor") {
    StudyFolder folder;
    folder.edit(R"({ "id": "a", "title": { "en": "A" } },)",
                R"({ "id": "a", "title": { "en": "A" }, "levels": { "f": "on" } },
                   { "id": "c", "title": { "en": "C" }, "lesson": { "task": "loosen" }, "levels": { "f": "off" } },
                   { "id": "d", "title": { "en": "D" }, "lesson": { "mode": "assessment" }, "levels": { "f": "on" } },)");
    folder.edit(R"("lesson": { "mode": "guided" } })",
                R"("lesson": { "mode": "guided" }, "levels": { "f": "off" } })");
    folder.edit(R"({ "measure": "duration_s" })", R"({ "measure": "duration_s", "factor": "f" })");
    const content::Study study = folder.load();
    StudyData data = data_of(study, "duration_s", {{1, 2, 3, 4}, {3, 5, 2, 1}, {4, 1, 2, 2}});
    CHECK(compare(study, data)[2].n == 3);
    std::erase_if(data.observations, [](const Observation& o) {
        return o.participant == 1 && o.condition == 3 && o.lesson == 1;
    });
    CHECK(compare(study, data)[2].n == 2);
}

TEST_CASE("Study results: three conditions are compared by Friedman's test of the rounding times") {
    StudyFolder folder;
    folder.edit(R"({ "id": "a", "title": { "en": "A" } },)",
                R"({ "id": "a", "title": { "en": "A" } },
                   { "id": "c", "title": { "en": "C" }, "lesson": { "mode": "assessment" } },)");
    const content::Study study = folder.load();
    const std::vector<double> times{
        5.40, 5.50, 5.55, 5.85, 5.70, 5.75, 5.20, 5.60, 5.50, 5.55, 5.50, 5.40, 5.90, 5.85, 5.70, 5.45, 5.55,
        5.60, 5.40, 5.40, 5.35, 5.45, 5.50, 5.35, 5.25, 5.15, 5.00, 5.85, 5.80, 5.70, 5.25, 5.20, 5.10, 5.65,
        5.55, 5.45, 5.60, 5.35, 5.45, 5.05, 5.00, 4.95, 5.50, 5.50, 5.40, 5.45, 5.55, 5.50, 5.55, 5.55, 5.35,
        5.45, 5.50, 5.55, 5.50, 5.45, 5.25, 5.65, 5.60, 5.40, 5.70, 5.65, 5.55, 6.30, 6.30, 6.25};
    std::vector<std::vector<double>> rows;
    for (std::size_t i = 0; i < times.size(); i += 3) rows.push_back({times[i], times[i + 1], times[i + 2]});
    const ComparisonResult result = compare(study, data_of(study, "duration_s", rows))[2];
    REQUIRE(result.friedman);
    CHECK(result.friedman->chi_squared == Approx(11.142857).epsilon(1e-6));
    CHECK(result.p == Approx(0.003805).epsilon(1e-3));
    CHECK(result.friedman->kendall_w == Approx(0.2532).epsilon(1e-3));
}

TEST_CASE("Study results: groups of different people are compared by the rank sum test") {
    StudyFolder folder;
    folder.edit(R"("subjects": "within")", R"("subjects": "between")");
    const content::Study study = folder.load();
    StudyData data = data_of(study, "duration_s", {{3.0}, {7.0}, {5.0}, {8.0}, {1.0}, {9.0}});
    std::vector<double> groups[2];
    for (Observation& o : data.observations) {
        o.condition = content::conditions_of(study, o.participant).front();
        if (o.lesson == 0) groups[o.condition].push_back(o.value);
    }
    REQUIRE(groups[0].size() == 3);
    const ComparisonResult result = compare(study, data)[2];
    REQUIRE(result.rank_sum);
    CHECK(result.n == 6);
    CHECK(result.p == statistics::rank_sum_test(groups[0], groups[1]).p_two_sided);
}

TEST_CASE("Study results: the means printed in 2018 cannot come from twenty answers, and the page says so") {
    const content::LoadedStudy paper = content::load_study(content::content_folder() / "studies/paper-2018",
                                                           content::content_folder() / "questionnaires");
    REQUIRE(paper.ok());
    const Results results = analyse(paper.study, {}, {.resamples = 10});
    int impossible = 0;
    for (const MeasureResult& measure : results.measures)
        if (measure.published != nullptr) impossible += measure.published_is_possible == false;
    CHECK(impossible == 4);
    const std::string page = results_page(paper.study, {}, results);
    CHECK(count(page, "impossible mean") == 4);
    CHECK(has(page, "6.684"));
    CHECK(has(page, "Nobody has taken part yet"));
    // With 19 people two of the means are possible, so the check can fail.
    content::Study nineteen = paper.study;
    for (content::PublishedValue& value : nineteen.published) value.n = 19;
    CHECK(count(results_page(nineteen, {}, analyse(nineteen, {}, {.resamples = 10})), "impossible mean") ==
          2);
}

TEST_CASE("Study results: simulated participants do every step, are labelled, and repeat with the seed") {
    std::string tables[2];
    for (std::string& table : tables) {
        StudyFolder folder;
        const content::Study study = folder.load();
        const Status simulated = simulate(study, folder.path(), two_simulated(), goes_on);
        if (!simulated) FAIL(simulated.error().message());
        const StudyData data = required(collect(study, folder.path()));
        CHECK(data.completed() == 2);
        CHECK(data.simulated());
        table = results_csv(study, data);
        if (&table != &tables[0]) continue;
        const Results results = analyse(study, data, {.resamples = 200});
        const std::string page = results_page(study, data, results);
        CHECK(has(page, "<strong>Simulated participants.</strong> 2 of 2"));
        for (const char* external : {"href=", "<script", "src=", "@import", "url("})
            CHECK_FALSE(has(page, external));
        for (const char* section : {"About the participants", "How old are you?",
                                    "Judged by the participants", "Measured in the lessons", "Every value",
                                    "Planned comparisons", "Over the lessons", "Methods", "retention test"})
            CHECK_MESSAGE(has(page, section), section);
        // A row for each observation and the header.
        CHECK(count(table, "\r\n") == data.observations.size() + 1);
        const auto json = nlohmann::json::parse(results_json(study, data, results));
        CHECK(json["simulated"] == true);
        CHECK(json["comparisons"].size() == 3);
        CHECK(has(answers_csv(data), "\r\nP01,1,"));
        // People and programs are never mixed.
        CHECK_FALSE(simulate(study, folder.path(), two_simulated(), goes_on));
    }
    CHECK(tables[0] == tables[1]);
}

TEST_CASE(
    "Study: a finished lesson whose end could not be stored counts on the next start, another does not") {
    StudyFolder folder;
    folder.make_short();
    const content::Study study = folder.load();
    Participation participation =
        required(Participation::enrol(study, folder.path(), "T-1", false, folder.clock()));
    while (participation.due()->kind != StudyStepKind::lesson) do_step(participation);
    CHECK_FALSE(required(count_finished_lesson(participation)));
    const content::StudyLesson& lesson = participation.lesson();
    for (const bool finishes : {false, true}) {
        const auto assembly = required(load_lesson_assembly(lesson, folder.path()));
        trainees::TrainOptions train;
        train.lesson = lesson_options(lesson, assembly.law);
        train.trainee = required(trainees::find_profile("expert"));
        const auto session = required(participation.begin_lesson()) / lesson_session_name;
        int seconds = 0;
        (void)required(trainees::train(assembly, train, session,
                                       [&](const auto&) { return finishes || ++seconds < 5; }));
        CHECK(required(count_finished_lesson(participation)) == finishes);
    }
    CHECK(participation.due()->id == "part-1/paper");
    CHECK(participation.progress().measures.at("part-1/lesson-1").at("joints_ok") == 1.0);
    CHECK(participation.progress().begun_again.size() == 1);
}

TEST_CASE("Study results: the progress of a blind study names no condition") {
    StudyFolder folder;
    folder.edit(R"("title": { "en": "A" })", R"("title": { "en": "Secret A" })");
    folder.edit(R"("id": "a")", R"("id": "secret-a")");
    content::Study study = folder.load();
    Participation participation =
        required(Participation::enrol(study, folder.path(), "T-1", false, folder.clock()));
    do_all(participation);
    const auto states = required(list_participants(study, folder.path()));
    CHECK(has(progress_text(study, states, folder.now), "secret-a"));  // not blind
    study.design.blind = true;
    for (const std::string& text :
         {progress_text(study, states, folder.now), progress_page(study, states, folder.now)}) {
        CHECK_FALSE(has(text, "ecret"));
        CHECK(has(text, "P01"));
        CHECK(has(text, "break-1"));
    }
    // A plan that lost the condition that the participant was given.
    folder.edit(R"("id": "secret-a")", R"("id": "other")");
    study = folder.load();
    const auto damaged = required(list_participants(study, folder.path()));
    REQUIRE(damaged.at(0).problem);
    CHECK(has(progress_text(study, damaged, folder.now), "secret-a"));
    study.design.blind = true;
    CHECK_FALSE(has(progress_text(study, damaged, folder.now), "secret-a"));
    CHECK(has(progress_text(study, damaged, folder.now), "the journal does not fit the plan"));
}

TEST_CASE("Study results: every objective measure has a definition, a value, and its name in the schema") {
    const auto infos = objective_measure_infos();
    REQUIRE(infos.size() == std::size(content::objective_measures));
    const auto values = measures_of(analysis::SessionData{});
    CHECK(values.size() == infos.size());
    for (std::size_t i = 0; i < infos.size(); ++i) {
        CHECK(infos[i].id == content::objective_measures[i]);
        CHECK_FALSE(infos[i].definition.empty());
        CHECK(values.contains(infos[i].id));
        CHECK(has(std::string(content::study_schema_text()), infos[i].id));
    }
}

TEST_CASE("Study results: the page says whose plan was changed, and claims no planning before the data") {
    StudyFolder folder;
    const content::Study study = folder.load();
    StudyData data = data_of(study, "duration_s", {{1, 2}, {2, 3}});
    const std::string planned = "were planned before the first participant";
    CHECK(has(results_page(study, data, analyse(study, data, {.resamples = 10})), planned));
    data.participants[1].progress.plan_changes = 1;
    const std::string page = results_page(study, data, analyse(study, data, {.resamples = 10}));
    CHECK_FALSE(has(page, planned));
    CHECK(has(page, "after participants had begun (P2)"));
}

TEST_CASE("Study results: a comment cannot change the page") {
    StudyFolder folder;
    const content::Study study = folder.load();
    StudyData data = data_of(study, "duration_s", {{1, 2}});
    data.participants[0].progress.comment = "<script>alert(1)</script>";
    const std::string page = results_page(study, data, analyse(study, data, {.resamples = 10}));
    CHECK_FALSE(has(page, "<script"));
    CHECK(has(page, "&lt;script&gt;"));
}

TEST_CASE("Study results: without an effect few studies find one, and a large effect is found") {
    StudyFolder folder;
    folder.edit(R"("participants": 4)", R"("participants": 20)");
    const content::Study study = folder.load();
    PowerOptions options;
    options.studies = 400;
    const std::vector<Power> none = simulate_power(study, options);
    REQUIRE(none.size() == 2);  // the duration is no form's
    const auto left_out = without_power(study);
    REQUIRE(left_out.size() == 1);
    CHECK(comparison_text(*left_out[0]) == "duration_s: a, b");
    for (const Power& power : none) CHECK(power.rate < 0.06);
    options.effects = {0.0, 1.5};
    for (const Power& power : simulate_power(study, options)) CHECK(power.rate > 0.9);
}

}  // namespace study_results_test
