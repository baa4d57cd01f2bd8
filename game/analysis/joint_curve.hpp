// A stream of samples of unknown length, kept within a fixed size. Peaks are never lost.
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

// One sample of a joint at work.
struct CurvePoint {
    double time = 0.0;    // s from the start of the session
    double angle = 0.0;   // rad, nut angle
    double torque = 0.0;  // N·m at the wrench, tightening positive
    double clamp = 0.0;   // N
    joint::Stage stage = joint::Stage::navigation;
    std::uint16_t stroke = 0;  // counts re-grips of the visit: lines break between strokes
};

// Equal shares of the stream, each kept as its first, lowest, highest (by torque) and last sample. When the
// shares run out, neighbours are joined and the share doubles.
class CurveStream {
  public:
    explicit CurveStream(std::size_t most_buckets = 2048);

    void add(const CurvePoint& point);
    [[nodiscard]] bool empty() const { return buckets_.empty(); }
    [[nodiscard]] std::vector<CurvePoint> points() const;  // in time

  private:
    struct Bucket {
        CurvePoint first, low, high, last;
        std::size_t count = 0;
    };
    static void join(Bucket& into, const Bucket& next);
    void halve();

    std::size_t most_;
    std::size_t share_ = 1;
    std::vector<Bucket> buckets_;
};

// What was done to each joint, from the recorded ticks: torque and clamp force over the nut angle, visit by
// visit.

// From the first grip of a nut to the last before another nut is taken or the next pass begins.
struct Visit {
    int pass = 0;              // counted from 0
    double begin = 0.0;        // s
    double end = 0.0;          // s
    double begin_angle = 0.0;  // rad
    int strokes = 0;           // grips
    bool worked = false;       // the nut turned or the wrench was loaded: more than a touch in passing
    CurvePoint peak;           // highest torque in the direction of work
    CurvePoint release;        // last sample
    std::vector<CurvePoint> points;
};

// Nut angles in rad, in the order they were run through; `from` > `to` when loosening.
struct StageSpan {
    joint::Stage stage = joint::Stage::navigation;
    double from = 0.0;
    double to = 0.0;
};

// The part before the first contact, which the plots leave out.
struct RunDown {
    double angle = 0.0;       // rad turned
    double time = 0.0;        // s with a hand or a wrench on the nut
    double torque_low = 0.0;  // N·m
    double torque_high = 0.0;
};

struct JointCurve {
    std::vector<Visit> visits;
    std::vector<StageSpan> stages;
    RunDown run_down;
    double snug_angle = std::numeric_limits<double>::quiet_NaN();  // rad, where the snug torque was first met
    double start_angle = 0.0;                                      // rad, when first gripped
    double end_angle = 0.0;                                        // rad, furthest in the direction of work
};

struct CurveRequest {
    std::vector<double> snug_torque;  // N·m, one a joint: how many joints there are
    double dt = 0.001;                // s
    joint::Direction direction = joint::Direction::tighten;
    std::vector<std::uint64_t> pass_begins;  // ticks, rising; passes are counted by them
};

// Takes the ticks in order, in pieces of any size; what it holds does not grow with the length of the
// session. Samples that are no finite numbers, or name no joint, are left out.
class CurveBuilder {
  public:
    explicit CurveBuilder(CurveRequest request);

    void add(std::uint64_t first_tick, std::span<const session::TickRecord> ticks);
    std::vector<JointCurve> finish();

  private:
    struct Building {
        JointCurve curve;
        CurveStream stream;
        bool gripped = false;  // in the tick before
        bool started = false;
        bool contact = false;  // the run-down is over
    };
    void begin_visit(Building& joint, const CurvePoint& point, int pass);
    void end_visit(Building& joint);
    void take(Building& joint, CurvePoint point, double snug_torque);
    void advance(Building& joint, const CurvePoint& point, double snug_torque);

    CurveRequest request_;
    double sign_ = 1.0;  // of nut angles and torques that belong to the direction of work
    std::vector<Building> joints_;
    int open_joint_ = -1;  // with a visit under way
    int open_pass_ = 0;
};

}  // namespace bolt::analysis
