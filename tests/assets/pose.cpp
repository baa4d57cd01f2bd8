// Animations and skins, compared with values computed by hand.
#include "engine/assets/pose.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "engine/assets/model.hpp"
#include "engine/base/random.hpp"

using namespace bolt;
using namespace bolt::assets;

namespace {

constexpr float float_pi = std::numbers::pi_v<float>;

// A rotation about the y axis.
std::vector<float> turn(float angle) { return {0.0F, std::sin(angle / 2), 0.0F, std::cos(angle / 2)}; }

AnimationChannel rotation(const std::vector<float>& from, const std::vector<float>& to) {
    AnimationChannel channel{.node = 0, .path = TargetPath::rotation, .times = {1.0F, 3.0F}, .values = from};
    channel.values.insert(channel.values.end(), to.begin(), to.end());
    return channel;
}

void check_near(const std::vector<float>& value, const std::vector<float>& expected, double tolerance) {
    REQUIRE(value.size() == expected.size());
    for (std::size_t i = 0; i < value.size(); ++i) {
        CAPTURE(i);
        CHECK(std::abs(double{value[i]} - double{expected[i]}) <= tolerance);
    }
}

double difference(const glm::mat4& a, const glm::mat4& b) {
    double largest = 0.0;
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) largest = std::max(largest, std::abs(double{a[c][r]} - double{b[c][r]}));
    return largest;
}

}  // namespace

TEST_CASE("Animation: a rotation has constant angular velocity") {
    const AnimationChannel channel = rotation(turn(0.3F), turn(2.1F));
    for (const float t : {0.0F, 0.1F, 0.25F, 0.5F, 0.9F, 1.0F}) {
        CAPTURE(t);
        check_near(sample(channel, 1.0F + 2.0F * t), turn(0.3F + t * 1.8F), 1e-6);
    }
    SUBCASE("the rotation follows the shorter arc for either sign of the keys") {
        std::vector<float> end = turn(2.1F);
        for (float& x : end) x = -x;
        check_near(sample(rotation(turn(0.3F), end), 2.0F), turn(1.2F), 1e-6);
    }
    SUBCASE("nearly equal keys cause no division by zero") {
        check_near(sample(rotation(turn(0.3F), turn(0.3F)), 2.0F), turn(0.3F), 1e-6);
        check_near(sample(rotation(turn(0.3F), turn(0.3001F)), 2.0F), turn(0.30005F), 1e-6);
    }
}

TEST_CASE("Animation: values are stepped or linear between the keys and constant outside them") {
    AnimationChannel channel{
        .node = 0, .times = {0.5F, 1.0F, 2.0F}, .values = {1, 2, 3, 5, 6, 7, -1, -2, -3}};
    check_near(sample(channel, 0.0F), {1, 2, 3}, 0.0);
    check_near(sample(channel, 0.5F), {1, 2, 3}, 0.0);
    check_near(sample(channel, 0.75F), {3, 4, 5}, 1e-6);
    check_near(sample(channel, 1.25F), {3.5F, 4, 4.5F}, 1e-6);
    check_near(sample(channel, 2.0F), {-1, -2, -3}, 0.0);
    check_near(sample(channel, 9.0F), {-1, -2, -3}, 0.0);
    channel.interpolation = Interpolation::step;
    check_near(sample(channel, 0.99F), {1, 2, 3}, 0.0);
    check_near(sample(channel, 1.0F), {5, 6, 7}, 0.0);
    check_near(sample(channel, 1.999F), {5, 6, 7}, 0.0);
}

TEST_CASE("Animation: a cubic spline through keys of a cubic reproduces the cubic") {
    // Values and slopes of x³ − 2x² + 3x − 4 at three unequal steps determine the cubic spline.
    const auto f = [](double x) { return ((x - 2.0) * x + 3.0) * x - 4.0; };
    const auto slope = [](double x) { return (3.0 * x - 4.0) * x + 3.0; };
    AnimationChannel channel{
        .node = 0, .interpolation = Interpolation::cubic, .times = {0.0F, 0.5F, 2.0F, 2.25F}};
    for (const float x : channel.times)
        for (const double v : {slope(double{x}), f(double{x}), slope(double{x})})
            for (const float factor : {1.0F, -1.0F, 2.0F})
                channel.values.push_back(static_cast<float>(v) * factor);
    for (double x = 0.0; x <= 2.25; x += 0.0625) {
        CAPTURE(x);
        const auto y = static_cast<float>(f(x));
        check_near(sample(channel, static_cast<float>(x)), {y, -y, 2.0F * y}, 2e-5);
    }
    SUBCASE("a key's in- and out-tangents differ") {
        // Slope 4 after the first key, slope 0 before the second: p = 4 (t³ − 2t² + t).
        const AnimationChannel one{.node = 0,
                                   .path = TargetPath::weights,
                                   .interpolation = Interpolation::cubic,
                                   .times = {0.0F, 1.0F},
                                   .values = {7, 0, 4, 0, 0, 9}};
        check_near(sample(one, 0.5F), {0.5F}, 1e-6);
    }
    SUBCASE("rotations are unit quaternions") {
        AnimationChannel q{.node = 0,
                           .path = TargetPath::rotation,
                           .interpolation = Interpolation::cubic,
                           .times = {0.0F, 1.0F}};
        for (const float angle : {0.0F, 1.0F}) {
            const std::vector<float> value = turn(angle);
            q.values.insert(q.values.end(), 4, 0.0F);
            q.values.insert(q.values.end(), value.begin(), value.end());
            q.values.insert(q.values.end(), 4, 0.0F);
        }
        check_near(sample(q, 0.5F), turn(0.5F), 1e-6);  // by symmetry
        const std::vector<float> v = sample(q, 0.3F);
        CHECK(std::hypot(v[1], v[3]) == doctest::Approx(1.0).epsilon(1e-6));
    }
}

TEST_CASE("Animation: only the targets of the channels change; other values keep the rest pose") {
    Model model;
    model.nodes.resize(2);
    model.nodes[0] = {.name = "arm", .translation = {0, 1, 0}, .children = {1}};
    model.nodes[1] = {.name = "hand", .translation = {2, 0, 0}, .mesh = 0};
    model.roots = {0};
    model.meshes.resize(1);
    model.meshes[0].primitives.resize(1);
    model.meshes[0].primitives[0].targets.resize(2);
    Animation wave;
    wave.channels = {rotation(turn(0.0F), turn(float_pi / 2.0F)),
                     {.node = 1, .path = TargetPath::weights, .times = {0.0F, 4.0F}, .values = {0, 1, 1, 0}}};
    CHECK(duration(wave) == 4.0F);

    ModelPose pose = rest_pose(model);
    CHECK(difference(world_transforms(model, pose)[1], world_transforms(model)[1]) == 0.0);
    check_near(pose[1].weights, {0, 0}, 0.0);
    apply(wave, 3.0F, pose);
    check_near(pose[1].weights, {0.75F, 0.25F}, 1e-6);
    // A quarter turn about y takes x to -z.
    const glm::vec4 hand = world_transforms(model, pose)[1] * glm::vec4(0, 0, 0, 1);
    CHECK(glm::distance(glm::vec3(hand), glm::vec3(0, 1, -2)) < 1e-6F);

    set_rest(model, pose);
    CHECK(difference(world_transforms(model)[1], world_transforms(model, pose)[1]) < 1e-6);
    check_near(model.nodes[1].weights, {0.75F, 0.25F}, 1e-6);
}

TEST_CASE(
    "Skins: joints in the bind pose leave vertices unchanged, and joints moved together move all vertices "
    "equally") {
    Random random(3);
    Model model;
    Skin skin;
    for (int i = 0; i < 12; ++i) {
        const auto number = [&] { return static_cast<float>(random.uniform(-1.0, 1.0)); };
        Node node;
        node.translation = {number(), number(), number()};
        node.rotation = glm::normalize(glm::quat(number(), number(), number(), number()));
        node.scale = glm::vec3(1.0F + 0.3F * number());
        model.nodes.push_back(node);
        if (i > 0) model.nodes[static_cast<std::size_t>(i) / 2].children.push_back(i);
        skin.joints.push_back(i);
    }
    ModelPose pose = rest_pose(model);
    for (const glm::mat4& world : world_transforms(model, pose))
        skin.inverse_bind.push_back(glm::inverse(world));
    for (const glm::mat4& m : joint_matrices(skin, world_transforms(model, pose)))
        CHECK(difference(m, glm::mat4(1.0F)) < 2e-5);
    pose[0].translation += glm::vec3(0.5F, -0.25F, 2.0F);
    const glm::mat4 moved = glm::translate(glm::mat4(1.0F), {0.5F, -0.25F, 2.0F});
    for (const glm::mat4& m : joint_matrices(skin, world_transforms(model, pose)))
        CHECK(difference(m, moved) < 2e-5);
    pose[3].rotation = pose[3].rotation * glm::angleAxis(1.0F, glm::vec3(1, 0, 0));
    CHECK(difference(joint_matrices(skin, world_transforms(model, pose))[3], moved) > 0.1);
}
