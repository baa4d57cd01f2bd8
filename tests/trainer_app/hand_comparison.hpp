// Measures how a simulated user played a lesson, to compare the helped and the free hand.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "tests/trainer_app/trainer_driver.hpp"

namespace bolt::test {

// BOLTWRIGHT_COMPARE_HANDS=1 plays the comparison, which takes minutes.
[[nodiscard]] bool compares_hands();

struct HandMeasures {
    bool finished = false;
    double seconds = 0.0;  // of the lesson
    int presses = 0;       // of the left button
    double score = 0.0;
    std::size_t bumps = 0;      // analysis::ObstacleContact
    double bump_seconds = 0.0;  // in all
    // Largest deviation of a joint from its target torque, fraction of it; none if all are tightened to
    // yield.
    std::optional<double> torque_error;
};

// Plays the lesson that `driver` shows to its end, or for `longest` s, with the user of that hand.
int play_with_hand(TrainerDriver& driver, trainer::HandMode hand, double longest);

// `session`: the recorded file. Fails the test if it cannot be read.
HandMeasures measure_hand(const TrainerDriver& driver, const std::filesystem::path& session, int presses);

// A row of the table in docs/performance.md.
std::string table_row(const std::string& name, const HandMeasures& measures);

}  // namespace bolt::test
