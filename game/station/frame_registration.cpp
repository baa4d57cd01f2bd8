#include "game/station/frame_registration.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace bolt::station_setup {

namespace {

std::string pair_name(const content::Registration& one) {
    return fmt::format("{} -> {}", content::name(one.from), content::name(one.to));
}

// Number, from 1, of the point with the largest leave-one-out residual; 0 if no point has one, as with three
// points.
std::size_t worst_point(const MeasuredRegistration& measured) {
    std::size_t worst = 0;
    double most = 0.0;
    for (std::size_t i = 0; i < measured.leave_one_out.size(); ++i) {
        if (measured.leave_one_out[i].value_or(0.0) <= most) continue;
        most = *measured.leave_one_out[i];
        worst = i + 1;
    }
    return worst;
}

RegistrationLimits limits_of(const content::Registration& one) { return limits_between(one.from, one.to); }

}  // namespace

RegistrationLimits limits_between(content::CoordinateFrame from, content::CoordinateFrame to) {
    const bool hand = from == content::CoordinateFrame::hand || to == content::CoordinateFrame::hand;
    return hand ? limits_of_hand : RegistrationLimits{};
}

std::optional<Error> unused_registration(content::CoordinateFrame from, content::CoordinateFrame to) {
    using content::CoordinateFrame;
    if (from != CoordinateFrame::wheel && to != CoordinateFrame::wheel) return std::nullopt;
    return Error{
        ErrorCode::usage,
        fmt::format("a registration between \"{}\" and \"{}\" is not used: a wheel turns one bolt after the "
                    "other, so the workpiece has no place in the room that fits all of them",
                    content::name(from), content::name(to)),
        "a registration of the workpiece or the arm"};
}

Result<MeasuredRegistration> register_frames(content::CoordinateFrame from, content::CoordinateFrame to,
                                             std::span<const PointPair> pairs, const std::string& date) {
    if (pairs.size() < 4)
        return fail(ErrorCode::failed, fmt::format("{} points are too few", pairs.size()),
                    "at least 4, of which the last is the check point");
    const std::span<const PointPair> fitted = pairs.first(pairs.size() - 1);
    BOLT_TRY_ASSIGN(const RigidAlignment aligned, align_points(fitted, limits_between(from, to).alignment));
    MeasuredRegistration measured;
    measured.residuals = aligned.residuals;
    measured.leave_one_out = leave_one_out_residuals(fitted);
    measured.scale = aligned.scale;
    measured.thickness_ratio = aligned.thickness_ratio;
    content::Registration& one = measured.registration;
    one.from = from;
    one.to = to;
    one.date = date;
    one.pose = aligned.pose;
    one.points = static_cast<int>(fitted.size());
    one.rms = aligned.rms;
    one.largest_left_out = largest_residual(measured.leave_one_out);
    one.check_point = pairs.back();
    measured.check_error = content::check_error(one).value_or(0.0);
    return measured;
}

std::string describe(const MeasuredRegistration& measured) {
    const content::Registration& one = measured.registration;
    std::string text =
        fmt::format("{}, {} points\n  point   residual   leave-one-out\n", pair_name(one), one.points);
    for (std::size_t i = 0; i < measured.residuals.size(); ++i)
        text += fmt::format("  {:>5}  {:>6.1f} mm  {}\n", i + 1, measured.residuals[i] / mm,
                            measured.leave_one_out[i]
                                ? fmt::format("{:>6.1f} mm", *measured.leave_one_out[i] / mm)
                                : "     -");
    const RegistrationLimits limits = limits_of(one);
    text += fmt::format("  rms {:.1f} mm, at most {:.0f}; scale {:.4f}\n", one.rms / mm, limits.rms / mm,
                        measured.scale);
    if (one.largest_left_out)
        text += fmt::format("  largest leave-one-out residual {:.1f} mm\n", *one.largest_left_out / mm);
    return text + fmt::format("  check point {:.1f} mm, at most {:.0f}\n", measured.check_error / mm,
                              limits.check_error / mm);
}

Status check_quality(const MeasuredRegistration& measured) {
    const double rms = measured.registration.rms;
    const std::string name = pair_name(measured.registration);
    const RegistrationLimits limits = limits_of(measured.registration);
    const std::size_t worst = worst_point(measured);
    if (!(rms <= limits.rms))
        return fail(ErrorCode::failed, fmt::format("{}: the rms is {:.1f} mm", name, rms / mm),
                    fmt::format("at most {:.0f} mm; {}", limits.rms / mm,
                                worst > 0 ? fmt::format("measure point {} again", worst) : "measure again"));
    if (!(measured.check_error <= limits.check_error))
        return fail(ErrorCode::failed,
                    fmt::format("{}: the check point is off by {:.1f} mm", name, measured.check_error / mm),
                    fmt::format("at most {:.0f} mm; measure again", limits.check_error / mm));
    return {};
}

std::vector<std::string> warnings_of(const MeasuredRegistration& measured) {
    const RegistrationLimits limits = limits_of(measured.registration);
    std::vector<std::string> warnings;
    if (measured.residuals.size() < limits.advised_points)
        warnings.push_back(fmt::format(
            "{} points and a check point are few; {} or more are advised, around the place of work",
            measured.residuals.size(), limits.advised_points));
    if (measured.thickness_ratio < limits.advised_thickness_ratio)
        warnings.emplace_back("the points lie near a plane, so a mirrored axis cannot be detected");
    return warnings;
}

Result<content::Registration> registration_from(std::span<const content::Registration> registrations,
                                                content::CoordinateFrame from, content::CoordinateFrame to) {
    const content::Registration* found = content::find_registration(registrations, from, to);
    if (found == nullptr)
        return fail(ErrorCode::bad_content,
                    fmt::format("the station has no registration between \"{}\" and \"{}\"",
                                content::name(from), content::name(to)),
                    "one that `boltwright station register` has made");
    content::Registration one = *found;
    if (one.from == from) return one;
    std::swap(one.from, one.to);
    one.pose = inverse(one.pose);
    if (one.check_point) std::swap(one.check_point->from, one.check_point->to);
    return one;
}

}  // namespace bolt::station_setup
