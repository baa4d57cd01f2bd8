#include "tests/trainer_app/hand_comparison.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cstdlib>

#include "game/analysis/session_data.hpp"
#include "game/lesson/step_requirements.hpp"
#include "tests/support/need.hpp"
#include "tests/trainer_app/free_hand_user.hpp"
#include "tests/trainer_app/simulated_user.hpp"

namespace bolt::test {

bool compares_hands() {
    return std::getenv("BOLTWRIGHT_COMPARE_HANDS") !=
           nullptr;  // NOLINT(concurrency-mt-unsafe): nothing sets it
}

int play_with_hand(TrainerDriver& driver, trainer::HandMode hand, double longest) {
    if (hand == trainer::HandMode::free) {
        FreeHandUser user(driver);
        user.play(longest);
        return user.presses;
    }
    SimulatedUser user(driver);
    user.play(longest);
    return user.presses;
}

HandMeasures measure_hand(const TrainerDriver& driver, const std::filesystem::path& session, int presses) {
    const session::SessionReader reader = need(session::SessionReader::open(session));
    const analysis::SessionData data = need(analysis::read_session(reader));
    HandMeasures measures{
        data.finished, data.duration, presses, data.score, data.metrics.obstacle_contacts.size(),
        0.0,           std::nullopt};
    for (const analysis::ObstacleContact& contact : data.metrics.obstacle_contacts)
        measures.bump_seconds += contact.length;
    const lesson::Lesson& lesson = driver.lesson().session->lesson();
    for (std::size_t i = 0; i < data.joints.size(); ++i) {
        double target = 0.0;
        for (const lesson::LessonStep& step : lesson.steps)
            if (step.joint == i && step.kind == lesson::StepKind::tighten &&
                !lesson::requires_yield(lesson, step))
                target = std::max(target, step.torque);
        if (target > 0.0)
            measures.torque_error =
                std::max(measures.torque_error.value_or(0.0), std::abs(data.joints[i].torque / target - 1.0));
    }
    return measures;
}

std::string table_row(const std::string& name, const HandMeasures& m) {
    return fmt::format("| {} | {:.0f} | {} | {:.0f} | {} | {:.1f} | {} |{}", name, m.seconds, m.presses,
                       m.score, m.bumps, m.bump_seconds,
                       m.torque_error ? fmt::format("{:.1f}", 100.0 * *m.torque_error) : "–",
                       m.finished ? "" : " not finished");
}

}  // namespace bolt::test
