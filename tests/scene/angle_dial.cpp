// The protractor at a nut that is turned by an angle.
#include "game/scene/angle_dial.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/lesson/script.hpp"

namespace bolt::scene::angle_dial_test {

namespace {

using test::Script;

struct TurnedScript : Script {
    servo::Setup setup;
    explicit TurnedScript(lesson::Mode mode = lesson::Mode::guided,
                          joint::ThreadDirection thread = joint::ThreadDirection::right)
        : Script(mode) {
        for (content::AssemblyJoint& joint : assembly.joints) {
            joint.spec.angle = {to_radians(60.0), to_radians(50.0), to_radians(70.0)};
            joint.design.thread_direction = thread;
        }
        content::Pass half{content::PassKind::turn, 0.5, {0, 1}}, whole{content::PassKind::turn, 1.0, {0, 1}};
        assembly.passes = {assembly.passes[0], assembly.passes[1], half, whole};
        lesson = lesson::begin(assembly, mode, lesson::Task::tighten);
        for (const double x : {0.0, 0.2}) {
            servo::NutGeometry nut;
            nut.seat = Vec3(x, 0.0, 0.0);
            nut.across_flats = 0.024;
            nut.height = 0.014;
            nut.sense = thread == joint::ThreadDirection::left ? -1.0 : 1.0;
            setup.nuts.push_back(nut);
        }
    }
    void turn(double degrees) {
        for (int i = 0; i < 100; ++i) tick(0, servo::Grip::wrench, 50.0, to_radians(degrees) / 0.1);
    }
};

}  // namespace

TEST_CASE("Dial: shown while a nut is due to be turned by an angle, with the window of the step") {
    TurnedScript s;
    CHECK_FALSE(dial_of(s.lesson, s.setup, s.present()));
    s.seat_both();
    for (const int joint : {0, 1}) s.pull(joint, 35.0);
    auto dial = dial_of(s.lesson, s.setup, s.present());
    REQUIRE(dial);
    CHECK(dial->angle == doctest::Approx(0.0));
    const std::vector<DialWindow> windows = dial_windows(s.assembly);
    REQUIRE(windows.size() == 2);  // both joints have the same two
    CHECK(std::find(windows.begin(), windows.end(), dial->window) != windows.end());
    CHECK(dial->window.low == doctest::Approx(to_radians(25.0)));
    CHECK(dial->window.high == doctest::Approx(to_radians(35.0)));
    const glm::vec4 before = dial->pointer_color;
    s.turn(30.0);
    dial = dial_of(s.lesson, s.setup, s.present());
    CHECK(dial->angle == doctest::Approx(to_radians(30.0)));
    const glm::vec4 inside = dial->pointer_color;
    s.turn(30.0);
    const glm::vec4 beyond = dial_of(s.lesson, s.setup, s.present())->pointer_color;
    CHECK(before != inside);
    CHECK(inside != beyond);
}

TEST_CASE("Dial: an assessment shows no window") {
    TurnedScript s(lesson::Mode::assessment);
    s.seat_both();
    for (const int joint : {0, 1}) s.pull(joint, 35.0);
    const auto dial = dial_of(s.lesson, s.setup, s.present());
    REQUIRE(dial);
    CHECK_FALSE(dial->shows_window);
}

TEST_CASE("Dial: the pointer lies over the window exactly when the nut's angle is inside it") {
    joint::ThreadDirection thread = joint::ThreadDirection::right;
    SUBCASE("a right-hand thread") {}
    SUBCASE("a left-hand thread") { thread = joint::ThreadDirection::left; }
    TurnedScript s(lesson::Mode::guided, thread);
    const std::vector<DialWindow> windows = dial_windows(s.assembly);
    const assets::Model model = dial_model(windows);
    REQUIRE(model.meshes.size() == 2 + windows.size());
    for (std::size_t w = 0; w < windows.size(); ++w) {
        double low = 1e9, high = -1e9;
        for (const glm::vec3& p : model.meshes[2 + w].primitives[0].positions) {
            const double clockwise = -std::atan2(p.y, p.x);
            low = std::min(low, clockwise);
            high = std::max(high, clockwise);
        }
        CHECK(low == doctest::Approx(windows[w].low).epsilon(1e-5));
        CHECK(high == doctest::Approx(windows[w].high).epsilon(1e-5));
    }
    // The pointer turns with the nut, which turns clockwise seen from outside if it tightens on a right-hand
    // thread (servo::nut_pose).
    s.seat_both();
    for (const int joint : {0, 1}) s.pull(joint, 35.0);
    const servo::NutGeometry& nut = s.setup.nuts[0];
    const double mark = s.state.joints[0].nut.angle;
    s.turn(40.0);
    const auto dial = dial_of(s.lesson, s.setup, s.present());
    CHECK(dial->window.low * nut.sense > 0.0);
    CHECK(dial->angle * nut.sense == doctest::Approx(to_radians(40.0)));
    const Quat turned = servo::nut_pose(nut, s.state.joints[0].nut.angle).orientation *
                        glm::conjugate(servo::nut_pose(nut, mark).orientation);
    const Vec3 expected = turned * nut.e1;
    const Vec3 tip =
        glm::normalize(Vec3(glm::rotate(dial->world, -dial->angle, Vec3(0, 0, 1)) * glm::dvec4(1, 0, 0, 0)));
    CHECK(glm::distance(tip, expected) < 1e-9);
}

TEST_CASE("Dial: every mesh is closed and faces outward") {
    TurnedScript s;
    for (const assets::Mesh& mesh : dial_model(dial_windows(s.assembly)).meshes) {
        const assets::Primitive& p = mesh.primitives[0];
        double volume = 0.0;
        for (std::size_t i = 0; i < p.indices.size(); i += 3) {
            const Vec3 a(p.positions[p.indices[i]]), b(p.positions[p.indices[i + 1]]),
                c(p.positions[p.indices[i + 2]]);
            volume += glm::dot(a, glm::cross(b, c)) / 6.0;
            CHECK(glm::dot(glm::cross(b - a, c - a), Vec3(p.normals[p.indices[i]])) > 0.0);
        }
        CHECK(volume > 0.0);
    }
}

}  // namespace bolt::scene::angle_dial_test
