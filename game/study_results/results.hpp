// The results of a study: the values of all measures by participant and condition, their description, and the
// planned comparisons.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "content/studies/study.hpp"
#include "engine/base/result.hpp"
#include "game/statistics/rank_tests.hpp"
#include "game/statistics/summary.hpp"
#include "game/study/measures.hpp"
#include "game/study/participation.hpp"

namespace bolt::study {

// When a value was taken.
enum class ObservationTime : std::uint8_t { condition, before, after_training, after, retention, training };
inline constexpr std::size_t observation_times = static_cast<std::size_t>(ObservationTime::training) + 1;
std::string_view name(ObservationTime time);

// One value of one measure.
struct Observation {
    std::size_t participant = 0;  // index into StudyData::participants
    ObservationTime time = ObservationTime::condition;
    // Set for values in a condition. Between subjects it is set for all values except those of the training.
    std::size_t condition = no_index;
    std::size_t part = no_index;    // in the order of the participant; none at other times
    std::size_t lesson = no_index;  // of the part or the training; none: a form after the whole part
    std::string measure;
    double value = 0.0;
};

struct StudyData {
    std::vector<ParticipantState> participants;  // who have not withdrawn
    std::size_t withdrawn = 0;
    std::vector<Observation> observations;
    // Scales of forms that somebody was given, but did not answer completely.
    std::set<std::pair<std::string, ObservationTime>> without_score;
    [[nodiscard]] bool simulated() const;         // some participant is simulated
    [[nodiscard]] std::size_t completed() const;  // participants who did every step
};

// The data of a folder. Forms with unanswered items give no value for the scales that need them.
Result<StudyData> collect(const content::Study& study, const std::filesystem::path& folder);
// The observations of participants that are already listed.
StudyData collect(const content::Study& study, std::vector<ParticipantState> states);

// A form that a participant did not answer completely.
struct IncompleteForm {
    std::string participant, step;        // "P03", "part-1/tlx"
    std::string form;                     // title
    std::vector<std::string> declined;    // items that the participant chose not to answer
    std::vector<std::string> unanswered;  // items that were not reached, because the study was left there
    std::vector<std::string> scales;      // titles of the scales that therefore have no value
};
std::vector<IncompleteForm> incomplete_forms(const content::Study& study,
                                             const std::vector<ParticipantState>& states);
// "P03 part-1/tlx: item effort not answered, so there is no Workload"
std::string incomplete_text(const IncompleteForm& form);

// The values that participant_means() takes the mean of.
struct Selection {
    std::string measure;
    ObservationTime time = ObservationTime::condition;
    std::vector<std::size_t> conditions{};  // empty: all
};
// For each participant: the mean of the selected values; NaN without any.
std::vector<double> participant_means(const StudyData& data, const Selection& selection);

// The values of one measure in one condition, one for each participant who has any.
struct MeasureSample {
    std::string name;  // title of the condition, or the time
    std::vector<double> values;
    statistics::Quartiles quartiles;
    double mean = 0.0, min = 0.0, max = 0.0;       // NaN without values
    statistics::ConfidenceInterval mean_interval;  // bootstrap
};

struct MeasureResult {
    MeasureInfo info;
    std::vector<MeasureSample> conditions;   // in the order of the plan
    std::vector<MeasureSample> other_times;  // with values: before, after training, after, retention
    const content::PublishedValue* published = nullptr;
    std::optional<bool> published_is_possible{};  // GRIM test; none: it cannot be checked
};

struct ComparisonResult {
    const content::PlannedComparison* planned = nullptr;
    MeasureInfo info;
    std::vector<MeasureSample> groups;
    std::size_t n = 0;  // participants in the test
    // One of these, by the design and the number of groups.
    std::optional<statistics::SignedRankTest> signed_rank;
    std::optional<statistics::RankSumTest> rank_sum;
    std::optional<statistics::FriedmanTest> friedman;
    std::optional<statistics::Shift> shift;  // first group minus second, of two groups
    double p = 1.0, p_holm = 1.0;
};

struct Results {
    std::vector<MeasureResult> measures;  // those with any value
    std::vector<ComparisonResult> comparisons;
    statistics::BootstrapOptions bootstrap;
};

// `study` must outlive the results.
Results analyse(const content::Study& study, const StudyData& data,
                const statistics::BootstrapOptions& bootstrap = {.resamples = 5000});

// Only the planned comparisons, with Holm's correction over all of them.
std::vector<ComparisonResult> compare(const content::Study& study, const StudyData& data);

// The page: a single HTML file without external resources.
std::string results_page(const content::Study& study, const StudyData& data, const Results& results);

// The progress of all participants, for the experimenter: a page that reloads itself, and lines for a
// terminal. `now`: s since 1970-01-01 UTC. Neither names a condition if the study is blind.
std::string progress_page(const content::Study& study, const std::vector<ParticipantState>& states,
                          std::int64_t now);
std::string progress_text(const content::Study& study, const std::vector<ParticipantState>& states,
                          std::int64_t now);

// A row for each observation: participant, simulated, condition, part, lesson, time, measure,
// value (RFC 4180).
std::string results_csv(const content::Study& study, const StudyData& data);
// A row for each answer to an item, and for each comment: participant, simulated, step, item, value, text.
std::string answers_csv(const StudyData& data);
// Everything that the page shows, as numbers.
std::string results_json(const content::Study& study, const StudyData& data, const Results& results);

// Power of the planned comparisons of forms, by simulation (power.cpp).

struct PowerOptions {
    std::size_t participants = 20, studies = 500;
    std::uint64_t seed = 1;
    // By condition: shift of the answers, in standard deviations of one participant's answers about that
    // participant's mean.
    std::vector<double> effects;
    double significance = 0.05;
};
struct Power {
    const content::PlannedComparison* planned = nullptr;
    double rate = 0.0;  // share of the simulated studies in which Holm's p is below the significance.
                        // The comparisons of without_power() count for the correction, with p = 1
};
// answer = middle of the scale + (trait + effect + error) · width of the scale / 6, rounded to the scale's
// step and clamped to the scale. The trait of the person and the error have a standard deviation of 1. Leaves
// out the comparisons of without_power().
std::vector<Power> simulate_power(const content::Study& study, const PowerOptions& options);

// The planned comparisons that simulate_power() leaves out: those of objective measures, of the retention
// test and of two times.
std::vector<const content::PlannedComparison*> without_power(const content::Study& study);

// "paper.guidance: force off, on"
std::string comparison_text(const content::PlannedComparison& planned);

// The answer to an item for a latent value, as above. For an item that a scale of the form reverses, a larger
// value gives a lower answer.
double simulated_answer(const content::Questionnaire& form, std::size_t item, double latent);

}  // namespace bolt::study
