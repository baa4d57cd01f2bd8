// Median and quartiles of a few values.
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

// Of type 7 (Hyndman and Fan, Am. Stat. 50 (1996) 361), NumPy's and R's default: straight between the values.
struct Quartiles {
    double low = std::numeric_limits<double>::quiet_NaN(), median = low, high = low;
    std::size_t n = 0;
};

// What is not finite does not count; of nothing all are NaN.
Quartiles quartiles(std::vector<double> values);

// All that a page says of one session, as plain values: read once, then drawn.

struct SessionData {
    std::string file;
    session::Header header;
    bool complete = true;                     // false: cut short
    double recorded = 0.0;                    // s
    content::Assembly assembly;               // as stored in the session; its law is the header's
    std::vector<lesson::JointResult> joints;  // one for each of assembly.joints, in their order
    double duration = 0.0;                    // s
    double score = 0.0;
    bool finished = false;
    std::vector<lesson::ScoreReason> reasons;
    std::vector<std::string> pass_texts;  // what the session's pass_begin events say, in order
    std::vector<JointCurve> curves;       // one for each of assembly.joints
    Feel feel;

    [[nodiscard]] joint::Direction direction() const {
        return header.task == "loosen" ? joint::Direction::loosen : joint::Direction::tighten;
    }
};

// The assembly that is stored in a session as it was played: its law and what that law makes of the targets.
Result<content::Assembly> stored_assembly(const session::Reader& session);

Result<SessionData> read_session(const session::Reader& session);

// Results by joint: those given, by id, or empty ones for joints that were never reached.
std::vector<lesson::JointResult> results_by_joint(const content::Assembly& assembly,
                                                  const std::vector<lesson::JointResult>& given);

// N: what the specification asks, else what its target torque makes with the nominal friction.
double target_clamp(const content::Assembly& assembly, std::size_t joint);

// How the joints of one session came out, in numbers.
struct Summary {
    std::size_t joints = 0, judged = 0, ok = 0;
    double mean_torque_error =
        0.0;  // mean of |T − target| / target over judged joints; NaN without any, or loosening
    double clamp_mean = 0.0, clamp_low = 0.0, clamp_high = 0.0;  // N, over judged joints; NaN without any
    double clamp_deviation = 0.0;         // N, sample standard deviation; NaN below two joints
    std::size_t lowest = 0, highest = 0;  // joints
};
Summary summarise(const SessionData& session);

// English if there is any, else the first language, else the folder's name.
std::string title_of(const content::Assembly& assembly);

// In which order the joints were taken, against the order asked.

struct Turn {
    std::size_t joint = 0;
    bool out_of_turn = false;  // one of the fewest that would have to move for the order to be as asked
    bool again = false;        // it had been taken in this pass already
};

struct PassOrder {
    std::string label;  // "30 %", "run down", "re-check"
    std::vector<std::size_t> asked;
    std::vector<Turn> followed;  // visits that did some work, in time

    [[nodiscard]] bool in_turn() const;          // nothing out of turn or repeated
    [[nodiscard]] bool as_asked() const;         // an order was asked, and followed from first to last
    [[nodiscard]] std::size_t left_out() const;  // asked, but not visited
    // Place in the order, counted from 1; 0 if not in it.
    [[nodiscard]] std::size_t place_asked(std::size_t joint) const;
    [[nodiscard]] std::size_t place_followed(
        std::size_t joint) const;  // its first turn, repeated ones not counted
    [[nodiscard]] std::size_t visits(std::size_t joint) const;
};

// One for each pass of the assembly. A session that tells no passes apart gives one, without an order asked
// if the assembly has several.
std::vector<PassOrder> pass_orders(const SessionData& session);

// Passes that were begun, with those together that followed the same order as asked: one drawing each. The
// label of several names them all.
struct OrderDrawing {
    PassOrder order;
    std::size_t passes = 1;
};
std::vector<OrderDrawing> order_drawings(const std::vector<PassOrder>& orders);

std::string pass_label(const content::Pass& pass);

}  // namespace bolt::analysis
