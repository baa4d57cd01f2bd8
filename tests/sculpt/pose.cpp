// Tests of posed hands.
#include "tools/assets/sculpt/pose.hpp"

#include <doctest/doctest.h>

#include "support.hpp"
#include "tools/assets/sculpt/field.hpp"

namespace sculpt_pose_test {

using namespace bolt;
using namespace bolt::sculpt;

namespace {

TriMesh posed_mesh(const assets::Model& hand, const HandPosture& pose) {
    const Result<assets::Model> out = posed(hand, pose);
    REQUIRE(out.has_value());
    return sculpt::test::as_stored(*out);
}

// Returns the digit of a point past the web; 5: palm or cuff.
std::size_t digit_of(const Vec3& p) {
    std::size_t best = 0;
    for (std::size_t d = 1; d < 5; ++d) {
        if (sculpt::test::shape().digit_distance(d, p) < sculpt::test::shape().digit_distance(best, p))
            best = d;
    }
    const double web = sculpt::test::shape().travel(best, 1) + (best == 0 ? 16 * mm : 24 * mm);
    const bool own = sculpt::test::shape().locate(best, p).travel > web &&
                     sculpt::test::shape().digit_distance(best, p) < 1.5 * mm;
    return own ? best : 5;
}

}  // namespace

TEST_CASE("Skin: at rest the skinned mesh equals the mesh") {
    const TriMesh rest = sculpt::test::as_stored(sculpt::test::hands().right);
    const TriMesh same = posed_mesh(sculpt::test::hands().right, HandPosture());
    double furthest = 0.0;
    for (std::size_t i = 0; i < rest.positions.size(); ++i) {
        furthest = std::max(furthest, glm::length(rest.positions[i] - same.positions[i]));
    }
    CHECK(furthest < 2e-6);
}

TEST_CASE("Skin: a bent finger does not move its neighbours") {
    const TriMesh rest = sculpt::test::as_stored(sculpt::test::hands().right);
    for (std::size_t moved = 0; moved < 5; ++moved) {
        HandPosture pose;
        const Digit& digit = digits[moved];
        for (std::size_t k = 1; k + 1 < digit.count; ++k) pose.flex(digit.first + k, 60.0);
        const TriMesh now = posed_mesh(sculpt::test::hands().right, pose);
        std::array<double, 6> furthest{};
        std::array<std::size_t, 6> count{};
        for (std::size_t i = 0; i < rest.positions.size(); ++i) {
            const std::size_t owner = digit_of(rest.positions[i]);
            furthest[owner] = std::max(furthest[owner], glm::length(rest.positions[i] - now.positions[i]));
            ++count[owner];
        }
        for (std::size_t d = 0; d < 5; ++d) {
            CAPTURE(moved);
            CAPTURE(d);
            CHECK(count[d] > 100);
            if (d == moved) {
                CHECK(furthest[d] > 25 * mm);
            } else {
                CHECK(furthest[d] < 2e-6);
            }
        }
    }
}

TEST_CASE("Skin: poses preserve the volume and flip few triangles") {
    for (const bool left : {false, true}) {
        const assets::Model& hand = left ? sculpt::test::hands().left : sculpt::test::hands().right;
        const TriMesh rest = sculpt::test::as_stored(hand);
        const double whole = volume(weld(rest));
        for (const std::string_view name : pose_names) {
            CAPTURE(name);
            const HandPosture pose = *named_pose(name);
            const Result<assets::Model> out = posed(hand, left ? mirrored(pose) : pose);
            REQUIRE(out.has_value());
            const TriMesh now = sculpt::test::as_stored(*out);
            CHECK(volume(now) > 0.85 * whole);
            CHECK(volume(now) < 1.15 * whole);
            // A triangle is flipped if its normal opposes the skinned normals of its corners.
            std::size_t over = 0;
            std::size_t t = 0;
            double area_over = 0.0;
            double area = 0.0;
            for (const assets::Primitive& part : out->meshes[0].primitives) {
                for (std::size_t i = 0; i < part.indices.size(); i += 3, ++t) {
                    Vec3 mean(0.0);
                    for (std::size_t k = 0; k < 3; ++k) mean += Vec3(part.normals[part.indices[i + k]]);
                    const Vec3 normal = area_vector(now, now.triangles[t]);
                    area += glm::length(normal);
                    if (glm::dot(mean, normal) >= 0.0) continue;
                    ++over;
                    area_over += glm::length(normal);
                }
            }
            // Linear blending folds the skin inside a joint that is bent by a right angle, where it is not
            // visible.
            CHECK(over < now.triangles.size() / 33);
            CHECK(area_over < 0.01 * area);
        }
    }
}

TEST_CASE("Skin: in a fist the tips reach the palm, in a pinch thumb and index meet") {
    const assets::Model& hand = sculpt::test::hands().right;
    const Result<Skeleton> rest = posed_joints(hand, HandPosture());
    const Result<Skeleton> fist = posed_joints(hand, *named_pose("fist"));
    const Result<Skeleton> pinch = posed_joints(hand, *named_pose("pinch"));
    REQUIRE((rest && fist && pinch));
    for (const std::size_t tip : {index_tip, middle_tip, ring_tip, little_tip}) {
        CHECK(glm::length(rest->position[tip] - rest->position[palm]) > 75 * mm);
        CHECK(glm::length(fist->position[tip] - fist->position[palm]) < 45 * mm);
    }
    const double open_gap = glm::length(rest->position[thumb_tip] - rest->position[index_tip]);
    const double gap = glm::length(pinch->position[thumb_tip] - pinch->position[index_tip]);
    CHECK(open_gap > 60 * mm);
    CHECK(gap < 24 * mm);  // the thickness of two finger tips
}

TEST_CASE("Skin: a model that is not a hand is rejected") {
    assets::Model nothing;
    CHECK_FALSE(posed(nothing, HandPosture()).has_value());
    assets::Model lacking = sculpt::test::hands().right;
    for (assets::Node& node : lacking.nodes) {
        if (node.name == "ring_distal") node.name = "ring_dsital";
    }
    const Result<assets::Model> out = posed(lacking, HandPosture());
    REQUIRE_FALSE(out.has_value());
    CHECK(out.error().what.find("ring_distal") != std::string::npos);
    CHECK_FALSE(named_pose("wave").has_value());
}

}  // namespace sculpt_pose_test
