// A session held against a measured record: which error the virtual torque has, stage by stage.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"
#include "game/analysis/align.hpp"
#include "game/analysis/errors.hpp"
#include "game/analysis/measured.hpp"
#include "game/analysis/torque_envelope.hpp"
#include "game/session/session_file.hpp"

namespace bolt::analysis {

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
