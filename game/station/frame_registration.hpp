// Computes a registration of two frames from points, assesses it, and describes it in plain text.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "content/station/registration.hpp"
#include "engine/base/result.hpp"
#include "engine/base/rigid_alignment.hpp"
#include "engine/base/tracker_role.hpp"

namespace bolt::station_setup {

// A registration is good enough for training up to these values, m.
inline constexpr double max_rms = 4e-3;
inline constexpr double max_check_error = 5e-3;

struct RegistrationLimits {
    double rms = max_rms, check_error = max_check_error;
    AlignmentLimits alignment;
    std::size_t advised_points = 6;        // fewer give a warning; the check point does not count
    double advised_thickness_ratio = 0.1;  // of the points; below it a mirrored axis cannot be detected
};
// A glove and a model of the hand give fingertips with an error of some millimetres, and people's hands
// differ from the model's proportions. The drawn hand touches nothing real, so these limits suffice. Mirrored
// points are not possible, because the side of the glove is known, so points in a plane give no warning.
inline constexpr RegistrationLimits limits_of_hand{.rms = 12e-3,
                                                   .check_error = 15e-3,
                                                   .alignment = {.max_scale_error = 0.12, .min_width = 0.1},
                                                   .advised_points = 4,
                                                   .advised_thickness_ratio = 0.0};
// The limits of registrations between these frames.
RegistrationLimits limits_between(content::CoordinateFrame from, content::CoordinateFrame to);

struct MeasuredRegistration {
    content::Registration registration;
    std::vector<double> residuals;  // m, of each point but the check point
    // m, leave_one_out_residuals() of the same points: from each point to where the other points predict it.
    std::vector<std::optional<double>> leave_one_out;
    double check_error = 0.0;      // m, of the check point
    double scale = 1.0;            // distances in `to` divided by those in `from`; not part of the pose
    double thickness_ratio = 0.0;  // least to largest spread of the points; 0: they lie in a plane
};

// Computes the pose of frame `from` in frame `to`. The last pair is the check point: it is not used for the
// pose. Fails with fewer than four pairs, or as align_points() fails, with the same AlignmentFaultDetail.
// `date`: of the measurement, in the form of content::is_utc_date().
Result<MeasuredRegistration> register_frames(content::CoordinateFrame from, content::CoordinateFrame to,
                                             std::span<const PointPair> pairs, const std::string& date);

// The frame of the device that is fixed to a gloved hand: a Vive tracker, or a controller.
constexpr content::CoordinateFrame wrist_frame(const std::optional<TrackerRole>& tracker) {
    return tracker ? content::CoordinateFrame::wrist_tracker : content::CoordinateFrame::controller;
}

// The error of a registration that lessons do not use, because one of its frames is that of a wheel; none for
// other frames. Old station files may contain such a registration.
std::optional<Error> unused_registration(content::CoordinateFrame from, content::CoordinateFrame to);

// A table of the points, and the values that assess the registration.
std::string describe(const MeasuredRegistration& measured);

// Fails if the rms or the error of the check point is too large, and names the point to touch again.
Status check_quality(const MeasuredRegistration& measured);

// Doubts that remain although check_quality() passes: few points, or points in a plane.
std::vector<std::string> warnings_of(const MeasuredRegistration& measured);

// The registration with `from` as its first frame: that of the list, or its inverse. Fails if there is none.
Result<content::Registration> registration_from(std::span<const content::Registration> registrations,
                                                content::CoordinateFrame from, content::CoordinateFrame to);

}  // namespace bolt::station_setup
