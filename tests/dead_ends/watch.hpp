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

// Counts over many lives.
struct Met {
    std::array<int, lesson::situation_count> reached{}, left{};  // by frame
    std::array<int, lesson::situation_count> said{};             // by the hints
    std::map<std::string, int> events;                           // by kind; mistakes by what they were
    std::array<int, force::fault_kinds> faults{};                // times that each fault began
    int undone = 0, damaged = 0, rounded = 0;                    // steps; joints at the end of a life
};

class Watch {
  public:
    Watch(const session::Course& course, Met& met)
        : course_(course), met_(met), world_(course.state().joints.size()) {}

    void tick(const servo::Output& output);
    // Every 16 ticks. `room`: as world::Hand has it.
    void frame(const servo::Output& output, bool wrench_in_hand, double room, bool asks);
    void trouble(const std::string& what);

    [[nodiscard]] const std::vector<std::string>& troubles() const { return troubles_; }

  private:
    void look_at_output(const servo::Output& output);
    void look_at_joints();
    void look_at_lesson(const servo::Output& output);
    void look_at_marks(const servo::Output& output);
    void look_at_verdicts();

    const session::Course& course_;
    Met& met_;
    test::HapticWorld world_;
    std::vector<std::string> troubles_;  // the first five
    std::size_t step_ = 0;
    std::map<std::size_t, std::vector<double>> begun_;  // rad, of all nuts when a step began
    lesson::Hints hints_;
    std::optional<lesson::Situation> was_;
    force::Fault fault_ = force::Fault::none;
    int frames_ = 0;
};

}  // namespace dead_ends
