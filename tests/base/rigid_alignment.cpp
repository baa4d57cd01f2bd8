#include "engine/base/rigid_alignment.hpp"

#include <doctest/doctest.h>

#include <functional>

#include "engine/base/random.hpp"

namespace rigid_alignment_test {

using namespace bolt;

namespace {

Vec3 noise(Random& random, double sigma) {
    return sigma * Vec3(random.normal(), random.normal(), random.normal());
}

Pose any_pose(Random& random) {
    return {{random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)}, random_turn(random)};
}

// Points in a cube of 0.4 m, and their images with noise of `sigma` m on each axis.
std::vector<PointPair> any_pairs(Random& random, const Pose& pose, int count, double sigma) {
    std::vector<PointPair> pairs;
    for (int i = 0; i < count; ++i) {
        const Vec3 from(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2));
        pairs.push_back({from, pose * from + noise(random, sigma)});
    }
    return pairs;
}

std::optional<AlignmentFault> fault_of(std::span<const PointPair> pairs) {
    const Result<RigidAlignment> aligned = align_points(pairs);
    if (aligned) return std::nullopt;
    CHECK(!aligned.error().what.empty());
    CHECK(!aligned.error().expected.empty());
    return dynamic_cast<const AlignmentFaultDetail&>(*aligned.error().detail).fault;
}

double angle_between(const Quat& a, const Quat& b) { return glm::length(turn_between(a, b)); }

double squares_of(std::span<const PointPair> pairs, const Pose& pose) {
    double squares = 0.0;
    for (const PointPair& pair : pairs) {
        const Vec3 off = pose * pair.from - pair.to;
        squares += glm::dot(off, off);
    }
    return squares;
}

constexpr double box_x = 0.125, box_y = 0.1, box_z = 0.125;  // m, half of a box of 0.25 × 0.2 × 0.25 m

Vec3 corner(unsigned i) {
    return {(i & 4U) != 0 ? box_x : -box_x, (i & 2U) != 0 ? box_y : -box_y, (i & 1U) != 0 ? box_z : -box_z};
}

// rms errors, m, at the centroid of the touched corners and 0.3 m from it in random directions.
struct PoseError {
    double centre = 0.0, away = 0.0;
};

PoseError measured_error(std::span<const unsigned> corners, double sigma, int trials) {
    Random random(42);
    PoseError sum;
    for (int trial = 0; trial < trials; ++trial) {
        const Pose pose = any_pose(random);
        std::vector<PointPair> pairs;
        Vec3 centre(0.0);
        for (const unsigned i : corners) {
            pairs.push_back({corner(i), pose * corner(i) + noise(random, sigma)});
            centre += corner(i) / static_cast<double>(corners.size());
        }
        const Result<RigidAlignment> aligned = align_points(pairs, any_scale_limits);
        REQUIRE(aligned);
        const Vec3 away = centre + 0.3 * random_direction(random);
        const auto squared_error = [&](const Vec3& point) {
            const Vec3 off = aligned->pose * point - pose * point;
            return glm::dot(off, off);
        };
        sum.centre += squared_error(centre) / trials;
        sum.away += squared_error(away) / trials;
    }
    return {std::sqrt(sum.centre), std::sqrt(sum.away)};
}

}  // namespace

TEST_CASE("Rigid alignment: exact points give the exact pose, without residuals") {
    Random random(1);
    for (int trial = 0; trial < 2000; ++trial) {
        const Pose pose = any_pose(random);
        std::vector<PointPair> pairs = any_pairs(random, pose, 3 + trial % 8, 0.0);
        const Result<RigidAlignment> aligned = align_points(pairs);
        if (!aligned) {  // random triangles may be slender
            REQUIRE(fault_of(pairs) == AlignmentFault::collinear);
            continue;
        }
        REQUIRE(glm::length(aligned->pose.position - pose.position) < 1e-12);
        REQUIRE(angle_between(aligned->pose.orientation, pose.orientation) < 1e-12);
        REQUIRE(std::abs(glm::length(aligned->pose.orientation) - 1.0) < 1e-15);
        REQUIRE(aligned->pose.orientation.w >= 0.0);
        REQUIRE(aligned->rms < 1e-13);
        REQUIRE(std::abs(aligned->scale - 1.0) < 1e-12);
        for (const auto& residual : leave_one_out_residuals(pairs))
            if (residual) REQUIRE(*residual < 1e-11);
    }
}

TEST_CASE("Rigid alignment: half turns about every axis and the identity are exact") {
    const std::vector<Vec3> points{{0.1, 0, 0}, {0, 0.2, 0}, {0, 0, 0.3}, {0.1, 0.1, 0.1}};
    for (const Quat& turn : {Quat(1, 0, 0, 0), Quat(0, 1, 0, 0), Quat(0, 0, 1, 0), Quat(0, 0, 0, 1)}) {
        std::vector<PointPair> pairs;
        for (const Vec3& point : points) pairs.push_back({point, turn * point});
        const Result<RigidAlignment> aligned = align_points(pairs);
        REQUIRE(aligned);
        CHECK(angle_between(aligned->pose.orientation, turn) < 1e-14);
    }
}

TEST_CASE("Rigid alignment: the pose is a least-squares minimum at every level of noise") {
    Random random(2);
    for (const double sigma : {1e-6, 1e-4, 1e-3, 5e-3, 3e-2})
        for (int trial = 0; trial < 200; ++trial) {
            const Pose pose = any_pose(random);
            const std::vector<PointPair> pairs = any_pairs(random, pose, 4 + trial % 6, sigma);
            const Result<RigidAlignment> aligned = align_points(pairs, any_scale_limits);
            if (!aligned) continue;
            const double least = squares_of(pairs, aligned->pose);
            REQUIRE(aligned->rms ==
                    doctest::Approx(std::sqrt(least / static_cast<double>(pairs.size()))).epsilon(1e-9));
            REQUIRE(least <= squares_of(pairs, pose) * (1.0 + 1e-9) + 1e-24);
            for (int step = 0; step < 10; ++step) {
                Pose other = aligned->pose;
                other.position += noise(random, 0.1 * sigma);
                other.orientation = rotation(noise(random, sigma)) * other.orientation;
                REQUIRE(squares_of(pairs, other) >= least * (1.0 - 1e-9));
            }
        }
}

TEST_CASE("Rigid alignment: moving both frames moves the pose, and the inverse problem gives the inverse") {
    Random random(3);
    for (int trial = 0; trial < 300; ++trial) {
        const std::vector<PointPair> pairs = any_pairs(random, any_pose(random), 6, 2e-3);
        const Pose a = any_pose(random), b = any_pose(random);
        std::vector<PointPair> moved, swapped;
        for (const PointPair& pair : pairs) {
            moved.push_back({a * pair.from, b * pair.to});
            swapped.push_back({pair.to, pair.from});
        }
        const auto first = align_points(pairs, any_scale_limits),
                   second = align_points(moved, any_scale_limits),
                   third = align_points(swapped, any_scale_limits);
        REQUIRE((first && second && third));
        const Pose expected = b * first->pose * inverse(a), back = inverse(first->pose);
        REQUIRE(glm::length(second->pose.position - expected.position) < 1e-11);
        REQUIRE(angle_between(second->pose.orientation, expected.orientation) < 1e-11);
        REQUIRE(glm::length(third->pose.position - back.position) < 1e-11);
        REQUIRE(angle_between(third->pose.orientation, back.orientation) < 1e-11);
        REQUIRE(second->rms == doctest::Approx(first->rms));
    }
}

// The error that least squares gives to first order: 3σ²/n at the centroid, and the rotation with the
// covariance σ² J⁻¹, J = Σ(|p|² I − p pᵀ), at a distance r in random directions adds 2/3 r² tr(σ² J⁻¹).
TEST_CASE("Rigid alignment: the error for 2 mm of noise on the corners of a box is that of the theory") {
    struct Row {
        std::vector<unsigned> corners;
        double centre, away;   // mm, as published for this box; rounded, and for other subsets of the corners
        double inverse_trace;  // 1/m², tr J⁻¹
    };
    const std::vector<Row> rows{{{0, 3, 5}, 2.0, 3.8, 46.0},
                                {{0, 3, 5, 6}, 1.7, 3.0, 27.51},
                                {{0, 1, 2, 5, 6, 7}, 1.4, 2.6, 19.5},
                                {{0, 1, 2, 3, 4, 5, 6, 7}, 1.2, 2.2, 13.76}};
    const double sigma = 2e-3;
    for (const Row& row : rows) {
        const auto n = static_cast<double>(row.corners.size());
        CAPTURE(n);
        const PoseError error = measured_error(row.corners, sigma, 20000);
        CHECK(std::abs(error.centre - row.centre * mm) < 0.15 * mm);
        CHECK(std::abs(error.away - row.away * mm) < 0.15 * mm);
        // Random::normal() is clamped to ±3, which lowers the deviation a little.
        const double centre = sigma * std::sqrt(3.0 / n);
        CHECK(error.centre == doctest::Approx(centre).epsilon(0.03));
        CHECK(error.away ==
              doctest::Approx(std::hypot(centre, sigma * 0.3 * std::sqrt(2.0 / 3.0 * row.inverse_trace)))
                  .epsilon(0.03));
        MESSAGE("n " << n << ": " << error.centre / mm << " / " << error.away / mm << " mm");
    }
}

TEST_CASE("Rigid alignment: the rms hides the error of the pose, and the points kept out show it") {
    Random random(5);
    const double sigma = 2e-3;
    double rms = 0.0, left_out = 0.0;
    const int trials = 4000;
    for (int trial = 0; trial < trials; ++trial) {
        std::vector<PointPair> pairs;
        for (const unsigned i : {0U, 3U, 5U, 6U})
            pairs.push_back({corner(i), corner(i) + noise(random, sigma)});
        rms += square(align_points(pairs, any_scale_limits)->rms) / trials;
        for (const auto& residual : leave_one_out_residuals(pairs))
            left_out += square(residual.value()) / (4.0 * trials);
    }
    CHECK(std::sqrt(rms) ==
          doctest::Approx(sigma * std::sqrt(3.0) * std::sqrt(1.0 - 2.0 / 4.0)).epsilon(0.03));
    CHECK(std::sqrt(left_out) > 2.0 * std::sqrt(rms));
    CHECK(std::sqrt(left_out) > std::sqrt(3.0) * sigma);  // the noise of the point itself, and the pose
}

TEST_CASE("Rigid alignment: one point that is wrong has the largest left-out residual") {
    Random random(6);
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<PointPair> pairs;
        const Pose pose = any_pose(random);
        for (unsigned i = 0; i < 8; ++i)
            pairs.push_back({corner(i), pose * corner(i) + noise(random, 0.5e-3)});
        const auto wrong = static_cast<std::size_t>(trial % 8);
        pairs[wrong].to += 0.02 * random_direction(random);
        const auto residuals = leave_one_out_residuals(pairs);
        REQUIRE(largest_residual(residuals) == residuals[wrong]);
        REQUIRE(*residuals[wrong] > 0.015);
    }
}

TEST_CASE("Rigid alignment: fewer than three points, and sets near a line, are refused") {
    Random random(7);
    CHECK(fault_of({}) == AlignmentFault::too_few);
    const std::vector<PointPair> two = any_pairs(random, {}, 2, 0.0);
    CHECK(fault_of(two) == AlignmentFault::too_few);
    CHECK(align_points(two).error().message() ==
          "2 points do not determine a pose; expected at least 3 that are not on a line");
    for (int trial = 0; trial < 200; ++trial) {
        const Pose pose = any_pose(random);
        const Vec3 along = 0.1 * random_direction(random);
        std::vector<PointPair> pairs;
        for (int i = 0; i < 3 + trial % 5; ++i) {
            const Vec3 from = along * static_cast<double>(i) + noise(random, 1e-3);
            pairs.push_back({from, pose * from + noise(random, 1e-3)});
        }
        REQUIRE(fault_of(pairs) == AlignmentFault::collinear);
    }
    CHECK(fault_of(std::vector<PointPair>(5)) == AlignmentFault::collinear);  // all in one place
    // The other frame alone may be near a line.
    std::vector<PointPair> squashed = any_pairs(random, {}, 6, 0.0);
    for (PointPair& pair : squashed) pair.to.y = pair.to.z = 0.0;
    CHECK(fault_of(squashed) == AlignmentFault::collinear);
    // Without the third point the others of a square do not fail; without its corner a triangle does.
    const std::vector<PointPair> flat = {{{0, 0, 0}, {0, 0, 0}},
                                         {{0.1, 0, 0}, {0.1, 0, 0}},
                                         {{0.2, 0, 0}, {0.2, 0, 0}},
                                         {{0, 0.2, 0}, {0, 0.2, 0}}};
    const auto residuals = leave_one_out_residuals(flat);
    CHECK(residuals[0].has_value());
    CHECK(!residuals[3].has_value());
    CHECK(!largest_residual(residuals));
    CHECK(!largest_residual({}));
    CHECK(align_points(flat)->thickness_ratio < 1e-6);
}

TEST_CASE("Rigid alignment: mirrored and swapped sets are refused, noisy and flat ones are not") {
    Random random(8);
    for (int trial = 0; trial < 500; ++trial) {
        const Pose pose = any_pose(random);
        std::vector<PointPair> pairs;
        for (unsigned i = 0; i < 8; ++i)
            pairs.push_back({corner(i), pose * corner(i) + noise(random, trial % 4 * 1e-3)});
        REQUIRE(align_points(pairs, any_scale_limits));
        for (PointPair& pair : pairs) pair.from[trial % 3] *= -1.0;
        REQUIRE(fault_of(pairs) == AlignmentFault::mirrored);
        // In a plane a reflection is a rotation too.
        for (PointPair& pair : pairs) {
            pair.from.y = 0.0;
            pair.to = pose * pair.from + noise(random, trial % 4 * 1e-3);
            pair.from.z *= -1.0;
        }
        REQUIRE(fault_of(pairs) != AlignmentFault::mirrored);
    }
}

TEST_CASE("Rigid alignment: a scale that is off by more than 1 % is refused, and reported without a limit") {
    Random random(9);
    for (const double scale : {1000.0, 2.0, 1.011, 1.0, 0.989, 0.001}) {
        CAPTURE(scale);
        const Pose pose = any_pose(random);
        std::vector<PointPair> pairs = any_pairs(random, pose, 7, 0.0);
        for (PointPair& pair : pairs) pair.to *= scale;
        const std::optional<AlignmentFault> fault = fault_of(pairs);
        if (scale == 1.0)
            CHECK(!fault.has_value());
        else
            CHECK(fault == AlignmentFault::scaled);
        CHECK(align_points(pairs, any_scale_limits)->scale == doctest::Approx(scale).epsilon(1e-9));
    }
}

TEST_CASE("Rigid alignment: the noise of a good tracker seldom looks like a wrong scale") {
    Random random(11);
    int refused = 0;
    const int trials = 5000;
    for (int trial = 0; trial < trials; ++trial) {
        std::vector<PointPair> pairs;
        for (unsigned i = 0; i < 8; ++i) pairs.push_back({corner(i), corner(i) + noise(random, 2e-3)});
        const std::optional<AlignmentFault> fault = fault_of(pairs);
        if (fault) REQUIRE(*fault == AlignmentFault::scaled);
        refused += fault ? 1 : 0;
    }
    MESSAGE(refused << " of " << trials);
    CHECK(refused < trials / 100);  // 2 mm of noise change the scale by 0.35 %
}

TEST_CASE("Rigid alignment: NaN, infinite and huge coordinates are refused") {
    Random random(10);
    const double infinity = std::numeric_limits<double>::infinity();
    for (const double value : {bolt::nan, infinity, -infinity, 1e300, 2e6})
        for (int i = 0; i < 36; ++i) {
            std::vector<PointPair> pairs = any_pairs(random, {}, 6, 0.0);
            PointPair& pair = pairs[static_cast<std::size_t>(i / 6)];
            (i % 2 == 0 ? pair.from : pair.to)[i / 2 % 3] = value;
            REQUIRE(fault_of(pairs) == AlignmentFault::not_finite);
        }
}

namespace {

// A tool whose tip stays on a point while it is turned by up to `angle` about its x and y axes.
std::vector<Pose> turned_tool(Random& random, const Vec3& tip, const Vec3& pivot, double angle,
                              double sigma) {
    const Quat start = random_turn(random);
    std::vector<Pose> poses;
    for (int i = 0; i < 400; ++i) {
        const Quat turn = start * rotation({random.uniform(-angle, angle), 0.0, 0.0}) *
                          rotation({0.0, random.uniform(-angle, angle), 0.0});
        poses.push_back({pivot - turn * tip + noise(random, sigma), turn});
    }
    return poses;
}

double squares_of(std::span<const Pose> poses, const Vec3& tip, const Vec3& pivot) {
    double squares = 0.0;
    for (const Pose& pose : poses) squares += glm::dot(pose * tip - pivot, pose * tip - pivot);
    return squares;
}

}  // namespace

TEST_CASE("Pivot: exact poses of a tool that turns about its tip give the tip and the point") {
    Random random(3);
    for (int i = 0; i < 50; ++i) {
        const Vec3 tip = noise(random, 0.2), pivot = noise(random, 2.0);
        const auto fit = fit_pivot(turned_tool(random, tip, pivot, random.uniform(0.5, 2.0), 0.0));
        REQUIRE(fit);
        CHECK(glm::length(fit->tip - tip) < 1e-11);
        CHECK(glm::length(fit->pivot - pivot) < 1e-11);
        CHECK(fit->rms < 1e-11);
    }
}

TEST_CASE("Pivot: the sum of squares is least, and noise has the stated effect") {
    Random random(4);
    const Vec3 tip(0.02, -0.03, -0.15), pivot(0.4, 0.9, -0.6);
    constexpr double sigma = 1e-3;
    double squares = 0.0, bound = 0.0, rms = 0.0;
    constexpr int repeats = 100;
    for (int i = 0; i < repeats; ++i) {
        const std::vector<Pose> poses = turned_tool(random, tip, pivot, 0.5, sigma);
        const auto fit = fit_pivot(poses);
        REQUIRE(fit);
        const double least = squares_of(poses, fit->tip, fit->pivot);
        for (int axis = 0; axis < 3; ++axis)
            for (const double step : {-1e-4, 1e-4}) {
                Vec3 other(0.0);
                other[axis] = step;
                CHECK(squares_of(poses, fit->tip + other, fit->pivot) > least);
                CHECK(squares_of(poses, fit->tip, fit->pivot + other) > least);
            }
        squares += glm::dot(fit->tip - tip, fit->tip - tip) / repeats;
        bound += 3.0 * square(sigma / fit->orientation_spread) / 400.0 / repeats;
        rms += fit->rms / repeats;
    }
    CHECK(squares < bound);
    CHECK(squares > 0.2 * bound);
    CHECK(rms == doctest::Approx(std::sqrt(3.0) * sigma).epsilon(0.02));
}

TEST_CASE("Pivot: turns that do not determine the tip are refused") {
    Random random(5);
    const Vec3 tip(0.0, 0.0, -0.1);
    const auto refused = [](const std::vector<Pose>& poses) {
        const auto fit = fit_pivot(poses);
        return !fit && !fit.error().expected.empty();
    };
    CHECK(refused({}));
    CHECK(refused({Pose{}}));
    CHECK(refused(turned_tool(random, tip, {}, to_radians(14.0), 0.0)));
    CHECK(!refused(turned_tool(random, tip, {}, to_radians(17.0), 0.0)));
    std::vector<Pose> one_axis;
    for (int i = 0; i < 100; ++i) {
        const Quat turn = rotation({0.03 * i, 0.0, 0.0});
        one_axis.push_back({turn * -tip, turn});
    }
    CHECK(refused(one_axis));
    std::vector<Pose> lying = turned_tool(random, tip, {}, 1.0, 0.0);
    lying[7].position.y = std::numeric_limits<double>::quiet_NaN();
    CHECK(refused(lying));
    lying[7] = {{}, Quat(0.0, 0.0, 0.0, 0.0)};
    CHECK(refused(lying));
}

}  // namespace rigid_alignment_test
