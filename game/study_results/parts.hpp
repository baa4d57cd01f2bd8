// Functions that the files of this folder share: the description of values, and parts of the page.
// results.hpp has those for other folders.
#pragma once

#include "game/study_results/results.hpp"

namespace bolt::study {

// Describes values; leaves out those that are not finite. Without `bootstrap` the mean has no interval.
MeasureSample sample_of(std::string name, const std::vector<double>& values,
                        const statistics::BootstrapOptions* bootstrap);

// Between subjects a form at the end belongs to the participant's only condition, unless it is presented in
// the condition too.
bool belongs_to_condition(const content::Study& study, const content::StudyForm& form);

// The lessons of each person in their order: training, conditions, retention test (curves.cpp).
std::string learning_curves(const StudyData& data);

// Lessons that a closed or killed program interrupted, and their outcomes. A lesson can be interrupted
// several times.
struct Interruptions {
    std::size_t lessons = 0;
    std::size_t continued = 0;    // at the point reached
    std::size_t begun_again = 0;  // because the recording could not be used
};
Interruptions interruptions_of(const StudyData& data);

// The paragraph to paste: what was done, not only what was planned (methods.cpp).
std::string methods_text(const content::Study& study, const StudyData& data, const Results& results);
std::string design_text(const content::Study& study);
// The participants whose plan was changed after they began: "P01, P03".
std::string changed_plans(const StudyData& data);

}  // namespace bolt::study
