// Edge-edge contacts, including edges that have passed each other.
#include "haptics/collision/edges.hpp"

#include <doctest/doctest.h>

#include <glm/geometric.hpp>

#include "haptics/collision/narrow_phase.hpp"
#include "tests/collision/support.hpp"

using namespace bolt;
using namespace bolt::collision;
using namespace contact_test;

namespace {

// A square bar along X. One of its edges lies on the X axis and points along +Y.
ContactMesh bar(double length, double width) {
    const double diagonal = width / std::sqrt(2.0);
    const Pose turned{Vec3(0.0, -diagonal, 0.0), rotation(Vec3(pi / 4.0, 0.0, 0.0))};
    const Vec3 half = 0.5 * Vec3(length, width, width);
    return transformed(box(-half, half).mesh(), turned);
}

// Pose of the other bar: across the first, upside down, with its edge `height` (m) above the first bar's
// edge.
Pose across(double height, double along, double turn) {
    return {Vec3(along, height, 0.0), rotation(Vec3(0.0, turn, 0.0)) * rotation(Vec3(pi, 0.0, 0.0))};
}

}  // namespace

TEST_CASE("Edges: a crossing deeper than the band is reported with its exact depth") {
    const ContactMesh still = bar(60.0 * mm, 8.0 * mm);
    const ContactMesh mine = bar(50.0 * mm, 7.0 * mm);
    ToolOptions options;
    options.samples.on_faces = 0;
    const ToolShape tool = make_tool({&mine, 1}, options).value();
    const Obstacle obstacle{ObstacleId::fixed(1), &still, {}, false};
    const CollisionWorld world = make_world({&obstacle, 1}).value();
    NarrowPhaseState state = make_narrow_phase(world, tool);
    std::array<Contact, 32> contacts;
    for (int i = 0; i < 60; ++i) {
        const double deep = (0.15 + 0.03 * i) * mm;
        const Pose pose = across(-deep, 0.13 * i * mm, 0.9 + 0.02 * i);
        const ContactQueryResult found = find_contacts(world, tool, pose, 0.1 * mm, state, contacts);
        REQUIRE(found.count > 0);
        CHECK(contacts[0].distance == doctest::Approx(-deep).epsilon(1e-4));
        CHECK(glm::dot(contacts[0].normal, Vec3(0.0, 1.0, 0.0)) > 0.999);
    }
}

TEST_CASE("Edges: the far edge of a thin rib is not reported as a crossing") {
    const ContactMesh rib = box(Vec3(-0.5, -20.0, -30.0) * mm, Vec3(0.5, 0.0, 30.0) * mm).mesh();
    const Obstacle obstacle{ObstacleId::fixed(1), &rib, {}, false};
    const CollisionWorld world = make_world({&obstacle, 1}).value();
    // A thin plate beside the rib that extends above it.
    const ContactMesh leaf = box(Vec3(0.7, -5.0, -2.0) * mm, Vec3(1.0, 5.0, 2.0) * mm).mesh();
    const ToolShape tool = make_tool({&leaf, 1}).value();
    NarrowPhaseState state = make_narrow_phase(world, tool);
    std::array<Contact, 32> contacts;
    for (const double band : {0.1 * mm, 0.6 * mm, 2.0 * mm, 5.0 * mm})
        for (int i = 0; i < 20; ++i) {
            const Pose pose{Vec3(0.0), rotation(Vec3(0.02 * i, 0.0, 0.0))};
            const ContactQueryResult found = find_contacts(world, tool, pose, band, state, contacts);
            CHECK((found.count > 0) == (band > 0.2 * mm));
            for (const Contact& c : std::span(contacts).first(found.count)) CHECK(c.distance > 0.19 * mm);
        }
}

// Any motion within `clear` and `turn` keeps all edges out of the band.
TEST_CASE("Edges: a piece that moves within its certified bounds has no crossing") {
    const ContactMesh still = casing().mesh();
    const ContactMesh mine = box(Vec3(-6.0, -2.0, -3.0) * mm, Vec3(6.0, 2.0, 3.0) * mm).mesh();
    const Solid solid = make_solid({&still, 1}).value();
    const ToolShape tool = make_tool({&mine, 1}).value();
    Random random(51);
    int held = 0, crossed = 0;
    for (int i = 0; i < 40'000; ++i) {
        const SurfaceSample& sample = tool.samples.samples[random.bits() % tool.samples.samples.size()];
        if (sample.piece == SurfaceSample::no_piece) continue;
        const PieceExtent& edge = tool.samples.pieces[sample.piece];
        const auto [end, other_end] = solid.ridges[random.bits() % solid.ridges.size()].ends;
        const Vec3 at = glm::mix(Vec3(end), Vec3(other_end), random.uniform()) +
                        random.uniform(0.0, 4.0) * mm * random_direction(random);
        Pose pose{Vec3(0.0), random_turn(random)};
        pose.position = at - pose.orientation * sample.at;
        const auto query = [&](const Pose& p, double band, EdgeQueryResult& found) {
            const Quat& q = p.orientation;
            const EdgePiece piece{p * sample.at, q * edge.half, {q * edge.inward[0], q * edge.inward[1]}};
            std::array<Crossing, max_planes> crossings;
            FacingEdges facing;
            found = query_edges(solid, piece, tool.solid, inverse(p), 6.0 * mm, band, crossings, facing);
        };
        EdgeQueryResult first;
        query(pose, 0.6 * mm, first);
        crossed += first.count > 0 ? 1 : 0;
        for (const double band : {0.05 * mm, 0.6 * mm, 2.0 * mm}) {
            const double way = 0.999 * (first.clear_distance - band);
            if (!(way > 0.0)) continue;
            // Rotate about the piece's middle by a share of the permitted motion and shift by the rest.
            const double turn =
                std::min({0.99 * first.clear_turn, 0.5 * random.uniform() * way / tool.origin_radius(), 1.0});
            const Quat turned = rotation(turn * random_direction(random)) * pose.orientation;
            const double shift = way - turn * tool.origin_radius();
            Pose there{pose.position + shift * random_direction(random), turned};
            EdgeQueryResult again;
            query(there, band, again);
            CHECK(again.count == 0);
            ++held;
        }
    }
    CHECK(held > 4'000);
    CHECK(crossed > 100);
}
