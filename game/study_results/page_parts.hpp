// Parts of the page with the results of a study.
#pragma once

#include "game/study_results/results.hpp"

namespace bolt::study {

// The lessons of each person in their order: training, conditions, retention test (curves.cpp).
std::string learning_curves(const StudyData& data);

// The paragraph to paste: what was done, not only what was planned (methods.cpp).
std::string methods_text(const content::Study& study, const StudyData& data, const Results& results);
std::string design_text(const content::Study& study);
// The participants whose plan was changed after they began: "P01, P03".
std::string changed_plans(const StudyData& data);

}  // namespace bolt::study
