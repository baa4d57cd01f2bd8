// What must hold in every tick of a lesson, whoever plays it and however badly, and what was met on the way.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "game/hints/hints.hpp"
#include "game/play/course.hpp"

namespace dead_ends {

using namespace bolt;

// Over many lives.
struct Met {
    std::array<int, hints::situation_count> reached{}, left{};  // as they were so, frame by frame
    std::array<int, hints::situation_count> said{};             // by the hints
    std::map<std::string, int> events;                          // by kind; mistakes by what they were
    std::array<int, force::fault_kinds> faults{};               // times that each began
    int undone = 0, damaged = 0, rounded = 0;                   // steps; joints at the end of a life
};

class Watch {
  public:
    Watch(const play::Course& course, Met& met) : course_(course), met_(met) {}

    void tick(const servo::Output& output);
    // Every 16 ticks. `room`: as hints::Scene has it.
    void frame(const servo::Output& output, bool wrench_in_hand, double room, bool asks);
    void trouble(const std::string& what);

    [[nodiscard]] const std::vector<std::string>& troubles() const { return troubles_; }

  private:
    void look_at_output(const servo::Output& output);
    void look_at_joints();
    void look_at_lesson(const servo::Output& output);
    void look_at_marks(const servo::Output& output);
    void look_at_verdicts();

    const play::Course& course_;
    Met& met_;
    std::vector<std::string> troubles_;  // the first few
    std::size_t step_ = 0;
    std::map<std::size_t, std::vector<double>> begun_;  // rad, of all nuts when a step began
    hints::Hints hints_;
    std::optional<hints::Situation> was_;
    force::Fault fault_ = force::Fault::none;
    int frames_ = 0;
};

}  // namespace dead_ends
