// Tests of the hands' skeletons.
#include "haptics/hand/kinematics.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#include "support.hpp"
#include "tools/assets/sculpt/field.hpp"

namespace sculpt_skeleton_test {

using namespace bolt;
using namespace bolt::hand;
namespace test = sculpt::test;

namespace {

const assets::Node* find(const assets::Model& model, std::string_view name) {
    const auto at = std::find_if(model.nodes.begin(), model.nodes.end(),
                                 [name](const assets::Node& n) { return n.name == name; });
    return at == model.nodes.end() ? nullptr : &*at;
}

bool is_child(const assets::Model& model, std::string_view parent, std::string_view child) {
    const assets::Node* node = find(model, parent);
    return node != nullptr && std::any_of(node->children.begin(), node->children.end(), [&](int i) {
               return model.nodes[static_cast<std::size_t>(i)].name == child;
           });
}

}  // namespace

TEST_CASE("Skeleton: both hands have the 26 joints of XR_EXT_hand_tracking in order, with their parents") {
    for (const assets::Model* hand : {&test::hands().left, &test::hands().right}) {
        REQUIRE(hand->skins.size() == 1);
        const assets::Skin& skin = hand->skins[0];
        REQUIRE(skin.joints.size() == 26);
        std::set<std::string> names;
        for (const assets::Node& node : hand->nodes) CHECK(names.insert(node.name).second);
        for (std::size_t i = 0; i < 26; ++i) {
            CHECK(hand->nodes[static_cast<std::size_t>(skin.joints[i])].name == joint_names[i]);
        }
        for (const std::string finger : {"thumb", "index", "middle", "ring", "little"}) {
            CHECK(is_child(*hand, "wrist", finger + "_metacarpal"));
            CHECK(is_child(*hand, finger + "_metacarpal", finger + "_proximal"));
            CHECK(is_child(*hand, finger + "_distal", finger + "_tip"));
            if (finger == "thumb") {
                CHECK(is_child(*hand, "thumb_proximal", "thumb_distal"));
                CHECK(find(*hand, "thumb_intermediate") == nullptr);
            } else {
                CHECK(is_child(*hand, finger + "_proximal", finger + "_intermediate"));
                CHECK(is_child(*hand, finger + "_intermediate", finger + "_distal"));
            }
        }
        CHECK(is_child(*hand, "wrist", "palm"));
    }
}

TEST_CASE("Skeleton: each joint's frame points along its bone, the back of the hand is up") {
    for (const Skeleton& hand : {right_skeleton(), mirrored(right_skeleton())}) {
        for (const Digit& digit : digits) {
            for (std::size_t k = 0; k + 1 < digit.count; ++k) {
                const std::size_t joint = digit.first + k;
                const Vec3 bone = glm::normalize(hand.position[joint + 1] - hand.position[joint]);
                const Vec3 forward = hand.rotation[joint] * Vec3(0, 0, -1);
                CHECK(glm::dot(bone, forward) > 1.0 - 1e-9);
                CHECK((hand.rotation[joint] * Vec3(0, 1, 0)).y > 0.5);
                CHECK(glm::length(hand.rotation[joint]) == doctest::Approx(1.0));
            }
        }
    }
    // With the palm down and the fingers pointing away, the right hand's thumb is on the left.
    CHECK(right_skeleton().position[thumb_tip].x < -0.05);
}

TEST_CASE("Skeleton: bone lengths are near the published values of a median male hand") {
    const Skeleton hand = right_skeleton();
    const auto length = [&](std::size_t joint) {
        return glm::length(hand.position[joint + 1] - hand.position[joint]) / mm;
    };
    CHECK(length(middle_metacarpal) == doctest::Approx(64.60));
    CHECK(length(middle_proximal) == doctest::Approx(44.63));
    CHECK(length(middle_intermediate) == doctest::Approx(26.33));
    CHECK(length(middle_distal) == doctest::Approx(17.40 + 3.95));
    CHECK(length(thumb_metacarpal) == doctest::Approx(46.22));
    CHECK(length(little_proximal) == doctest::Approx(32.74));
    // Wrist to tip along the bones.
    double chain = glm::length(hand.position[middle_metacarpal]) / mm;
    for (std::size_t i = middle_metacarpal; i < middle_tip; ++i) chain += length(i);
    CHECK(chain == doctest::Approx(189.0).epsilon(0.01));
    CHECK(hand.position[middle_tip].z < hand.position[index_tip].z);
    CHECK(hand.position[index_tip].z < hand.position[little_tip].z);
}

TEST_CASE("Skeleton: the breadth over the knuckles matches a gloved hand") {
    double left = 0.0;
    double right = 0.0;
    for (const Vec3& p : test::joined(test::hands().right).positions) {
        if (p.z < -100 * mm || p.z > -75 * mm || p.y < -15 * mm) continue;  // the thumb is below
        left = std::min(left, p.x);
        right = std::max(right, p.x);
    }
    CHECK((right - left) / mm > 84.0);
    CHECK((right - left) / mm < 92.0);
}

}  // namespace sculpt_skeleton_test
