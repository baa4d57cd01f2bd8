// Registration: the pose that aligns points measured in one frame with the same points in another, and
// measures of its quality; and the tip of a tracked tool, from poses in which it turns about its tip.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/math.hpp"
#include "engine/base/result.hpp"

namespace bolt {

// The same point in two frames, m.
struct PointPair {
    Vec3 from{0.0}, to{0.0};
};

enum class AlignmentFault : std::uint8_t {
    too_few,     // fewer than three points
    not_finite,  // a coordinate is NaN, infinite or larger than max_coordinate
    collinear,   // the points of a frame lie near a line, so a rotation about it is unknown
    mirrored,    // a mirrored copy fits much better: an axis has the wrong sign, or two points are swapped
    scaled,      // distances differ between the frames: wrong unit, or bad tracking
};

// The detail of each error of align_points(). The code of the error is ErrorCode::failed.
struct AlignmentFaultDetail final : ErrorDetail {
    explicit AlignmentFaultDetail(AlignmentFault kind) : fault(kind) {}
    AlignmentFault fault;
};

inline constexpr double max_coordinate = 1e6;  // m

struct AlignmentLimits {
    // Largest difference of the best-fit scale from 1.
    double max_scale_error = 0.01;
    // Least ratio of the second largest to the largest spread (standard deviation along a principal axis).
    double min_width = 0.1;
};
// For points whose scale has been checked.
inline constexpr AlignmentLimits any_scale_limits{std::numeric_limits<double>::infinity(), 0.1};

struct RigidAlignment {
    Pose pose;                      // takes `from` to `to`; w of its unit quaternion is not negative
    double rms = 0.0;               // m, of the residuals
    std::vector<double> residuals;  // m, one per point: distance from pose · from to `to`
    // Scale of the best-fit similarity transform. The pose is rigid: it does not include this scale.
    double scale = 1.0;
    // Ratio of the least to the largest spread of the points, in the frame where this ratio is smaller; 0:
    // the points lie in a plane, where a mirrored set cannot be detected.
    double thickness_ratio = 0.0;
};

// The rigid pose with the least sum of squared residuals, in closed form: the quaternion is the eigenvector
// of the largest eigenvalue of a symmetric matrix (B. K. P. Horn, J. Opt. Soc. Am. A 4 (1987) 629). The scale
// is that of S. Umeyama (IEEE Trans. PAMI 13 (1991) 376, eq. 42). Let r be the rms distance of the points
// from their centroid. Noise of standard deviation s on each axis of one set changes the scale by about
// s / (√n · r): 2 mm of noise on the eight corners of a box of 0.25 × 0.2 × 0.25 m change it by 0.35 %. Noise
// in `from` also divides the scale by 1 + 3 s²/r². Fails with an AlignmentFaultDetail.
Result<RigidAlignment> align_points(std::span<const PointPair> pairs, const AlignmentLimits& limits = {});

// Returns for each point the distance, m, between its measured position in `to` and the position that an
// alignment of the other points predicts; none if the others cannot be aligned. RigidAlignment::rms is
// s·√3·√(1 − 2/n) for noise s and is a poor measure of the pose's error; these distances include that error.
std::vector<std::optional<double>> leave_one_out_residuals(std::span<const PointPair> pairs);

// A tool that was turned about its tip while the tip stayed on one point.
struct PivotFit {
    Vec3 tip{0.0};     // m, in the frame of the tool
    Vec3 pivot{0.0};   // m, the point, in the frame of the poses
    double rms = 0.0;  // m, of the distances between the tip and the point
    // The spread of the orientations. Each direction fixed to the tool has a standard deviation over the
    // poses; this is the least of them. Noise of standard deviation s on each axis of n poses gives an error
    // of the tip below s / (√n · orientation_spread) on each axis. 0: all turns have one axis, and the tip
    // may be anywhere along it.
    double orientation_spread = 0.0;
};
// The least PivotFit::orientation_spread that fit_pivot() accepts: that of turns spread evenly from −15° to
// 15° about each of two axes.
inline constexpr double min_orientation_spread = 0.15;

// The tip t and the point c with the least sum of |R t + p − c|² over the poses (R, p), in closed form:
// linear least squares, "algebraic one step" of Z. Yaniv (Proc. SPIE 9415 (2015) 941527). Fails if a pose is
// not finite, or `orientation_spread` is below min_orientation_spread.
Result<PivotFit> fit_pivot(std::span<const Pose> poses);

// None if one of the residuals is none, or if there are no residuals.
std::optional<double> largest_residual(std::span<const std::optional<double>> residuals);

}  // namespace bolt
