#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/base/csv.hpp"
#include "game/study_results/parts.hpp"

namespace bolt::study {

namespace {

using nlohmann::ordered_json;

// JSON has no NaN.
ordered_json number(double value) {
    return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json json_of(const MeasureSample& sample) {
    return {{"name", sample.name},
            {"n", sample.values.size()},
            {"min", number(sample.min)},
            {"max", number(sample.max)},
            {"mean", number(sample.mean)},
            {"mean_interval_95", {number(sample.mean_interval.low), number(sample.mean_interval.high)}},
            {"quartiles_type_7",
             {number(sample.quartiles.low), number(sample.quartiles.median), number(sample.quartiles.high)}},
            {"values", sample.values}};
}

ordered_json json_of(const ComparisonResult& result) {
    ordered_json json{{"measure", result.planned->measure}, {"retention", result.planned->retention}};
    if (!result.planned->factor.empty()) json["factor"] = result.planned->factor;
    if (!result.planned->interaction.empty()) json["interaction"] = result.planned->interaction;
    for (const content::FormTime time : result.planned->times) json["times"].push_back(content::name(time));
    for (const MeasureSample& group : result.groups)
        json["groups"].push_back({{"name", group.name}, {"median", number(group.quartiles.median)}});
    json["n"] = result.n;
    if (result.signed_rank) {
        json["test"] = "signed rank, exact, two-sided";
        json["w_positive"] = result.signed_rank->positive;
        json["w_negative"] = result.signed_rank->negative;
        json["zero_differences_dropped"] = result.signed_rank->zeros;
        json["rank_biserial"] = number(result.signed_rank->rank_biserial);
    } else if (result.rank_sum) {
        json["test"] = "rank sum, two-sided";
        json["u"] = result.rank_sum->u;
        json["rank_biserial"] = number(result.rank_sum->rank_biserial);
    } else {
        json["test"] = "Friedman";
        json["chi_squared"] = number(result.friedman->chi_squared);
        json["kendall_w"] = number(result.friedman->kendall_w);
    }
    if (result.shift)
        json["hodges_lehmann"] = {
            {"estimate", number(result.shift->estimate)},
            {"interval", {number(result.shift->interval.low), number(result.shift->interval.high)}},
            {"confidence", number(result.shift->confidence)}};
    json["p"] = number(result.p);
    json["p_holm"] = number(result.p_holm);
    return json;
}

}  // namespace

std::string results_csv(const content::Study& study, const StudyData& data) {
    std::string out = "participant,simulated,condition,part,lesson,time,measure,value\r\n";
    for (const Observation& o : data.observations) {
        const ParticipantState& state = data.participants[o.participant];
        const auto count = [](std::size_t index) {
            return index == no_index ? std::string() : std::to_string(index + 1);
        };
        out += fmt::format("{},{},{},{},{},{},{},{}\r\n", state.participant, state.progress.simulated ? 1 : 0,
                           o.condition == no_index ? "" : study.conditions[o.condition].id, count(o.part),
                           count(o.lesson), name(o.time), o.measure, o.value);
    }
    return out;
}

std::string answers_csv(const StudyData& data) {
    std::string out = "participant,simulated,step,item,value,text\r\n";
    for (const ParticipantState& state : data.participants) {
        const int simulated = state.progress.simulated ? 1 : 0;
        for (const auto& [step, answers] : state.progress.answers)
            for (const auto& [item, value] : answers)
                out += fmt::format("{},{},{},{},{},\r\n", state.participant, simulated, step, item,
                                   value ? fmt::format("{}", *value) : "");
        if (!state.progress.comment.empty())
            out += fmt::format("{},{},comment,,,{}\r\n", state.participant, simulated,
                               csv_field(state.progress.comment));
    }
    return out;
}

std::string results_json(const content::Study& study, const StudyData& data, const Results& results) {
    ordered_json json{{"format", "boltwright study results 1"},
                      {"study", study.id},
                      {"plan_checksum", fmt::format("{:016x}", study.checksum)},
                      {"simulated", data.simulated()},
                      {"participants", data.participants.size()},
                      {"completed", data.completed()},
                      {"withdrawn", data.withdrawn},
                      {"bootstrap",
                       {{"resamples", results.bootstrap.resamples},
                        {"seed", results.bootstrap.seed},
                        {"method", "percentile"}}}};
    const Interruptions interruptions = interruptions_of(data);
    json["interrupted_lessons"] = {{"lessons", interruptions.lessons},
                                   {"times_continued", interruptions.continued},
                                   {"times_begun_again", interruptions.begun_again}};
    json["measures"] = ordered_json::array();
    for (const MeasureResult& measure : results.measures) {
        ordered_json entry{{"id", measure.info.id}, {"title", measure.info.title}};
        for (const MeasureSample& sample : measure.conditions) entry["conditions"].push_back(json_of(sample));
        for (const MeasureSample& sample : measure.other_times)
            entry["other_times"].push_back(json_of(sample));
        if (measure.published != nullptr)
            entry["published"] = {
                {"mean", measure.published->mean},
                {"n", measure.published->n},
                {"source", measure.published->source},
                {"possible_mean", measure.published_is_possible ? ordered_json(*measure.published_is_possible)
                                                                : ordered_json(nullptr)}};
        json["measures"].push_back(std::move(entry));
    }
    json["incomplete_forms"] = ordered_json::array();
    for (const IncompleteForm& form : incomplete_forms(study, data.participants))
        json["incomplete_forms"].push_back({{"participant", form.participant},
                                            {"step", form.step},
                                            {"declined", form.declined},
                                            {"unanswered", form.unanswered},
                                            {"scales_without_value", form.scales}});
    json["comparisons"] = ordered_json::array();
    for (const ComparisonResult& result : results.comparisons) json["comparisons"].push_back(json_of(result));
    return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace bolt::study
