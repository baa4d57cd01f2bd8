// One nut turned one way: torque over the angle turned, each angle once.
//
// A wrench that is put on again and again leaves a record that stands still, drops to no torque and comes
// back. For a comparison only the samples count at which the nut goes further than ever before. Where it
// waits it keeps the torque with which it got there; the start, which it did not get to, keeps the highest
// torque met there (breaking loose).
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"
#include "game/analysis/measured.hpp"
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

// Where a measured curve lies on ours: a rig counts its angle from anywhere.

// Tightening curves are laid upon each other where the torque first passes this share of the end torque that
// both reach: half-way up the elastic line, where the angle is sharpest.
inline constexpr double default_share = 0.5;

struct Alignment {
    double shift = 0.0;      // rad, to be added to the measured angle
    double our_angle = 0.0;  // rad, of the common point
    double measured_angle = 0.0;
    double torque = 0.0;  // N·m, of the common point on the measured curve
};

// Both curves as analysis::advance_curve makes them (each angle once). Tightening: by the running maximum of
// the torque, so that a re-grip or a ripple cannot be taken for the passing; loosening: by the breakaway
// peak.
Result<Alignment> align(const analysis::Curve& ours, const analysis::Curve& measured,
                        double share = default_share);

// How far our torque is from the measured one, stage by stage, as the paper of 2018 states it:
// relative error |T_v − T_a| / T_a, MRE its maximum and MAPE its mean.

struct StageError {
    std::size_t count = 0;  // samples judged
    std::size_t below = 0;  // left out: |T_a| below the floor, where a relative error says nothing
    double mre = 0.0;       // NaN where nothing was judged
    double mape = 0.0;
};

struct Errors {
    std::array<StageError, joint::stage_count> stage;
    StageError all;
    std::size_t outside = 0;  // left out: at angles our curve does not have
    double floor = 0.0;       // N·m; pooled: the largest
};

// Share of a run's highest |T_a| below which a sample is left out: 1 %, what a good torque sensor resolves.
inline constexpr double default_floor_share = 0.01;

// Our torque is taken between samples, our stage from the sample before. `shift` is added to the measured
// angles.
Errors errors_of(const analysis::Curve& ours, const analysis::Curve& measured, double shift, double floor);

// Maximum of the maxima, mean over all samples.
Errors pool(const Errors& a, const Errors& b);

// max |T| · default_floor_share
double floor_of(const analysis::Curve& measured, double share = default_floor_share);

// A session held against a measured record: which error the virtual torque has, stage by stage.

struct Options {
    double share = default_share;              // see align.hpp
    double floor_share = default_floor_share;  // see errors.hpp
};

// A run of the measured file against one joint.
struct CycleComparison {
    Alignment alignment;
    Errors errors;
};

struct JointComparison {
    std::string joint;
    analysis::Curve ours;
    std::vector<CycleComparison> cycles;  // one for each measured curve
    Errors errors;                        // over all cycles
};

struct MeasuredCurve {
    std::string name;       // of the cycle; may be empty
    analysis::Curve curve;  // each angle once
};

struct Comparison {
    std::string session;              // file
    std::string title, law, variant;  // of the session's assembly
    std::string measured_file, source;
    joint::Direction direction = joint::Direction::tighten;
    std::vector<MeasuredCurve> measured;
    std::vector<JointComparison> joints;
    Errors errors;  // over all joints and cycles
    Options options;
};

// Curves against a record; the rest of what a Comparison names is left to the caller.
Result<JointComparison> compare_joint(std::string joint, analysis::Curve ours,
                                      const std::vector<MeasuredCurve>& measured,
                                      const Options& options = {});
std::vector<MeasuredCurve> measured_curves(const Measured& measured);

// `joint`: its id, or empty for every joint that was turned the way the record was. The error says so if none
// was.
Result<Comparison> compare(const session::Reader& session, const Measured& measured, std::string_view joint,
                           const Options& options = {});

}  // namespace bolt::analysis
