// The progress of a study's participants, for the experimenter.
#include <fmt/format.h>

#include "game/plot/html.hpp"
#include "game/study_results/results.hpp"

namespace bolt::study {

namespace {

using plot::put;

// The due step, without anything that reveals the condition.
std::string step_text(const ParticipantState& state) {
    if (state.withdrawn) return state.problem ? "withdrew, data left" : "withdrew";
    if (state.problem) return "damaged";
    if (state.due == state.steps.size()) return "complete";
    const Step& step = state.steps[state.due];
    return step.id;
}

std::string conditions_text(const content::Study& study, const ParticipantState& state) {
    if (study.design.blind || state.withdrawn) return "–";
    std::string text;
    for (const std::size_t condition : state.conditions)
        text += (text.empty() ? "" : ", ") + study.conditions[condition].id;
    return text;
}

// The items that the participant chose not to answer.
std::string declined_text(const content::Study& study, const ParticipantState& state) {
    std::string text;
    for (const IncompleteForm& form : incomplete_forms(study, {state}))
        if (!form.declined.empty()) text += (text.empty() ? "; not answered: " : ", ") + form.step;
    return text;
}

std::string waiting_text(const content::Study& study, const ParticipantState& state, std::int64_t now) {
    if (state.problem)
        return study.design.blind  // the message can name a condition
                   ? "the journal does not fit the plan, or is damaged; expected a look at it by a person "
                     "who "
                     "may know the conditions"
                   : state.problem->message();
    if (state.withdrawn) return {};
    const std::string declined = declined_text(study, state);
    const double ahead = static_cast<double>(state.progress.latest - now);
    if (ahead > tolerated_set_back && !state.progress.simulated)
        return fmt::format(
            "last entry {}, {:.1f} days ahead of this computer's clock; expected the right date and time, "
            "or `study run --participant {} --accept-clock`{}",
            time_text(state.progress.latest), ahead / 86400.0, state.participant, declined);
    const auto due = retention_due(study, state.progress);
    if (due && state.due < state.steps.size() && state.steps[state.due].kind == StudyStepKind::retention)
        return (*due > now ? "retention test from " : "retention test since ") + local_date(*due) + declined;
    return "last entry " + time_text(state.progress.latest) + declined;
}

}  // namespace

std::string progress_text(const content::Study& study, const std::vector<ParticipantState>& states,
                          std::int64_t now) {
    std::string out;
    std::size_t complete = 0, withdrawn = 0;
    for (const ParticipantState& state : states) {
        withdrawn += state.withdrawn;
        complete += !state.withdrawn && !state.problem && state.due == state.steps.size();
        put(out, "{:<5} {:>2} of {:<3} {:<26} {:<24} {}{}\n", state.participant, state.due,
            state.steps.size(), step_text(state), conditions_text(study, state),
            waiting_text(study, state, now), state.progress.simulated ? " (simulated)" : "");
    }
    put(out, "{} of {} planned participants complete, {} begun, {} withdrew\n", complete,
        study.design.participants, states.size() - withdrawn, withdrawn);
    return out;
}

std::string progress_page(const content::Study& study, const std::vector<ParticipantState>& states,
                          std::int64_t now) {
    std::string body;
    put(body,
        "<meta http-equiv=\"refresh\" content=\"10\"/>\n<p class=\"over\">Boltwright study, progress at "
        "{}</p>\n<h1>{}</h1>\n",
        time_text(now), plot::escape(content::text_in(study.titles)));
    body +=
        "<div class=\"scroll\"><table><thead><tr><th>participant</th><th class=\"n\">steps done</th><th>due "
        "step</th><th>conditions</th><th></th></tr></thead><tbody>\n";
    for (const ParticipantState& state : states)
        put(body,
            "<tr><td>{}{}</td><td class=\"n\">{} <span class=\"of\">of "
            "{}</span></td><td>{}</td><td>{}</td><td class=\"w\">{}</td></tr>\n",
            state.participant, state.progress.simulated ? " (simulated)" : "", state.due, state.steps.size(),
            step_text(state), plot::escape(conditions_text(study, state)), waiting_text(study, state, now));
    body += "</tbody></table></div>\n";
    if (study.design.blind)
        body += "<p class=\"note\">The study is blind: this page does not show the conditions.</p>\n";
    return plot::page(content::text_in(study.titles) + ": progress", body);
}

}  // namespace bolt::study
