#include "engine/base/rigid_alignment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

namespace bolt {

namespace {

template <std::size_t N>
using Matrix = std::array<std::array<double, N>, N>;

template <std::size_t N>
struct EigenSystem {
    std::array<double, N> values{};  // descending
    Matrix<N> vectors{};             // vectors[i] belongs to values[i]; orthonormal
};

// Rotates rows and columns p and q of the symmetric matrix so that its element (p, q) becomes zero.
template <std::size_t N>
void jacobi_rotation(Matrix<N>& m, Matrix<N>& vectors, std::size_t p, std::size_t q) {
    const double theta = (m[q][q] - m[p][p]) / (2.0 * m[p][q]);
    const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
    const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
    for (std::size_t i = 0; i < N; ++i) {
        const double a = m[i][p], b = m[i][q];
        m[i][p] = c * a - s * b;
        m[i][q] = s * a + c * b;
    }
    for (std::size_t i = 0; i < N; ++i) {
        const double a = m[p][i], b = m[q][i];
        m[p][i] = c * a - s * b;
        m[q][i] = s * a + c * b;
        const double u = vectors[p][i], v = vectors[q][i];
        vectors[p][i] = c * u - s * v;
        vectors[q][i] = s * u + c * v;
    }
}

// Eigenvalues and eigenvectors of a symmetric matrix by cyclic Jacobi rotations (Golub and Van Loan, Matrix
// Computations, 8.5). They converge quadratically; the bound on the sweeps is never reached.
template <std::size_t N>
EigenSystem<N> eigen_system(Matrix<N> m) {
    EigenSystem<N> result;
    for (std::size_t i = 0; i < N; ++i) result.vectors[i][i] = 1.0;
    for (int sweep = 0; sweep < 50; ++sweep) {
        double off = 0.0, scale = 0.0;
        for (std::size_t p = 0; p < N; ++p)
            for (std::size_t q = 0; q < N; ++q) (p == q ? scale : off) += square(m[p][q]);
        if (off <= 1e-32 * scale) break;
        for (std::size_t p = 0; p < N; ++p)
            for (std::size_t q = p + 1; q < N; ++q)
                if (m[p][q] != 0.0) jacobi_rotation(m, result.vectors, p, q);
    }
    std::array<std::size_t, N> order{};
    for (std::size_t i = 0; i < N; ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return m[a][a] > m[b][b]; });
    const Matrix<N> vectors = result.vectors;
    for (std::size_t i = 0; i < N; ++i) {
        result.values[i] = m[order[i]][order[i]];
        result.vectors[i] = vectors[order[i]];
    }
    return result;
}

// Spread of the points along their principal axes, as ratios of the largest.
struct Spread {
    double width = 0.0, thickness_ratio = 0.0;
};

// `points` are relative to their centroid.
Spread spread_of(std::span<const PointPair> points, Vec3 PointPair::*side) {
    Matrix<3> moments{};
    for (const PointPair& point : points)
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                moments[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] +=
                    (point.*side)[i] * (point.*side)[j];
    const auto values = eigen_system(moments).values;
    if (!(values[0] > 0.0)) return {};
    const auto ratio = [&](double value) { return std::sqrt(std::max(value, 0.0) / values[0]); };
    return {ratio(values[1]), ratio(values[2])};
}

// Horn's matrix of the products of coordinates. The pose's quaternion (w, x, y, z) maximises its quadratic
// form.
Matrix<4> horn_matrix(std::span<const PointPair> centred) {
    double s[3][3] = {};
    for (const PointPair& pair : centred)
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) s[i][j] += pair.from[i] * pair.to[j];
    const auto& [x, y, z] = s;
    return {{{x[0] + y[1] + z[2], y[2] - z[1], z[0] - x[2], x[1] - y[0]},
             {y[2] - z[1], x[0] - y[1] - z[2], x[1] + y[0], z[0] + x[2]},
             {z[0] - x[2], x[1] + y[0], y[1] - x[0] - z[2], y[2] + z[1]},
             {x[1] - y[0], z[0] + x[2], y[2] + z[1], z[2] - x[0] - y[1]}}};
}

tl::unexpected<Error> alignment_error(AlignmentFault fault, std::string what, std::string expected) {
    Error error;
    error.what = std::move(what);
    error.expected = std::move(expected);
    error.detail = std::make_shared<const AlignmentFaultDetail>(fault);
    return fail(std::move(error));
}

Status check_values(std::span<const PointPair> pairs) {
    if (pairs.size() < 3)
        return alignment_error(AlignmentFault::too_few,
                               fmt::format("{} point{} do{} not determine a pose", pairs.size(),
                                           pairs.size() == 1 ? "" : "s", pairs.size() == 1 ? "es" : ""),
                               "at least 3 that are not on a line");
    for (std::size_t i = 0; i < pairs.size(); ++i)
        for (const Vec3& v : {pairs[i].from, pairs[i].to})
            for (int axis = 0; axis < 3; ++axis)
                if (!(std::abs(v[axis]) <= max_coordinate))
                    return alignment_error(AlignmentFault::not_finite,
                                           fmt::format("point {} has the coordinate {:g}", i + 1, v[axis]),
                                           "metres");
    return {};
}

struct CentredPairs {
    std::vector<PointPair> pairs;  // relative to the centroid of each frame
    PointPair centroid;
    double from_square = 0.0, to_square = 0.0;  // sums of squared distances to the centroids
};

CentredPairs centred(std::span<const PointPair> pairs) {
    CentredPairs result;
    const auto n = static_cast<double>(pairs.size());
    for (const PointPair& pair : pairs) {
        result.centroid.from += pair.from / n;
        result.centroid.to += pair.to / n;
    }
    result.pairs.reserve(pairs.size());
    for (const PointPair& pair : pairs) {
        const PointPair one{pair.from - result.centroid.from, pair.to - result.centroid.to};
        result.from_square += glm::dot(one.from, one.from);
        result.to_square += glm::dot(one.to, one.to);
        result.pairs.push_back(one);
    }
    return result;
}

// Let s1 ≥ s2 ≥ s3 be the singular values of the cross-covariance, and d the sign of its determinant. The
// traces of the products of the cross-covariance with
//   the best rotation:    s1 + s2 + d·s3, the largest eigenvalue of Horn's matrix,
//   the best reflection:  s1 + s2 − d·s3, the negative of the least eigenvalue.
// A set counts as mirrored if the reflection leaves less than a quarter of the rotation's squared residuals.
bool is_mirrored(const CentredPairs& sets, const EigenSystem<4>& horn, double thickness_ratio) {
    constexpr double min_thickness = 0.01;  // in a plane a reflection is a rotation too
    const double squares = sets.from_square + sets.to_square;
    const double rotated = squares - 2.0 * horn.values[0], reflected = squares + 2.0 * horn.values[3];
    return thickness_ratio > min_thickness && rotated > 4.0 * std::max(reflected, 1e-12 * squares);
}

}  // namespace

Result<RigidAlignment> align_points(std::span<const PointPair> pairs, const AlignmentLimits& limits) {
    BOLT_TRY(check_values(pairs));
    const CentredPairs sets = centred(pairs);
    const Spread from = spread_of(sets.pairs, &PointPair::from), to = spread_of(sets.pairs, &PointPair::to);
    if (!(std::min(from.width, to.width) >= limits.min_width))
        return alignment_error(
            AlignmentFault::collinear,
            fmt::format("the points lie near a line: their width is {:.2g} of their length",
                        std::min(from.width, to.width)),
            fmt::format("points whose width is at least {:g} of their length", limits.min_width));
    RigidAlignment result;
    result.thickness_ratio = std::min(from.thickness_ratio, to.thickness_ratio);
    const EigenSystem<4> horn = eigen_system(horn_matrix(sets.pairs));
    if (is_mirrored(sets, horn, result.thickness_ratio))
        return alignment_error(AlignmentFault::mirrored, "one set of points is the mirror image of the other",
                               "right-handed axes in both frames, and the points in the same order");
    result.scale = horn.values[0] / sets.from_square;
    if (!(std::abs(result.scale - 1.0) <= limits.max_scale_error))
        return alignment_error(
            AlignmentFault::scaled,
            fmt::format("distances in the second frame are {:.4g} times those in the first", result.scale),
            fmt::format("equal distances, to {:g} %: metres in both, and better tracking",
                        100.0 * limits.max_scale_error));
    const auto& [w, x, y, z] = horn.vectors[0];
    const Quat turn = glm::normalize(Quat(w, x, y, z));
    result.pose.orientation = turn.w < 0.0 ? -turn : turn;
    result.pose.position = sets.centroid.to - result.pose.orientation * sets.centroid.from;
    double squares = 0.0;
    for (const PointPair& pair : pairs) {
        result.residuals.push_back(glm::length(result.pose * pair.from - pair.to));
        squares += square(result.residuals.back());
    }
    result.rms = std::sqrt(squares / static_cast<double>(pairs.size()));
    return result;
}

std::vector<std::optional<double>> leave_one_out_residuals(std::span<const PointPair> pairs) {
    std::vector<std::optional<double>> residuals;
    std::vector<PointPair> others;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        others.assign(pairs.begin(), pairs.end());
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
        const Result<RigidAlignment> aligned = align_points(others, any_scale_limits);
        residuals.push_back(aligned ? std::optional(glm::length(aligned->pose * pairs[i].from - pairs[i].to))
                                    : std::nullopt);
    }
    return residuals;
}

// With the means R̄ and p̄ over the poses, c = R̄ t + p̄ minimises the sum for a given t. The normal
// equations for t are (1 − R̄ᵀ R̄) t = R̄ᵀ p̄ − mean(Rᵀ p). The eigenvalues of their matrix are the variances of
// R e for unit vectors e.
Result<PivotFit> fit_pivot(std::span<const Pose> poses) {
    const auto n = static_cast<double>(poses.size());
    glm::dmat3 turn(0.0);
    Vec3 position(0.0), seen(0.0);  // the means of R, p and Rᵀ p
    for (const Pose& pose : poses) {
        if (!(glm::length(pose.position) <= max_coordinate) || !(glm::length(pose.orientation) > 0.5))
            return fail(ErrorCode::failed, "a pose is not finite", "metres, and a unit quaternion");
        turn += glm::mat3_cast(pose.orientation) / n;
        position += pose.position / n;
        seen += glm::inverse(pose.orientation) * pose.position / n;
    }
    const glm::dmat3 back = glm::transpose(turn), variance = glm::dmat3(1.0) - back * turn;
    Matrix<3> matrix{};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            matrix[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = variance[j][i];
    const EigenSystem<3> axes = eigen_system(matrix);
    PivotFit fit;
    fit.orientation_spread = poses.empty() ? 0.0 : std::sqrt(std::max(axes.values[2], 0.0));
    if (!(fit.orientation_spread >= min_orientation_spread))
        return fail(ErrorCode::failed, "the tool was turned too little, or about one axis only",
                    "turns by 20 degrees or more to each side, about two axes");
    const Vec3 right = back * position - seen;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto& [x, y, z] = axes.vectors[i];
        const Vec3 axis(x, y, z);
        fit.tip += axis * (glm::dot(axis, right) / axes.values[i]);
    }
    fit.pivot = turn * fit.tip + position;
    for (const Pose& pose : poses) {
        const Vec3 error = pose * fit.tip - fit.pivot;
        fit.rms += glm::dot(error, error) / n;
    }
    fit.rms = std::sqrt(fit.rms);
    return fit;
}

std::optional<double> largest_residual(std::span<const std::optional<double>> residuals) {
    std::optional<double> most;
    for (const std::optional<double>& residual : residuals) {
        if (!residual) return std::nullopt;
        most = std::max(most.value_or(0.0), *residual);
    }
    return most;
}

}  // namespace bolt
