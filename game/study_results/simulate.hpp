// Simulated participants: programs that go through every step of a study, so that its design, its data and
// its pages can be tried before people come. Simulated trainees play their lessons; their answers are random,
// with a stated effect of each condition. Every page that shows them says so.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "content/studies/study.hpp"
#include "engine/base/result.hpp"
#include "game/session/lesson_session.hpp"
#include "game/study/participation.hpp"

namespace bolt::study {

// A lesson that a simulated trainee has to play.
struct SimulatedLesson {
    const content::Assembly& assembly;
    session::LessonOptions options;  // without the trainee's profile
    std::size_t person = 0;          // the same for all lessons of a participant
    bool view_help = false;
    std::filesystem::path file;  // receives the session
};

struct SimulationOptions {
    std::size_t participants = 20;
    std::uint64_t seed = 1;
    // By condition: shift of the answers in standard deviations, as PowerOptions::effects.
    std::vector<double> effects;
    std::size_t threads = 1;  // lessons at once; 0: one per processor
    // Plays a lesson to its end; called from several threads. The caller supplies it, because this library
    // does not link game/trainees.
    std::function<Result<session::LessonOutcome>(const SimulatedLesson&)> play;
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
