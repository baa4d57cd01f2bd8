// Checks invariants in every tick of a lesson, and counts the situations, events and faults that occur.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "game/lesson/hints.hpp"
#include "game/session/lesson_session.hpp"
#include "tests/support/haptic_world.hpp"

namespace dead_ends {

using namespace bolt;

// Counts over all lives.
struct Coverage {
    std::array<int, lesson::situation_count> reached{}, left{};  // by frame
    std::array<int, lesson::situation_count> hinted{};           // by hint
    std::map<std::string, int> events;                           // by kind; mistakes by cause
    std::array<int, force::fault_kinds> faults{};                // occurrences
    int undone = 0, damaged = 0, rounded = 0;                    // steps; joints at the end of a life
};

class InvariantChecker {
  public:
    InvariantChecker(const session::LessonSession& session, Coverage& coverage)
        : session_(session), coverage_(coverage), world_(session.state().joints.size()) {}

    void tick(const servo::Output& output);
    // Call every 16 ticks. `free_swing`: world::WorkingHand::free_swing. `hint_key`: the trainee requests a
    // hint.
    void frame(const servo::Output& output, bool wrench_in_hand, double free_swing, bool hint_key);
    void report(const std::string& what);

    [[nodiscard]] const std::vector<std::string>& problems() const { return problems_; }

  private:
    void check_output(const servo::Output& output);
    void check_joints();
    void check_lesson(const servo::Output& output);
    void check_checkpoints(const servo::Output& output);
    void check_verdicts();

    const session::LessonSession& session_;
    Coverage& coverage_;
    test::HapticWorld world_;
    std::vector<std::string> problems_;  // the first five
    std::size_t step_ = 0;
    std::map<std::size_t, std::vector<double>> begun_;  // rad, angles of all nuts at the start of each step
    lesson::HintState hints_;
    std::optional<lesson::Situation> previous_;
    force::Fault fault_ = force::Fault::none;
    int frames_ = 0;
};

}  // namespace dead_ends
