// The measures of a study: what each objective one means, and their values in a recorded session.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "content/studies/study.hpp"
#include "engine/base/result.hpp"
#include "game/analysis/session_data.hpp"
#include "game/study/participation.hpp"

namespace bolt::study {

// A measure as tables and plots show it.
struct MeasureInfo {
    std::string id;      // as in the plan: "bumps", "paper.stability"
    std::string title;   // English
    std::string unit;    // of the shown value
    double scale = 1.0;  // shown value = scale · value
    int decimals = 1;
    std::string definition;  // of an objective measure: one clause
};

// The objective measures, in the order of content::objective_measures.
std::span<const MeasureInfo> objective_measure_infos();

// The measures of a study: those of the scales of its forms, in the order of the forms, then the objective
// ones.
std::vector<MeasureInfo> measure_infos(const content::Study& study);

// The value of every objective measure; NaN where the session does not have it.
std::map<std::string, double> measures_of(const analysis::SessionData& session);

// Reads the session of a lesson that has ended.
Result<std::map<std::string, double>> measure_session(const std::filesystem::path& session);

inline constexpr const char* lesson_session_name = "session.boltwright";

// Counts a lesson of the due study step that was played to its end, but whose measures could not be stored
// then, for example on a full disk. Returns true if it was counted; if not, the lesson is played again.
Result<bool> count_finished_lesson(Participation& participation);

}  // namespace bolt::study
