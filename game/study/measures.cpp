#include "game/study/measures.hpp"

#include <algorithm>

#include "game/report/attempts.hpp"
#include "game/session/session_file.hpp"

namespace bolt::study {

namespace {

// Counts the joints that were tightened beyond their window, or damaged.
double over_torqued_joints(const analysis::SessionData& session) {
    const auto is_high = [](const lesson::JointResult& joint) {
        return joint.torque_verdict == lesson::Verdict::high ||
               joint.condition != joint::JointCondition::intact;
    };
    return static_cast<double>(std::count_if(session.joints.begin(), session.joints.end(), is_high));
}

double order_errors(const analysis::SessionData& session) {
    double errors = 0.0;
    for (const lesson::JointResult& joint : session.joints) errors += joint.out_of_turn + joint.done_already;
    return errors;
}

}  // namespace

std::span<const MeasureInfo> objective_measure_infos() {
    static const std::vector<MeasureInfo> infos{
        {"score", "Score", "points", 1.0, 1, "the lesson's score, 0 to 100"},
        {"duration_s", "Duration of the lesson", "min", 1.0 / 60.0, 2, "from its beginning to its last step"},
        {"joints_ok", "Joints OK", "%", 100.0, 0, "share of the joints that the lesson judges OK"},
        {"torque_error", "Mean torque error", "% of target", 100.0, 1,
         "mean of |torque − target| / target over the judged joints"},
        {"clamp_scatter", "Scatter of the clamp force", "% of mean", 100.0, 1,
         "standard deviation of the joints' clamp forces over their mean"},
        {"over_torque", "Over-tightened joints", "joints", 1.0, 1,
         "joints above their torque window, or damaged"},
        {"order_errors", "Errors of order", "holds", 1.0, 1,
         "holds of a nut before its step was due or after it was done"},
        {"bumps", "Contacts with obstacles", "contacts", 1.0, 1,
         "contacts of the free wrench with anything but the due nut"},
        {"contact_time_s", "Time in contact", "s", 1.0, 2, "total duration of the contacts with obstacles"},
        {"force_rate", "Force rate", "% of maximum in 1 ms", 100.0, 2,
         "99th percentile of the change of the rendered force in a millisecond, over the device's maximum"},
        {"time_to_nut_s", "Time to the nut", "s", 1.0, 2,
         "time from the beginning of a step with the wrench until the wrench holds the nut; median over the "
         "steps"},
        {"nut_visible", "Nut in sight", "% of time near it", 100.0, 0,
         "share of the time near the due nut during which at least 60 % of the nut is visible"}};
    return infos;
}

std::vector<MeasureInfo> measure_infos(const content::Study& study) {
    std::vector<MeasureInfo> infos;
    for (const content::Questionnaire& form : study.questionnaires)
        for (const content::QuestionnaireScale& scale : form.scales) {
            infos.push_back({form.id + "." + scale.id, content::text_in(scale.titles), "points", 1.0, 1, {}});
        }
    const auto objective = objective_measure_infos();
    infos.insert(infos.end(), objective.begin(), objective.end());
    return infos;
}

std::map<std::string, double> measures_of(const analysis::SessionData& session) {
    const report::Attempt attempt = report::attempt_of(session);
    const analysis::Summary& summary = attempt.summary;
    const auto joints = static_cast<double>(summary.joints);
    return {{"score", attempt.score},
            {"duration_s", attempt.duration},
            {"joints_ok", static_cast<double>(summary.ok) / joints},
            {"torque_error", summary.mean_torque_error},
            {"clamp_scatter", summary.clamp_deviation / summary.clamp_mean},
            {"over_torque", over_torqued_joints(session)},
            {"order_errors", order_errors(session)},
            {"bumps", attempt.obstacle_contacts},
            {"contact_time_s", attempt.contact_time},
            {"force_rate", attempt.p99_change},
            {"time_to_nut_s", attempt.time_to_nut},
            {"nut_visible", attempt.visible_share}};
}

Result<std::map<std::string, double>> measure_session(const std::filesystem::path& session) {
    BOLT_TRY_ASSIGN(const auto reader, session::SessionReader::open(session));
    BOLT_TRY_ASSIGN(const auto data, analysis::read_session(reader));
    return measures_of(data);
}

Result<bool> count_finished_lesson(Participation& participation) {
    const std::optional<std::filesystem::path> folder = participation.begun_lesson();
    std::error_code ignored;
    if (!folder || !std::filesystem::exists(*folder / lesson_session_name, ignored)) return false;
    const auto reader = session::SessionReader::open(*folder / lesson_session_name);
    if (!reader || !reader->complete()) return false;
    const auto data = analysis::read_session(*reader);
    if (!data || !data->finished) return false;
    BOLT_TRY(participation.end_lesson(measures_of(*data)));
    return true;
}

}  // namespace bolt::study
