// All that a page says of one session, as plain values: read once, then drawn.
#pragma once

#include <string>
#include <vector>

#include "content/format/assembly.hpp"
#include "engine/base/result.hpp"
#include "game/analysis/curve.hpp"
#include "game/analysis/haptic_metrics.hpp"
#include "game/lesson/result.hpp"
#include "game/session/session_file.hpp"

namespace bolt::analysis {

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

}  // namespace bolt::analysis
