// One nut turned one way: torque over the angle turned, each angle once.
//
// A wrench that is put on again and again leaves a record that stands still, drops to no torque and comes
// back. For a comparison only the samples count at which the nut goes further than ever before. Where it
// waits it keeps the torque with which it got there; the start, which it did not get to, keeps the highest
// torque met there (breaking loose).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/result.hpp"
#include "game/session/session_file.hpp"
#include "haptics/joint/published.hpp"
#include "haptics/joint/stage.hpp"

namespace bolt::analysis {

struct Curve {
    joint::Direction direction = joint::Direction::tighten;
    std::vector<double> angle;        // rad turned in the direction, from the first sample; strictly rising
    std::vector<double> torque;       // N·m, tightening positive
    std::vector<joint::Stage> stage;  // empty for a measured curve
    std::size_t passed_over = 0;      // samples at which the nut did not go further

    [[nodiscard]] std::size_t size() const { return angle.size(); }
    [[nodiscard]] bool empty() const { return angle.empty(); }
};

// Takes samples in time. A loosening run starts where the nut was furthest on, and starts anew when it is
// turned further on; a tightening run starts at the first sample.
class AdvanceBuilder {
  public:
    explicit AdvanceBuilder(joint::Direction direction);

    void add(double nut_angle, double torque, joint::Stage stage);
    Curve take();

  private:
    void restart(double nut_angle, double torque, joint::Stage stage);
    void thin();

    Curve curve_;
    double sign_ = 1.0;
    double origin_ = 0.0;  // rad
    double anchor_ = 0.0;  // rad turned, where the last sample was begun
    double step_;          // rad, between samples; doubles when the curve grows too long
};

// A measured run, without stages.
Curve advance_curve(std::span<const double> angle, std::span<const double> torque,
                    joint::Direction direction);

// The session's curves, one a joint of the assembly, in one reading; none for a nut that was never turned
// that way by a degree with torque against it.
Result<std::vector<std::optional<Curve>>> advance_curves(const session::Reader& session, std::size_t joints,
                                                         joint::Direction direction);

}  // namespace bolt::analysis
