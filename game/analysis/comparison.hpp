// Comparison of a session with a measured record: the torque-angle curves of both, their alignment, and the
// error of the virtual torque in each stage.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/math.hpp"
#include "engine/base/result.hpp"
#include "game/analysis/measured.hpp"
#include "game/session/session_file.hpp"
#include "haptics/joint/published.hpp"
#include "haptics/joint/stage.hpp"

namespace bolt::analysis {

// Torque over the angle that a nut was turned in one direction, each angle once.
//
// With repeated strokes the recorded angle pauses and the torque drops to zero in between. The curve keeps
// only the samples at which the nut advances beyond all previous angles. While the nut pauses, the curve
// keeps the torque with which it arrived; at the start it keeps the highest torque before the nut moves
// (breakaway).
struct TorqueCurve {
    joint::Direction direction = joint::Direction::tighten;
    std::vector<double> angle;   // rad turned in the direction since the first sample, strictly ascending
    std::vector<double> torque;  // N·m, tightening positive
    std::vector<joint::Stage> stage;  // empty for a measured curve
    std::size_t skipped = 0;          // samples at which the nut did not advance

    [[nodiscard]] std::size_t size() const { return angle.size(); }
    [[nodiscard]] bool empty() const { return angle.empty(); }
};

// Builds a curve from samples in order of time. A tightening run starts at the first sample. A loosening run
// starts at the tightest angle, and restarts when the nut is tightened beyond it.
class TorqueCurveBuilder {
  public:
    explicit TorqueCurveBuilder(joint::Direction direction);

    void add(double nut_angle, double torque, joint::Stage stage);
    TorqueCurve finish();

  private:
    void restart(double nut_angle, double torque, joint::Stage stage);
    void thin();

    TorqueCurve curve_;
    double sign_ = 1.0;
    double origin_ = 0.0;  // rad
    double anchor_ = 0.0;  // rad turned when the last sample was added
    double step_;  // rad; samples this close behind anchor_ are merged; grows when the curve is too long
};

// The curve of a measured run, without stages.
TorqueCurve make_torque_curve(std::span<const double> angle, std::span<const double> torque,
                              joint::Direction direction);

// The session's curves, one for each joint of the assembly; none for a nut that turned by less than 1° in
// this direction, or had no torque in it.
Result<std::vector<std::optional<TorqueCurve>>> torque_curves(const session::SessionReader& session,
                                                              std::size_t joints, joint::Direction direction);

// Tightening curves are aligned where the torque first passes this share of the highest torque that both
// reach: half-way up the elastic line, where the angle is best defined.
inline constexpr double default_alignment_share = 0.5;

// The shift that aligns a measured curve with a simulated one; a rig may count its angle from any origin.
struct Alignment {
    double shift = 0.0;  // rad, added to the measured angle
    // The point of each curve at which both are aligned: its angles, rad, and its torque, N·m, on the
    // measured curve.
    double simulated_angle = 0.0;
    double measured_angle = 0.0;
    double torque = 0.0;
};

// Aligns curves from make_torque_curve(). Tightening: where the running maximum of the torque passes `share`
// of the highest torque that both reach, so that a ripple or a re-grip does not move the point. Loosening: at
// the breakaway peak. Fails if a curve is empty, or if tightening curves share no positive torque.
Result<Alignment> align(const TorqueCurve& simulated, const TorqueCurve& measured,
                        double share = default_alignment_share);

// Error of the simulated torque T_v against the measured torque T_a in one stage, as in the paper of 2018:
// relative error |T_v − T_a| / T_a, MRE its maximum and MAPE its mean.
struct StageError {
    std::size_t count = 0;  // samples used for the relative errors
    std::size_t below = 0;  // samples without a relative error, because |T_a| is below the floor
    double mre = nan;       // maximum over the samples that are not near zero; NaN without any
    double mape = 0.0;      // NaN without samples
    double rmse = 0.0;      // N·m, root of the mean of (T_v − T_a)² of all samples, below the floor too
};

struct TorqueErrors {
    std::array<StageError, joint::stage_count> stage;
    StageError all;
    std::size_t outside = 0;  // samples excluded: angles outside the simulated curve
    // N·m; a sample with a smaller |T_a| has no relative error. After pool(): the largest floor.
    double relative_error_floor = 0.0;
};

// Share of a run's highest |T_a| below which a sample has no relative error: 1 %, the resolution of a good
// torque sensor.
inline constexpr double default_floor_share = 0.01;

// Share of a run's highest |T_a| below which a sample does not enter the MRE: 5 %, at which a joint counts as
// released. Close to zero the maximum of relative errors shows only how close to zero a sample was.
inline constexpr double near_zero_share = 0.05;

// Errors at the measured samples. Interpolates the simulated torque; the stage is that of the simulated
// sample before. `shift`: rad, added to the measured angles. `floor`: N·m; a sample with a smaller |T_a| has
// no relative error. `mre_floor`: N·m; a sample with a smaller |T_a| does not enter the MRE.
TorqueErrors torque_errors(const TorqueCurve& simulated, const TorqueCurve& measured, double shift,
                           double floor, double mre_floor = 0.0);

// Combines errors: maximum of the maxima, mean over all samples.
TorqueErrors pool(const TorqueErrors& a, const TorqueErrors& b);

// max |T| · share, N·m: with the default share the floor of the errors, with 1 the peak.
double share_of_peak(const TorqueCurve& curve, double share = default_floor_share);

struct ComparisonOptions {
    double share = default_alignment_share;  // of the highest common torque, for align()
    // Shares of the measured peak that give `floor` and `mre_floor` of torque_errors().
    double floor_share = default_floor_share;
    double mre_floor_share = near_zero_share;
    bool same_joint = false;  // the user asserts that the record is of this joint: its curves are not judged
};

// One run of the measured file compared with one joint.
struct CycleComparison {
    Alignment alignment;
    TorqueErrors errors;
    // Relative to the measured value, with sign; NaN where there is none.
    double slope_error = nan;      // of the regression lines over the angles of the linear stage
    double breakaway_error = nan;  // of the highest loosening torque
};

// The slope error of a run: both regression lines over the measured samples at which the simulated joint is
// in its linear stage. NaN with fewer than 4 samples or without a rise.
double slope_error(const TorqueCurve& simulated, const TorqueCurve& measured, double shift);

struct JointComparison {
    std::string joint;
    TorqueCurve simulated;
    std::vector<CycleComparison> cycles;  // one for each measured curve
    TorqueErrors errors;                  // over all cycles
    // Why the record is of another joint than this one. The errors are then not computed, because they would
    // have no meaning. Empty: the record may be of this joint.
    std::string mismatch_reason;
};

struct MeasuredCurve {
    std::string name;   // of the cycle; may be empty
    TorqueCurve curve;  // each angle once
};

struct Comparison {
    std::string session;              // file
    std::string title, law, variant;  // of the session's assembly
    std::string measured_file, source, thread;
    joint::Direction direction = joint::Direction::tighten;
    std::vector<MeasuredCurve> measured;
    std::vector<JointComparison> joints;
    TorqueErrors errors;  // over all joints and cycles
    ComparisonOptions options;
};

// Compares a joint's curve with the measured curves. Fails if a curve cannot be aligned.
Result<JointComparison> compare_joint(std::string joint, TorqueCurve simulated,
                                      const std::vector<MeasuredCurve>& measured,
                                      const ComparisonOptions& options = {});
std::vector<MeasuredCurve> measured_curves(const MeasuredRecord& measured);

// `joint`: an id, or empty for every joint that was turned in the direction of the record. Fails if there is
// none.
Result<Comparison> compare(const session::SessionReader& session, const MeasuredRecord& measured,
                           std::string_view joint, const ComparisonOptions& options = {});

}  // namespace bolt::analysis
