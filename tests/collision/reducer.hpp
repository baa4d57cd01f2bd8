// The shipped reducer's casing and the shipped wrench.
#pragma once

#include <doctest/doctest.h>

#include <cstdlib>

#include "haptics/collision/narrow_phase.hpp"
#include "tests/collision/support.hpp"

namespace contact_test {

struct Reducer {
    std::vector<ContactMesh> casing = load_parts(content() / "assemblies/zq350/zq350.contact.glb", "casing_");
    std::vector<ContactMesh> wrench = load_parts(content() / "tools/wrench-24.contact.glb");
    bolt::collision::ToolShape tool = bolt::collision::make_tool(wrench).value();
    bolt::collision::CollisionWorld world;

    Reducer() {
        REQUIRE(casing.size() == 2);
        std::vector<bolt::collision::Obstacle> obstacles;
        for (const ContactMesh& part : casing)
            obstacles.push_back({bolt::collision::ObstacleId::fixed(obstacles.size()), &part, {}, false});
        world = bolt::collision::make_world(obstacles).value();
    }

    static std::filesystem::path content() {
        const char* set = std::getenv("BOLTWRIGHT_CONTENT");
        REQUIRE(set != nullptr);
        return set;
    }

    // A random orientation with a random sample of the wrench −0.1 to 2 mm from a random triangle of the
    // casing.
    [[nodiscard]] Pose at_the_surface(bolt::Random& random) const {
        const bolt::collision::Solid& solid = world.shapes[0].solid;
        const std::size_t t = random.bits() % solid.mesh.triangles.size();
        const auto [a, b, c] = corners(solid.mesh, t);
        const Vec3 on_tool = tool.samples.samples[random.bits() % tool.samples.samples.size()].at;
        Pose pose{(a + b + c) / 3.0 + random.uniform(-0.1e-3, 2e-3) * Vec3(solid.mesh.face_normals[t]),
                  random_turn(random)};
        pose.position -= pose.orientation * on_tool;
        return pose;
    }
};

}  // namespace contact_test
