// The drawn second wrench and the bolt that turns with its nut.
#include <doctest/doctest.h>

#include "game/scene/systems.hpp"

namespace scene_second_wrench_test {

using namespace bolt;

TEST_CASE("Second wrench: it is on the held part, fits its corners, and points away from the other joints") {
    Random random(31, 0);
    for (int run = 0; run < 200; ++run) {
        servo::Setup setup;
        const Vec3 axis = glm::normalize(Vec3(random.normal(), random.normal(), random.normal()));
        const Vec3 helper = std::abs(axis.x) < 0.9 ? Vec3(1, 0, 0) : Vec3(0, 0, 1);
        for (int i = 0; i < 4; ++i) {
            servo::NutGeometry nut;
            nut.axis = axis;
            nut.e1 = glm::normalize(helper - axis * glm::dot(helper, axis));
            nut.e2 = glm::cross(axis, nut.e1);
            nut.held_distance = random.uniform(0.02, 0.1);
            nut.seat = 0.1 * (std::cos(i * pi / 2.0) * nut.e1 + std::sin(i * pi / 2.0) * nut.e2);
            setup.nuts.push_back(nut);
        }
        for (std::size_t i = 0; i < setup.nuts.size(); ++i) {
            const servo::NutGeometry& nut = setup.nuts[i];
            const double corner = random.uniform(-pi, pi);
            const Pose pose = scene::second_wrench_pose(setup, i, corner);
            CHECK(glm::distance(pose.position, nut.seat - nut.held_distance * nut.axis) < 1e-12);
            CHECK(glm::distance(pose.orientation * Vec3(0, 0, 1), -nut.axis) < 1e-9);
            const Vec3 handle = pose.orientation * Vec3(1, 0, 0);
            const double angle = std::atan2(glm::dot(handle, nut.e2), glm::dot(handle, nut.e1));
            CHECK(std::abs(std::remainder(angle - corner, pi / 6.0)) < 1e-9);
            CHECK(glm::dot(handle, glm::normalize(nut.seat)) > std::cos(pi / 12.0) - 1e-9);
        }
    }
}

}  // namespace scene_second_wrench_test
