// The free hand of mouse and keyboard: what a drag and the wheel do to the hand's intention.
#include "game/trainer/dragged_hand.hpp"

#include <doctest/doctest.h>

#include <glm/gtc/matrix_transform.hpp>

using namespace bolt;
using namespace bolt::trainer;

namespace {

constexpr double drag_frame = 0.02;  // s

// From the front at 45°, a wrench with its handle to the right.
DragScene seen_from_the_front() {
    DragScene scene;
    const glm::vec3 eye(0.0F, 1.0F, 1.0F);
    scene.projection.eye.position = eye;
    const glm::mat4 y_down = glm::scale(glm::mat4(1.0F), glm::vec3(1.0F, -1.0F, 1.0F));
    scene.projection.eye.clip_from_world = y_down * glm::perspective(0.8F, 1.6F, 0.05F, 10.0F) *
                                           glm::lookAt(eye, glm::vec3(0.0F), glm::vec3(0.0F, 1.0F, 0.0F));
    scene.projection.size = {800.0, 500.0};
    scene.wrench = true;
    scene.handle_length = 0.2;
    // The tool's normal is vertical.
    scene.tool.orientation = glm::angleAxis(-0.5 * pi, Vec3(1, 0, 0));
    return scene;
}

DragInput dragging(const glm::dvec2& px, double notches) {
    DragInput input;
    input.seconds = drag_frame;
    input.mouse.left_down = true;
    input.mouse.left_drag = px;
    input.mouse.scroll = notches;
    return input;
}

// The motion after a drag and after the hand has followed the wheel.
Vec3 moved_by(const DragScene& scene, const glm::dvec2& px, double notches) {
    DraggedHand hand;
    drag_hand(hand, dragging(px, notches), scene);
    for (int i = 0; i < 100; ++i) drag_hand(hand, dragging({0.0, 0.0}, 0.0), scene);
    return hand.motion.moved;
}

}  // namespace

TEST_CASE("Dragged hand: beside a bolt a drag keeps the height, and looks as in the picture") {
    DragScene scene = seen_from_the_front();
    scene.nut = force::Pivot{Vec3(0.0), Vec3(0, 1, 0)};
    const glm::dvec2 px(40.0, -30.0);
    const Vec3 moved = moved_by(scene, px, 0.0);
    CHECK(std::abs(moved.y) < 1e-6);
    CHECK(moved.z < -0.01);
    const Vec3 grip = scene.tool * Vec3(scene.handle_length, 0.0, 0.0);
    const auto from = project(scene.projection, grip), to = project(scene.projection, grip + moved);
    REQUIRE(from);
    REQUIRE(to);
    // The point comes a little nearer or farther, so the drag looks as long to a few per cent.
    CHECK(glm::distance(*to - *from, px) < 0.1 * glm::length(px));
    scene.nut.reset();
    CHECK(moved_by(scene, px, 0.0).y > 0.01);
}

TEST_CASE("Dragged hand: beside a bolt the wheel moves along it, elsewhere along the view") {
    DragScene scene = seen_from_the_front();
    const Vec3 along_view = moved_by(scene, {0.0, 0.0}, -2.0);
    CHECK(glm::length(along_view) == doctest::Approx(0.04).epsilon(0.01));
    CHECK(along_view.z > 0.02);
    scene.nut = force::Pivot{Vec3(0.0), Vec3(0, 1, 0)};
    CHECK(glm::distance(moved_by(scene, {0.0, 0.0}, -2.0), Vec3(0.0, 0.02, 0.0)) < 1e-4);
}

TEST_CASE("Dragged hand: a notch of the wheel takes time, and is lost when the button is released") {
    const DragScene scene = seen_from_the_front();
    DraggedHand hand;
    drag_hand(hand, dragging({0.0, 0.0}, 1.0), scene);
    const double first = glm::length(hand.motion.moved);
    CHECK(first > 1e-3);
    CHECK(first < 0.01);
    DragInput released;
    released.seconds = drag_frame;
    drag_hand(hand, released, scene);
    drag_hand(hand, dragging({0.0, 0.0}, 0.0), scene);
    CHECK(glm::length(hand.motion.moved) == doctest::Approx(first));
}

TEST_CASE("Dragged hand: only a pull on a bolt is stronger than the arm") {
    DragScene scene = seen_from_the_front();
    const auto pull = [&](double notches) {
        DraggedHand hand;
        drag_hand(hand, dragging({5.0, 0.0}, notches), scene);
        return device::simulated_arm_parameters().stiffness * hand.motion.max_deflection;
    };
    const double strength = device::simulated_arm_description().limits.force;
    CHECK(pull(0.0) < strength);
    scene.nut = force::Pivot{Vec3(0.0), Vec3(0, 1, 0)};
    CHECK(pull(0.0) < strength);
    scene.engaged = true;
    CHECK(pull(0.0) > strength);
    CHECK(pull(-1.0) < strength);
}

TEST_CASE("Dragged hand: a hand behind the eye can be dragged back") {
    DragScene scene = seen_from_the_front();
    scene.tool.position = {0.0, 1.2, 1.4};
    const Vec3 moved = moved_by(scene, {100.0, 0.0}, 0.0);
    CHECK(moved.x > 0.01);
    CHECK(moved.x < 0.1);
}
