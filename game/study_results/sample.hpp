// Makes a Sample, for the parts of the analysis.
#pragma once

#include "game/study_results/results.hpp"

namespace bolt::study {

// Leaves out values that are not finite. Without `bootstrap` the mean has no interval.
Sample sample_of(std::string name, const std::vector<double>& values,
                 const statistics::BootstrapOptions* bootstrap);

// Between subjects a form at the end belongs to the participant's only condition, unless it is presented in
// the condition too.
bool belongs_to_condition(const content::Study& study, const content::StudyForm& form);

}  // namespace bolt::study
