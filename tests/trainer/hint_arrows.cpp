// The arrows of hints point the right way for any direction of the bolt.
#include "game/trainer/hint_visuals.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "engine/base/random.hpp"

using namespace bolt;
using namespace bolt::trainer;
using lesson::HintMotion;

namespace {

Vec3 at(const scene::MotionArrow& arrow, const Vec3& point) {
    return Vec3(arrow.world * glm::dvec4(point, 1.0));
}
Vec3 on_arc(double angle) { return {std::cos(angle), std::sin(angle), 0.0}; }

servo::NutGeometry some_nut(Random& random) {
    servo::NutGeometry nut;
    const auto some = [&] {
        return Vec3(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
    };
    nut.axis = glm::normalize(some());
    nut.e1 = glm::normalize(glm::cross(nut.axis, some()));
    nut.e2 = glm::cross(nut.axis, nut.e1);
    nut.seat = some();
    nut.across_flats = 0.024;
    return nut;
}

}  // namespace

TEST_CASE(
    "Hint arrows: a round arrow follows the handle, clockwise to tighten a right-hand thread and "
    "counterclockwise to loosen it, the other way at a left-hand thread") {
    Random random(7, 1);
    for (int i = 0; i < 50; ++i) {
        servo::NutGeometry nut = some_nut(random);
        nut.sense = i % 2 == 0 ? 1.0 : -1.0;
        MotionGeometry place{nut, nut.seat, {}, {}, 0.3, false};
        place.tool.position = nut.seat;
        place.tool.orientation = glm::normalize(glm::quat_cast(glm::dmat3(nut.e2, -nut.e1, nut.axis)));
        const auto turned = [&](HintMotion motion, bool loosens) {
            place.loosens = loosens;
            const auto arrow = arrow_of(motion, place);
            REQUIRE(arrow);
            CHECK(arrow->shape == scene::ArrowShape::round);
            CHECK(glm::determinant(glm::dmat3(arrow->world)) >
                  0.0);  // otherwise the triangles would face inward
            const Vec3 tail = at(*arrow, on_arc(0.0)) - nut.seat,
                       tip = at(*arrow, on_arc(scene::arrow_sweep)) - nut.seat;
            const double r = std::sqrt(glm::dot(tail, tail) - square(glm::dot(tail, nut.axis)));
            // r² sin(sweep), with the sign of the rotation.
            const double area = glm::dot(glm::cross(tail, tip), nut.axis);
            CHECK(std::abs(area) == doctest::Approx(r * r * std::sin(scene::arrow_sweep)));
            return nut.sense * area;
        };
        CHECK(turned(HintMotion::pull_on, false) < 0.0);
        CHECK(turned(HintMotion::spin, false) < 0.0);
        CHECK(turned(HintMotion::pull_off, true) > 0.0);
        CHECK(turned(HintMotion::twist_back, false) > 0.0);
        CHECK(turned(HintMotion::set_back, false) > 0.0);
        CHECK(turned(HintMotion::set_back, true) < 0.0);
        // The arrow begins at the handle.
        const auto pull = arrow_of(HintMotion::pull_on, place);
        const Vec3 tail = at(*pull, on_arc(0.0)) - nut.seat;
        CHECK(glm::dot(tail, nut.e2) == doctest::Approx(0.45 * 0.3));
        CHECK(glm::dot(tail, nut.e1) == doctest::Approx(0.0).epsilon(1e-9));
    }
}

TEST_CASE("Hint arrows: a straight arrow points to the nut or away from it and stays above it") {
    Random random(8, 1);
    servo::NutGeometry nut = some_nut(random);
    nut.held_distance = 0.04;
    const MotionGeometry place{nut, nut.seat, {}, {{1.0, 2.0, 3.0}, {}}, 0.3, false};
    for (const HintMotion motion : {HintMotion::approach, HintMotion::reach, HintMotion::set_on,
                                    HintMotion::grip_nut, HintMotion::lift, HintMotion::let_go}) {
        const auto arrow = arrow_of(motion, place);
        REQUIRE(arrow);
        const double tail = glm::dot(at(*arrow, Vec3(0.0)) - nut.seat, nut.axis),
                     tip = glm::dot(at(*arrow, Vec3(0, 0, 1)) - nut.seat, nut.axis);
        const bool away = motion == HintMotion::lift || motion == HintMotion::let_go;
        CHECK((tip > tail) == away);
        CHECK(std::min(tip, tail) > 0.03);
        CHECK((arrow->color == backward_color) == away);
    }
    CHECK_FALSE(arrow_of(HintMotion::none, place));
    // To the other end of the bolt, from outside.
    const auto hold = arrow_of(HintMotion::counter_hold, place);
    REQUIRE(hold);
    const Vec3 other_end = nut.seat - 0.04 * nut.axis;
    const double tail_outside = glm::dot(other_end - at(*hold, Vec3(0.0)), nut.axis),
                 tip_outside = glm::dot(other_end - at(*hold, Vec3(0, 0, 1)), nut.axis);
    CHECK(tip_outside > 0.0);
    CHECK(tail_outside > tip_outside);
    const auto take = arrow_of(HintMotion::take, place);
    CHECK(at(*take, Vec3(0, 0, 1)).x == doctest::Approx(1.15));  // the middle of the handle
}

TEST_CASE("Hint ghosts: they move as the arrow points, from or to the pose of the ghost at rest") {
    Random random(9, 1);
    for (int i = 0; i < 50; ++i) {
        servo::NutGeometry nut = some_nut(random);
        nut.sense = i % 2 == 0 ? 1.0 : -1.0;
        MotionGeometry place{nut, nut.seat, {}, {{1.0, 2.0, 3.0}, {}}, 0.3, i % 3 == 0};
        const Pose target{nut.seat + 0.01 * nut.axis,
                          glm::normalize(glm::quat_cast(glm::dmat3(nut.e2, -nut.e1, nut.axis)))};
        const Vec3 handle{0.3, 0.0, 0.0};
        place.tool = target;
        for (const HintMotion motion : {HintMotion::pull_on, HintMotion::pull_off, HintMotion::set_back,
                                        HintMotion::spin, HintMotion::twist_back}) {
            CAPTURE(static_cast<int>(motion));
            CHECK(glm::distance(animated_ghost(motion, target, place, 0.0) * handle, target * handle) <
                  1e-12);
            const auto arrow = arrow_of(motion, place);
            REQUIRE(arrow);
            const Vec3 tail = at(*arrow, on_arc(0.0)) - nut.seat,
                       tip = at(*arrow, on_arc(scene::arrow_sweep)) - nut.seat;
            const Pose end = animated_ghost(motion, target, place, 1.0);
            const Vec3 from = target * handle - nut.seat, to = end * handle - nut.seat;
            CHECK(glm::dot(glm::cross(tail, tip), nut.axis) * glm::dot(glm::cross(from, to), nut.axis) > 0.0);
            CHECK(glm::dot(to, nut.axis) == doctest::Approx(glm::dot(from, nut.axis)));
            CHECK(glm::length(to) == doctest::Approx(glm::length(from)));
        }
        for (const HintMotion motion : {HintMotion::approach, HintMotion::reach, HintMotion::set_on,
                                        HintMotion::grip_nut, HintMotion::take, HintMotion::put_away}) {
            const bool to_rest = motion == HintMotion::take || motion == HintMotion::put_away;
            const Vec3 up = to_rest ? place.rest.orientation * Vec3(0, 0, 1) : nut.axis;
            const Vec3 begin = animated_ghost(motion, target, place, 0.0).position - target.position;
            CHECK(glm::dot(begin, up) > 0.03);
            CHECK(glm::length(glm::cross(begin, up)) < 1e-12);
            CHECK(animated_ghost(motion, target, place, 1.0).position == target.position);
        }
        for (const HintMotion motion : {HintMotion::lift, HintMotion::let_go}) {
            CHECK(animated_ghost(motion, target, place, 0.0).position == target.position);
            CHECK(glm::dot(animated_ghost(motion, target, place, 1.0).position - target.position, nut.axis) >
                  0.03);
        }
    }
    CHECK(ghost_share(0.0) == 0.0);
    CHECK(ghost_share(0.5 * ghost_motion_time) == doctest::Approx(0.5));
    for (const double time : {ghost_motion_time, ghost_motion_time + 0.9 * ghost_rest_time})
        CHECK(ghost_share(time) == 1.0);
    CHECK(ghost_share(ghost_motion_time + ghost_rest_time + 0.3) == doctest::Approx(ghost_share(0.3)));
}

TEST_CASE("Hint arrows: triangles face outward and agree with their normals") {
    const assets::Model model = scene::arrow_model();
    REQUIRE(model.meshes.size() == 2);
    for (const assets::Mesh& mesh : model.meshes) {
        const assets::Primitive& p = mesh.primitives.front();
        double volume = 0.0;
        for (std::size_t i = 0; i + 2 < p.indices.size(); i += 3) {
            const Vec3 a(p.positions[p.indices[i]]), b(p.positions[p.indices[i + 1]]),
                c(p.positions[p.indices[i + 2]]);
            volume += glm::dot(a, glm::cross(b, c)) / 6.0;
            const Vec3 face = glm::cross(b - a, c - a);
            if (glm::length(face) < 1e-9) continue;
            for (std::size_t k = 0; k < 3; ++k)
                CHECK(glm::dot(glm::normalize(face), Vec3(p.normals[p.indices[i + k]])) > 0.8);
        }
        // Shaft and cone; a prism of 20 sides has slightly less volume than its cylinder.
        const bool round = &mesh == &model.meshes[1];
        const double length = round ? scene::arrow_sweep : 1.0, head = round ? 0.3 : 0.4,
                     thin = round ? 0.05 : 0.055, thick = round ? 0.15 : 0.17;
        const double whole = pi * length * (square(thin) * (1.0 - head) + square(thick) * head / 3.0);
        CHECK(volume == doctest::Approx(whole).epsilon(0.03));
    }
}
