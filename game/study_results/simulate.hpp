// Simulated participants: programs that go through every step of a study, so that its design, its data and
// its pages can be tried before people come. Their lessons are those of simulated trainees; their answers are
// random numbers about a stated effect of each condition. Every page that shows them says so.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "content/studies/study.hpp"
#include "engine/base/result.hpp"
#include "game/motion/visibility_model.hpp"
#include "game/study/participation.hpp"

namespace bolt::study {

struct SimulationOptions {
    std::size_t participants = 20;
    std::uint64_t seed = 1;
    std::vector<double> effects;                           // by condition, as PowerOptions::effects
    std::size_t threads = 1;                               // lessons at once
    std::function<motion::ViewHelper()> make_view_helper;  // for lessons with view help
};

// Called from several threads, one at a time, after each lesson. Returns false to stop after the lessons that
// are being played.
using SimulationProgress = std::function<bool(const std::string& participant, const Step& step)>;

// Enrols `options.participants` participants in a study's folder and leads each to the end, the retention
// test included. Fails if the folder has participants already, so that people and programs are never mixed.
// Deterministic in the seed except for the times. The training is counted without being played, because a
// simulated trainee does not learn; breaks and days pass at once.
Status simulate(const content::Study& study, const std::filesystem::path& folder,
                const SimulationOptions& options, const SimulationProgress& progress);

}  // namespace bolt::study
