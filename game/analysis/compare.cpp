#include "game/analysis/compare.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/base/nearest.hpp"
#include "game/analysis/session_data.hpp"

namespace bolt::analysis {

namespace {

std::vector<std::string> ids_of(const content::Assembly& assembly) {
    std::vector<std::string> ids;
    for (const content::AssemblyJoint& joint : assembly.joints) ids.push_back(joint.design.id);
    return ids;
}

tl::unexpected<Error> unknown_joint(std::string_view joint, const std::vector<std::string>& ids) {
    const std::string near = nearest(joint, ids);
    return fail(ErrorCode::usage, fmt::format("there is no joint '{}' in the session", joint),
                near.empty() ? fmt::format("one of {}", fmt::join(ids, ", ")) : fmt::format("'{}'", near));
}

std::string_view verb(joint::Direction direction) {
    return direction == joint::Direction::tighten ? "tightened" : "loosened";
}

}  // namespace

std::vector<MeasuredCurve> measured_curves(const Measured& measured) {
    std::vector<MeasuredCurve> curves;
    for (const Cycle& cycle : measured.cycles)
        curves.push_back(
            {cycle.name, analysis::advance_curve(cycle.angle, cycle.torque, measured.direction)});
    return curves;
}

Result<JointComparison> compare_joint(std::string joint, analysis::Curve ours,
                                      const std::vector<MeasuredCurve>& measured, const Options& options) {
    JointComparison result;
    result.joint = std::move(joint);
    result.ours = std::move(ours);
    for (const MeasuredCurve& cycle : measured) {
        CycleComparison one;
        BOLT_TRY_ASSIGN(const auto alignment, align(result.ours, cycle.curve, options.share));
        one.alignment = alignment;
        one.errors = errors_of(result.ours, cycle.curve, one.alignment.shift,
                               floor_of(cycle.curve, options.floor_share));
        result.errors = pool(result.errors, one.errors);
        result.cycles.push_back(one);
    }
    return result;
}

Result<Comparison> compare(const session::Reader& session, const Measured& measured, std::string_view joint,
                           const Options& options) {
    BOLT_TRY_ASSIGN(const auto assembly, analysis::stored_assembly(session));
    const std::vector<std::string> ids = ids_of(assembly);
    if (!joint.empty() && std::find(ids.begin(), ids.end(), joint) == ids.end())
        return unknown_joint(joint, ids);

    BOLT_TRY_ASSIGN(auto ours, analysis::advance_curves(session, ids.size(), measured.direction));

    Comparison result;
    result.session = session.file();
    result.title = title_of(assembly);
    result.law = session.header().law;
    result.variant = session.header().variant;
    result.measured_file = measured.file;
    result.source = measured.source;
    result.direction = measured.direction;
    result.measured = measured_curves(measured);
    result.options = options;
    for (std::size_t j = 0; j < ids.size(); ++j) {
        if (!ours[j] || (!joint.empty() && ids[j] != joint)) continue;
        BOLT_TRY_ASSIGN(auto one, compare_joint(ids[j], std::move(*ours[j]), result.measured, options));
        result.errors = pool(result.errors, one.errors);
        result.joints.push_back(std::move(one));
    }
    if (result.joints.empty()) {
        Error error;
        error.file = session.file();
        error.what = joint.empty() ? fmt::format("no joint was {} in this session", verb(measured.direction))
                                   : fmt::format("joint '{}' was not {} in this session", joint,
                                                 verb(measured.direction));
        error.expected =
            fmt::format("a session in which it was {}, as in {}", verb(measured.direction), measured.file);
        return fail(std::move(error));
    }
    return result;
}

}  // namespace bolt::analysis
