// The data of one session as plain values, read once and then drawn: results, curves, metrics, summary and
// the order of the joints.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "content/format/assembly.hpp"
#include "engine/base/result.hpp"
#include "game/analysis/haptic_metrics.hpp"
#include "game/analysis/joint_curve.hpp"
#include "game/lesson/result.hpp"
#include "game/session/session_file.hpp"

namespace bolt::analysis {

struct SessionData {
    std::string file;
    session::Header header;
    bool complete = true;                     // false: cut short
    double recorded_duration = 0.0;           // s, of all ticks
    content::Assembly assembly;               // as stored in the session; its law is the header's
    std::vector<lesson::JointResult> joints;  // one for each of assembly.joints, in their order
    double duration = 0.0;  // s, of the lesson by its result; without one: `recorded_duration`
    double score = 0.0;     // 0…100
    bool finished = false;  // every step is done
    std::vector<lesson::Deduction> reasons;  // for which points were deducted from the score
    std::vector<std::string> pass_texts;     // texts of the pass_begin events, in order
    std::vector<JointCurve> curves;          // one for each of assembly.joints
    HapticMetrics metrics;

    [[nodiscard]] joint::Direction direction() const {
        return header.task == lesson::Task::loosen ? joint::Direction::loosen : joint::Direction::tighten;
    }
};

// The assembly that a session stores, with the session's law applied (lesson::apply_law).
Result<content::Assembly> stored_assembly(const session::SessionReader& session);

Result<SessionData> read_session(const session::SessionReader& session);

// For each joint of the assembly: the result in `given` with its id, or an empty result.
std::vector<lesson::JointResult> results_by_joint(const content::Assembly& assembly,
                                                  const std::vector<lesson::JointResult>& given);

// Target clamp force, N: as specified, or else the clamp force of the target torque at nominal friction.
double target_clamp(const content::Assembly& assembly, std::size_t joint);

// Statistics of the joint results of one session.
struct Summary {
    std::size_t joints = 0, judged = 0, ok = 0;
    // Mean of |T − target| / target over judged joints; NaN without any, or when loosening.
    double mean_torque_error = 0.0;
    double clamp_mean = 0.0, clamp_low = 0.0, clamp_high = 0.0;  // N, over judged joints; NaN without any
    double clamp_deviation = 0.0;         // N, sample standard deviation; NaN below two joints
    std::size_t lowest = 0, highest = 0;  // joints with the extreme clamp forces
};
Summary summarise(const SessionData& session);

// The English title, else that of the first language, else the assembly's name.
std::string title_of(const content::Assembly& assembly);

// A visit in the actual order of the joints.
struct OrderEntry {
    std::size_t joint = 0;
    // Without the visits that are out of turn, the first visits of the joints are in the planned order; as
    // few visits as possible are marked. A repeated visit is never out of turn.
    bool out_of_turn = false;
    bool repeated = false;  // the joint was visited before in this pass
};

// The planned and the actual order of the joints in one pass.
struct PassOrder {
    std::string label;  // "30 %", "run-down", "re-check"
    std::vector<std::size_t> planned;
    std::vector<OrderEntry> actual;  // visits with work, in order of time

    [[nodiscard]] bool in_turn() const;                // no entry is out of turn or repeated
    [[nodiscard]] bool as_planned() const;             // an order was planned, and followed completely
    [[nodiscard]] std::size_t skipped_joints() const;  // number of planned joints without a visit
    // Position of the joint in the order, counted from 1; 0: the joint is not in it. Repeated visits do not
    // count.
    [[nodiscard]] std::size_t planned_position(std::size_t joint) const;
    [[nodiscard]] std::size_t actual_position(std::size_t joint) const;
    [[nodiscard]] std::size_t visits(std::size_t joint) const;
};

// One PassOrder for each pass of the session's task. A tightening session without pass events has a single
// one, with a planned order only if the assembly has exactly one pass.
std::vector<PassOrder> pass_orders(const SessionData& session);

// Passes that followed the same planned order completely share one drawing; every other pass with a visit has
// its own. The label names all passes of the drawing.
struct OrderDrawing {
    PassOrder order;
    std::size_t passes = 1;
};
std::vector<OrderDrawing> order_drawings(const std::vector<PassOrder>& orders);

// English label as in PassOrder::label.
std::string pass_label(const content::Pass& pass);

}  // namespace bolt::analysis
