// Data of a study without a folder, and texts of its pages.
#pragma once

#include "game/study_results/results.hpp"
#include "tests/study/support.hpp"

namespace study_test {

namespace content = bolt::content;
using bolt::study::Observation;
using bolt::study::ParticipantState;
using bolt::study::StudyData;

// Participants with one value for each condition and no journal.
inline StudyData data_of(const content::Study& study, const std::string& measure,
                         const std::vector<std::vector<double>>& rows) {
    StudyData data;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        ParticipantState state;
        state.participant = "P" + std::to_string(i + 1);
        state.progress.place = i;
        state.conditions = content::conditions_of(study, i);
        state.steps = bolt::study::steps_of(study, state.conditions);
        data.participants.push_back(std::move(state));
        for (std::size_t k = 0; k < rows[i].size(); ++k) {
            Observation o;
            o.participant = i;
            o.condition = k;
            o.part = k;
            o.measure = measure;
            o.value = rows[i][k];
            for (o.lesson = 0; o.lesson < study.design.lessons; ++o.lesson) data.observations.push_back(o);
        }
    }
    return data;
}

inline bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

inline std::size_t count(const std::string& text, const std::string& part) {
    std::size_t n = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
    return n;
}

}  // namespace study_test
