// The drawn hand stays out of what is solid. The workplace is built as the trainer and films build it, but
// without a GPU; every vertex of the drawn hand is then tested against the contact models.
#include "game/scene/hand_clearance.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "game/motion/path_planning.hpp"
#include "game/scene/systems.hpp"
#include "game/scene/workplace.hpp"
#include "tests/trainer/player.hpp"

using namespace bolt;

namespace {

// What make_workplace needs of an uploaded model: its meshes with their boxes.
render::GpuModel boxes_of(const assets::Model& model) {
    render::GpuModel boxes;
    for (const assets::Mesh& mesh : model.meshes) {
        boxes.meshes.push_back({static_cast<std::uint32_t>(boxes.parts.size()), 1});
        render::MeshPart part;
        for (const assets::Primitive& p : mesh.primitives)
            for (const glm::vec3& at : p.positions) part.box.add(at);
        boxes.parts.push_back(part);
    }
    return boxes;
}

struct Intrusion {
    std::size_t vertices = 0, inside = 0;
    double depth = 0.0;  // m, the greatest
    void operator+=(const Intrusion& other) {
        vertices += other.vertices;
        inside += other.inside;
        depth = std::max(depth, other.depth);
    }
    [[nodiscard]] std::string text() const {
        return fmt::format("{:.3f} % and {:.1f} mm", 100.0 * share(), 1e3 * depth);
    }
    [[nodiscard]] double share() const {
        return static_cast<double>(inside) / static_cast<double>(std::max<std::size_t>(1, vertices));
    }
};

struct Bench {
    session::Prepared at;
    scene::Shelf shelf;
    std::unique_ptr<scene::GpuShelf> on = std::make_unique<scene::GpuShelf>();
    scene::Workplace place;
    scene::Postures postures;
    Vec3 shoulder{0.0};

    explicit Bench(const char* name) {
        session::CourseOptions options;
        options.obstacles = session::Obstacles::required;
        auto prepared = session::prepare(trainer_test::assembly(name), options);
        REQUIRE(prepared);
        at = std::move(*prepared);
        auto loaded = scene::load_shelf(at.assembly);
        REQUIRE(loaded);
        shelf = std::move(*loaded);
        REQUIRE(shelf.missing.empty());
        on->machine = boxes_of(shelf.machine.model);
        on->workshop = boxes_of(shelf.workshop);
        on->wrench = boxes_of(shelf.wrench);
        on->hand = boxes_of(shelf.hand);
        scene::World world;
        world::add_haptics(world, at.state);
        auto made = scene::make_workplace(std::move(world), shelf, *on, at.assembly, at.setup);
        REQUIRE(made);
        place = std::move(*made);
        postures = scene::make_postures(&at.state.tool_contact->wrench, at.setup.wrench.handle_length,
                                        hand::Side::right, scene::widest_nut(at.setup));
        shoulder = scene::shoulder_at(place.machine);
    }

    [[nodiscard]] const collision::World& solids() const { return at.state.tool_contact->world; }

    // The hand before its first picture.
    void forget() {
        place.world.view<scene::Fingers>().each([](scene::Fingers& fingers) {
            fingers.deformation = nullptr;
            fingers.clearance = {};
        });
    }

    [[nodiscard]] scene::Held with_wrench(const Pose& tool) const {
        scene::Held held;
        held.tool = tool;
        held.wrench = true;
        held.grip = scene::natural_grip(postures, tool, Vec3(0, 1, 0), shoulder);
        held.strain = 0.5;
        held.seconds = 1.0 / 60.0;
        return held;
    }
    [[nodiscard]] Pose wrench_on(std::size_t joint, double wanted) const {
        const auto grip =
            motion::choose_grip(at.setup, &*at.state.tool_contact, joint, 0.0, wanted, 1.0, to_radians(30.0));
        const auto& nut = at.setup.nuts[joint];
        return {servo::nut_centre(nut, 0.0), motion::orientation_of(nut, grip.handle, grip.flipped)};
    }
    [[nodiscard]] const scene::Fingers& fingers() {
        const scene::Fingers* found = nullptr;
        place.world.view<const scene::Fingers>().each([&](ecs::Entity entity, const scene::Fingers& fingers) {
            if (place.world.find<scene::Ghost>(entity) == nullptr) found = &fingers;
        });
        return *found;
    }
    // What of the first picture of the hand is inside of solids.
    Intrusion drawn(scene::Held held, const collision::World* kept_out_of);
    [[nodiscard]] scene::Held pinching(const Pose& tool) const {
        scene::Held held = with_wrench(tool);
        held.wrench = false;
        held.pinches = true;
        held.fingers = scene::towards(tool, shoulder, 0.0);
        return held;
    }
};

// Of the hand as the renderer gets it.
Intrusion intrusion(Bench& bench) {
    Intrusion found;
    bench.place.world.view<const scene::Fingers, const scene::Placement, const scene::Drawn>().each(
        [&](ecs::Entity entity, const scene::Fingers& fingers, const scene::Placement& placement,
            const scene::Drawn& drawn) {
            if (bench.place.world.find<scene::Ghost>(entity) != nullptr) return;
            for (const assets::Primitive& p : bench.shelf.hand.meshes[drawn.mesh].primitives)
                for (std::size_t i = 0; i < p.positions.size(); ++i) {
                    glm::vec4 at(0.0F);
                    for (int k = 0; k < 4; ++k)
                        at += p.weights[i][k] *
                              (fingers.deformation->joints[p.joints[i][k]] * glm::vec4(p.positions[i], 1.0F));
                    const Vec3 in_assembly(placement.world * at);
                    Vec3 out(0.0);
                    const double depth = scene::depth_in(bench.solids(), in_assembly, 0.0, out);
                    ++found.vertices;
                    if (depth > 0.0) ++found.inside;
                    found.depth = std::max(found.depth, depth);
                }
        });
    return found;
}

Intrusion Bench::drawn(scene::Held held, const collision::World* kept_out_of) {
    forget();
    held.solids = kept_out_of;
    scene::place_hand(place.world, postures, held);
    return intrusion(*this);
}

}  // namespace

TEST_CASE("Hand clearance: with the wrench on any nut of the reducer the drawn hand stays out of solids") {
    Bench bench("zq350");
    Intrusion before, after;
    for (std::size_t joint = 0; joint < bench.at.setup.nuts.size(); ++joint)
        for (int k = 0; k < 4; ++k) {
            const scene::Held held = bench.with_wrench(bench.wrench_on(joint, k * 0.5 * pi));
            before += bench.drawn(held, nullptr);
            after += bench.drawn(held, &bench.solids());
        }
    MESSAGE(before.text() << " before, " << after.text() << " after");
    CHECK(before.depth > 6e-3);
    CHECK(before.share() > 3e-3);
    CHECK(after.depth < 2e-3);
    CHECK(after.share() < 2e-4);
}

TEST_CASE(
    "Hand clearance: the fingers on any nut of the reducer, and the hand behind them, stay out of solids") {
    Bench bench("zq350");
    Intrusion before, after;
    int clear = 0;
    for (std::size_t joint = 0; joint < bench.at.setup.nuts.size(); ++joint) {
        const Pose tool{servo::nut_centre(bench.at.setup.nuts[joint], 0.0),
                        motion::orientation_of(bench.at.setup.nuts[joint], 0.0, false)};
        const scene::Held held = bench.pinching(tool);
        before += bench.drawn(held, nullptr);
        const Intrusion now = bench.drawn(held, &bench.solids());
        if (now.depth < 1e-3) ++clear;
        after += now;
    }
    MESSAGE(before.text() << " before, " << after.text() << " after");
    CHECK(before.share() > 0.02);
    CHECK(after.share() < 0.005);
    CHECK(after.depth < 5e-3);
    CHECK(clear >= 10);
}

TEST_CASE("Hand clearance: the drawn hand does not jump while the wrench swings") {
    Bench bench("zq350");
    constexpr std::size_t joint = 3;  // beside the casing's wall
    const Pose middle = bench.wrench_on(joint, 0.5 * pi);
    const Vec3 axis = bench.at.setup.nuts[joint].axis;
    const std::size_t grip = bench.with_wrench(middle).grip;
    bench.forget();
    hand::Skeleton last;
    double furthest = 0.0, departed = 0.0, spent = 0.0;
    constexpr int frames = 90;
    for (int frame = 0; frame < frames; ++frame) {
        const Quat swing =
            glm::angleAxis(to_radians(60.0) * (static_cast<double>(frame) / frames - 0.5), axis);
        scene::Held held = bench.with_wrench({middle.position, swing * middle.orientation});
        held.grip = grip;
        held.solids = &bench.solids();
        const auto start = std::chrono::steady_clock::now();
        scene::place_hand(bench.place.world, bench.postures, held);
        if (frame > 0)
            spent += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        const scene::Fingers& fingers = bench.fingers();
        for (std::size_t i = 0; i < hand::joint_count; ++i)
            if (frame > 0)
                furthest = std::max(furthest, glm::distance(fingers.shown.position[i], last.position[i]));
        last = fingers.shown;
        for (const double by : fingers.clearance.shown) departed = std::max(departed, std::abs(by));
    }
    MESSAGE("at most " << 1e3 * furthest << " mm a frame; " << 1e3 * spent / (frames - 1) << " ms a frame");
    CHECK(departed > 0.1);  // it did have to give way
    CHECK(furthest < 15e-3);
}

TEST_CASE("Hand clearance: a hand that cannot get out is seen through, more so the deeper it is") {
    scene::World world;
    const ecs::Entity one = world.create();
    world.add<scene::Placement>(one);
    world.add<scene::Drawn>(one);
    scene::Fingers& fingers = world.add<scene::Fingers>(one);
    const auto opacity = [&](double depth) {
        fingers.clearance.depth = depth;
        render::Scene drawn;
        scene::present(world, drawn);
        return drawn.objects.at(0).opacity;
    };
    CHECK(opacity(-1e-3) == 1.0F);
    CHECK(opacity(2e-3) == 1.0F);
    CHECK(opacity(8e-3) < 0.8F);
    CHECK(opacity(20e-3) < 0.2F);
}
