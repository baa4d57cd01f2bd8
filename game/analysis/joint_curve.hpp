// Curves of the work on each joint, from the recorded ticks: torque and clamp force over the nut angle, visit
// by visit, decimated to a bounded size.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "game/session/session_file.hpp"
#include "haptics/joint/published.hpp"
#include "haptics/joint/stage.hpp"

namespace bolt::analysis {

// One sample of a joint while it is held.
struct CurvePoint {
    double time = 0.0;    // s from the start of the session
    double angle = 0.0;   // rad, nut angle
    double torque = 0.0;  // N·m at the wrench, tightening positive
    double clamp = 0.0;   // N
    joint::Stage stage = joint::Stage::navigation;
    std::uint16_t hold = 0;  // number of the hold in its visit, from 1; plots draw no line between holds
};

// Decimates a stream of samples of unknown length to a fixed size. Each bucket stands for an equal number of
// samples and keeps the first, the lowest, the highest (by torque) and the last of them. When the buckets are
// full, neighbours are merged in pairs, and a bucket then stands for twice as many samples.
class CurveDecimator {
  public:
    explicit CurveDecimator(std::size_t max_buckets = 2048);

    void add(const CurvePoint& point);
    [[nodiscard]] bool empty() const { return buckets_.empty(); }
    [[nodiscard]] std::vector<CurvePoint> points() const;  // in order of time

  private:
    struct Bucket {
        CurvePoint first, low, high, last;
        std::size_t count = 0;
    };
    static void merge(Bucket& into, const Bucket& next);
    void halve();

    std::size_t max_buckets_;
    std::size_t bucket_samples_ = 1;
    std::vector<Bucket> buckets_;
};

// All holds of a nut until another nut is held or the next pass begins. `end` is the end of the last hold.
struct Visit {
    int pass = 0;              // counted from 0
    double begin = 0.0;        // s
    double end = 0.0;          // s
    double begin_angle = 0.0;  // rad
    int holds = 0;
    bool worked = false;  // the nut turned or the wrench was loaded
    CurvePoint peak;      // highest torque in the direction of work
    CurvePoint release;   // last sample
    std::vector<CurvePoint> points;
};

// A range of nut angles, rad, in one stage; `from` > `to` when loosening.
struct StageSpan {
    joint::Stage stage = joint::Stage::navigation;
    double from = 0.0;
    double to = 0.0;
};

// The part before the first contact with the seat, which the plots omit.
struct RunDown {
    double angle = 0.0;       // rad turned
    double time = 0.0;        // s while fingers or wrench held the nut
    double torque_low = 0.0;  // N·m
    double torque_high = 0.0;
};

struct JointCurve {
    std::vector<Visit> visits;
    std::vector<StageSpan> stages;
    RunDown run_down;
    // rad, nut angle from which the tightening angle counts: where the torque first reached the snug torque.
    // With a pass that turns nuts by an angle: where the first visit in that pass began or, if the nut was
    // off its seat then, where the torque first reached the snug torque in that pass. A nut that leaves its
    // seat loses its mark, as in the lesson. NaN: no mark.
    double mark = std::numeric_limits<double>::quiet_NaN();
    double start_angle = 0.0;  // rad, when first held
    double end_angle = 0.0;    // rad, furthest in the direction of work
};

struct CurveRequest {
    std::vector<double> snug_torque;  // N·m, one for each joint
    double dt = 0.001;                // s
    joint::Direction direction = joint::Direction::tighten;
    std::vector<std::uint64_t> pass_begins;  // first ticks of the passes, ascending
    std::vector<bool> turns_by_angle;        // by pass; empty: no pass of the lesson turns nuts by an angle
};

// Computes the curves from the ticks in order, in pieces of any size, in memory independent of the session's
// length. Ignores samples without a joint and samples that are not finite.
class CurveBuilder {
  public:
    explicit CurveBuilder(CurveRequest request);

    void add(std::uint64_t first_tick, std::span<const session::TickRecord> ticks);
    std::vector<JointCurve> finish();

  private:
    struct JointBuilder {
        JointCurve curve;
        CurveDecimator points;
        bool held = false;  // in the tick before
        bool started = false;
        bool contact = false;  // the run-down is over
    };
    void begin_visit(JointBuilder& joint, const CurvePoint& point, int pass);
    void end_visit(JointBuilder& joint);
    void add_sample(JointBuilder& joint, CurvePoint point, double snug_torque);
    void advance(JointBuilder& joint, const CurvePoint& point, double snug_torque);
    [[nodiscard]] bool turns_by_angle(int pass) const;

    CurveRequest request_;
    double sign_ = 1.0;  // of nut angles and torques in the direction of work
    std::vector<JointBuilder> joints_;
    int open_joint_ = -1;  // joint of the present visit
    int open_pass_ = 0;
};

}  // namespace bolt::analysis
