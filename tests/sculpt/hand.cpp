// Tests of the hand models: mesh, skinning weights and textures.
#include "tools/assets/sculpt/hand.hpp"

#include <doctest/doctest.h>

#include <glm/gtc/matrix_access.hpp>

#include "support.hpp"
#include "tools/assets/sculpt/field.hpp"
#include "tools/assets/sculpt/glove.hpp"

namespace sculpt_hand_test {

using namespace bolt;
using namespace bolt::sculpt;

TEST_CASE("Hand mesh: is closed, oriented outward and within its triangle budget") {
    for (const assets::Model* hand : {&sculpt::test::hands().left, &sculpt::test::hands().right}) {
        const TriMesh mesh = sculpt::test::joined(*hand);
        CHECK(mesh.triangles.size() <= hand_triangles);
        CHECK(mesh.triangles.size() > hand_triangles / 2);
        CHECK(open_edges(mesh) == 0);
        // A hand has a volume of about 350 to 400 cm³; the sleeve adds to it.
        CHECK(volume(mesh) > 330e-6);
        CHECK(volume(mesh) < 450e-6);
    }
}

TEST_CASE("Hand mesh: vertices lie on the sculpted surface with outward normals") {
    const TriMesh mesh = sculpt::test::as_stored(sculpt::test::hands().right);
    double furthest = 0.0;
    for (const Vec3& p : mesh.positions) furthest = std::max(furthest, std::abs(sculpt::test::shape()(p)));
    CHECK(furthest < 0.1 * mm);
    std::size_t against = 0;
    for (const assets::Primitive& part : sculpt::test::hands().right.meshes[0].primitives) {
        for (std::size_t i = 0; i < part.indices.size(); i += 3) {
            const Vec3 a(part.positions[part.indices[i]]);
            const Vec3 b(part.positions[part.indices[i + 1]]);
            const Vec3 c(part.positions[part.indices[i + 2]]);
            const Vec3 mean = Vec3(part.normals[part.indices[i]]) + Vec3(part.normals[part.indices[i + 1]]) +
                              Vec3(part.normals[part.indices[i + 2]]);
            against += glm::dot(glm::cross(b - a, c - a), mean) <= 0.0 ? 1U : 0U;
        }
    }
    CHECK(against <= mesh.triangles.size() / 1000);
}

TEST_CASE("Hand mesh: neighbouring fingers do not merge past the web") {
    const HandShape& shape = sculpt::test::shape();
    const Skeleton& hand = shape.skeleton();
    for (std::size_t d = 1; d < 4; ++d) {
        for (const double part : {0.9, 1.0}) {
            const auto at = [&](std::size_t digit) {
                const std::size_t joint = digits[digit].first + 1;
                return hand.position[joint] + part * (hand.position[joint + 1] - hand.position[joint]);
            };
            CHECK(shape(0.5 * (at(d) + at(d + 1))) > 0.5 * mm);
        }
    }
}

TEST_CASE("Hand weights: each vertex has at most four existing joints, and its weights sum to exactly one") {
    for (const assets::Model* hand : {&sculpt::test::hands().left, &sculpt::test::hands().right}) {
        for (const assets::Primitive& part : hand->meshes[0].primitives) {
            REQUIRE(part.weights.size() == part.positions.size());
            REQUIRE(part.joints.size() == part.positions.size());
            for (std::size_t v = 0; v < part.weights.size(); ++v) {
                const glm::vec4& w = part.weights[v];
                CHECK(w.x + w.y + w.z + w.w == 1.0F);
                for (int k = 0; k < 4; ++k) {
                    CHECK(w[k] >= 0.0F);
                    CHECK(part.joints[v][k] < 26);
                    if (w[k] == 0.0F) CHECK(part.joints[v][k] == 0);
                    for (int j = 0; j < k; ++j) {
                        const bool twice =
                            w[k] > 0.0F && w[j] > 0.0F && part.joints[v][k] == part.joints[v][j];
                        CHECK_FALSE(twice);
                    }
                }
            }
        }
    }
}

TEST_CASE("Hand mesh: the left hand is the exact mirror of the right") {
    const assets::Model& left = sculpt::test::hands().left;
    const assets::Model& right = sculpt::test::hands().right;
    REQUIRE(left.meshes[0].primitives.size() == right.meshes[0].primitives.size());
    for (std::size_t i = 0; i < left.meshes[0].primitives.size(); ++i) {
        const assets::Primitive& l = left.meshes[0].primitives[i];
        const assets::Primitive& r = right.meshes[0].primitives[i];
        REQUIRE(l.positions.size() == r.positions.size());
        for (std::size_t v = 0; v < l.positions.size(); ++v) {
            CHECK(l.positions[v] == glm::vec3(-r.positions[v].x, r.positions[v].y, r.positions[v].z));
            CHECK(l.normals[v] == glm::vec3(-r.normals[v].x, r.normals[v].y, r.normals[v].z));
        }
        CHECK(l.joints == r.joints);
        CHECK(l.weights == r.weights);
        CHECK(l.texcoords[0] == r.texcoords[0]);
    }
    CHECK(volume(sculpt::test::joined(left)) ==
          doctest::Approx(volume(sculpt::test::joined(right))).epsilon(1e-12));
    const glm::mat4 mirror = glm::mat4(glm::vec4(-1, 0, 0, 0), glm::vec4(0, 1, 0, 0), glm::vec4(0, 0, 1, 0),
                                       glm::vec4(0, 0, 0, 1));
    for (std::size_t i = 0; i < 26; ++i) {
        const glm::mat4 expected = mirror * right.skins[0].inverse_bind[i] * mirror;
        for (int c = 0; c < 4; ++c) {
            for (int k = 0; k < 4; ++k)
                CHECK(std::abs(left.skins[0].inverse_bind[i][c][k] - expected[c][k]) < 1e-6F);
        }
    }
}

TEST_CASE("Hand mesh: tangents are unit and perpendicular to the normals") {
    for (const assets::Primitive& part : sculpt::test::hands().right.meshes[0].primitives) {
        for (std::size_t v = 0; v < part.normals.size(); ++v) {
            CHECK(glm::length(part.normals[v]) == doctest::Approx(1.0).epsilon(1e-4));
            CHECK(glm::length(glm::vec3(part.tangents[v])) == doctest::Approx(1.0).epsilon(1e-4));
            CHECK(std::abs(glm::dot(part.normals[v], glm::vec3(part.tangents[v]))) < 1e-3F);
            CHECK(std::abs(part.tangents[v].w) == 1.0F);
        }
    }
}

TEST_CASE("Hand textures: few edges of the knit are stretched beyond a factor of 1.75") {
    double area = 0.0;
    double stretched = 0.0;
    for (const assets::Primitive& part : sculpt::test::hands().right.meshes[0].primitives) {
        for (std::size_t i = 0; i < part.indices.size(); i += 3) {
            std::array<Vec3, 3> p{};
            std::array<glm::dvec2, 3> uv{};
            for (std::size_t k = 0; k < 3; ++k) {
                p[k] = Vec3(part.positions[part.indices[i + k]]);
                uv[k] = glm::dvec2(part.texcoords[0][part.indices[i + k]]) * tile_length;
            }
            const double triangle_area = glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
            area += triangle_area;
            // Each edge has the same length on the texture as on the hand, within the factor.
            double worst = 1.0;
            for (std::size_t k = 0; k < 3; ++k) {
                const double on_hand = glm::length(p[(k + 1) % 3] - p[k]);
                const double on_texture = glm::length(uv[(k + 1) % 3] - uv[k]);
                worst = std::max(worst, on_hand / std::max(on_texture, 1e-9));
            }
            if (worst > 1.75) stretched += triangle_area;
        }
    }
    CHECK(stretched < 0.05 * area);
}

}  // namespace sculpt_hand_test
