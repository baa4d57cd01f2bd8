// The displayed hand stays out of solids. The workplace is built as by the trainer and by films, but without
// a GPU; then every vertex of the displayed hand is tested against the contact models.
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

// The part of an uploaded model that make_workplace reads: its meshes with their boxes.
render::GpuModel without_buffers(const assets::Model& model) {
    render::GpuModel uploaded;
    for (const assets::Mesh& mesh : model.meshes) {
        uploaded.meshes.push_back({static_cast<std::uint32_t>(uploaded.parts.size()), 1});
        render::MeshPart part;
        for (const assets::Primitive& p : mesh.primitives)
            for (const glm::vec3& at : p.positions) part.box.add(at);
        uploaded.parts.push_back(part);
    }
    return uploaded;
}

struct Intrusion {
    std::size_t vertices = 0, inside = 0;
    double depth = 0.0;  // m, maximum
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

struct TestWorkplace {
    session::SessionSetup at;
    scene::LessonModels models;
    std::unique_ptr<scene::GpuLessonModels> gpu_models = std::make_unique<scene::GpuLessonModels>();
    scene::Workplace workplace;
    scene::Postures postures;
    Vec3 shoulder{0.0};

    explicit TestWorkplace(const char* name) {
        session::LessonOptions options;
        options.obstacles = session::ObstacleUse::required;
        auto prepared = session::prepare_session(trainer_test::assembly(name), options);
        REQUIRE(prepared);
        at = std::move(*prepared);
        auto loaded = scene::load_lesson_models(at.assembly);
        REQUIRE(loaded);
        models = std::move(*loaded);
        REQUIRE(models.missing.empty());
        gpu_models->workpiece = without_buffers(models.workpiece.model);
        gpu_models->workshop = without_buffers(models.workshop);
        for (const scene::ToolModel& tool : models.tools)
            gpu_models->tools.push_back(without_buffers(tool.model));
        gpu_models->hand = without_buffers(models.hand);
        scene::SceneWorld world;
        world::add_haptics(world, at.state);
        auto made = scene::make_workplace(std::move(world), models, *gpu_models, at.assembly, at.setup);
        REQUIRE(made);
        workplace = std::move(*made);
        postures = scene::make_postures(&at.state.tool_contact->wrench, at.setup.wrench.handle_length,
                                        hand::Side::right, scene::widest_nut(at.setup));
        shoulder = scene::shoulder_position(workplace.workpiece);
    }

    [[nodiscard]] const collision::CollisionWorld& solids() const { return at.state.tool_contact->world; }

    // Resets the hand to its state before the first frame.
    void reset_hand() {
        workplace.world.view<scene::SkinnedHand>().each([](scene::SkinnedHand& fingers) {
            fingers.deformation = nullptr;
            fingers.clearance = {};
        });
    }

    [[nodiscard]] scene::ToolAndHand with_wrench(const Pose& tool) const {
        scene::ToolAndHand state;
        state.tool = tool;
        state.wrench = true;
        state.handle_posture_index = scene::natural_handle_posture(postures, tool, Vec3(0, 1, 0), shoulder);
        state.effort = 0.5;
        state.seconds = 1.0 / 60.0;
        return state;
    }
    [[nodiscard]] Pose wrench_on(std::size_t joint, double handle_angle) const {
        const auto handle = motion::choose_handle_angle(at.setup, &*at.state.tool_contact, joint, {},
                                                        handle_angle, 1.0, to_radians(30.0));
        const auto& nut = at.setup.nuts[joint];
        return {servo::nut_centre(nut, 0.0), motion::tool_orientation(nut, handle.angle, handle.flipped)};
    }
    [[nodiscard]] const scene::SkinnedHand& fingers() {
        const scene::SkinnedHand* found = nullptr;
        workplace.world.view<const scene::SkinnedHand>().each(
            [&](ecs::Entity entity, const scene::SkinnedHand& fingers) {
                if (workplace.world.find<scene::GhostPart>(entity) == nullptr) found = &fingers;
            });
        return *found;
    }
    // The intrusion of the hand in its first frame. `solids`: those that it avoids; null: none.
    Intrusion first_frame(scene::ToolAndHand state, const collision::CollisionWorld* solids);
    [[nodiscard]] scene::ToolAndHand pinching(const Pose& tool) const {
        scene::ToolAndHand state = with_wrench(tool);
        state.wrench = false;
        state.pinches = true;
        state.fingers = scene::frame_towards(tool, shoulder, 0.0);
        return state;
    }
};

// The intrusion of the hand that the renderer draws.
Intrusion intrusion(TestWorkplace& fixture) {
    Intrusion found;
    fixture.workplace.world.view<const scene::SkinnedHand, const scene::Transform, const scene::Drawable>()
        .each([&](ecs::Entity entity, const scene::SkinnedHand& fingers, const scene::Transform& placement,
                  const scene::Drawable& drawn) {
            if (fixture.workplace.world.find<scene::GhostPart>(entity) != nullptr) return;
            for (const assets::Primitive& p : fixture.models.hand.meshes[drawn.mesh].primitives)
                for (std::size_t i = 0; i < p.positions.size(); ++i) {
                    glm::vec4 at(0.0F);
                    for (int k = 0; k < 4; ++k)
                        at += p.weights[i][k] *
                              (fingers.deformation->joints[p.joints[i][k]] * glm::vec4(p.positions[i], 1.0F));
                    const Vec3 in_assembly(placement.world * at);
                    Vec3 out(0.0);
                    const double depth = scene::penetration_depth(fixture.solids(), in_assembly, 0.0, out);
                    ++found.vertices;
                    if (depth > 0.0) ++found.inside;
                    found.depth = std::max(found.depth, depth);
                }
        });
    return found;
}

Intrusion TestWorkplace::first_frame(scene::ToolAndHand state, const collision::CollisionWorld* solids) {
    reset_hand();
    state.solids = solids;
    scene::place_hand(workplace.world, postures, state);
    return intrusion(*this);
}

}  // namespace

TEST_CASE(
    "Hand clearance: with the wrench on any nut of the reducer the displayed hand stays out of solids") {
    TestWorkplace fixture("zq350");
    Intrusion before, after;
    for (std::size_t joint = 0; joint < fixture.at.setup.nuts.size(); ++joint)
        for (int k = 0; k < 4; ++k) {
            const scene::ToolAndHand state = fixture.with_wrench(fixture.wrench_on(joint, k * 0.5 * pi));
            before += fixture.first_frame(state, nullptr);
            after += fixture.first_frame(state, &fixture.solids());
        }
    MESSAGE(before.text() << " before, " << after.text() << " after");
    CHECK(before.depth > 6e-3);
    CHECK(before.share() > 3e-3);
    CHECK(after.depth < 2e-3);
    CHECK(after.share() < 2e-4);
}

TEST_CASE(
    "Hand clearance: with the fingers on any nut of the reducer the displayed hand stays out of solids") {
    TestWorkplace fixture("zq350");
    Intrusion before, after;
    int clear = 0;
    for (std::size_t joint = 0; joint < fixture.at.setup.nuts.size(); ++joint) {
        const Pose tool{servo::nut_centre(fixture.at.setup.nuts[joint], 0.0),
                        motion::tool_orientation(fixture.at.setup.nuts[joint], 0.0, false)};
        const scene::ToolAndHand state = fixture.pinching(tool);
        before += fixture.first_frame(state, nullptr);
        const Intrusion now = fixture.first_frame(state, &fixture.solids());
        if (now.depth < 1e-3) ++clear;
        after += now;
    }
    MESSAGE(before.text() << " before, " << after.text() << " after");
    CHECK(before.share() > 0.02);
    CHECK(after.share() < 0.005);
    CHECK(after.depth < 5e-3);
    CHECK(clear >= 10);
}

TEST_CASE("Hand clearance: the displayed hand does not jump while the wrench swings") {
    TestWorkplace fixture("zq350");
    constexpr std::size_t joint = 3;  // beside the casing's wall
    const Pose middle = fixture.wrench_on(joint, 0.5 * pi);
    const Vec3 axis = fixture.at.setup.nuts[joint].axis;
    const std::size_t posture = fixture.with_wrench(middle).handle_posture_index;
    fixture.reset_hand();
    hand::Skeleton last;
    double furthest = 0.0, departed = 0.0, spent = 0.0;
    constexpr int frames = 90;
    for (int frame = 0; frame < frames; ++frame) {
        const Quat swing =
            glm::angleAxis(to_radians(60.0) * (static_cast<double>(frame) / frames - 0.5), axis);
        scene::ToolAndHand state = fixture.with_wrench({middle.position, swing * middle.orientation});
        state.handle_posture_index = posture;
        state.solids = &fixture.solids();
        const auto start = std::chrono::steady_clock::now();
        scene::place_hand(fixture.workplace.world, fixture.postures, state);
        if (frame > 0)
            spent += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        const scene::SkinnedHand& fingers = fixture.fingers();
        for (std::size_t i = 0; i < hand::joint_count; ++i)
            if (frame > 0)
                furthest = std::max(furthest, glm::distance(fingers.shown.position[i], last.position[i]));
        last = fingers.shown;
        for (const double by : fingers.clearance.shown) departed = std::max(departed, std::abs(by));
    }
    MESSAGE("at most " << 1e3 * furthest << " mm a frame; " << 1e3 * spent / (frames - 1) << " ms a frame");
    CHECK(departed > 0.1);  // the hand had to avoid the wall
    CHECK(furthest < 15e-3);
}

TEST_CASE("Hand clearance: a hand that cannot avoid a solid fades with its depth") {
    scene::SceneWorld world;
    const ecs::Entity one = world.create();
    world.add<scene::Transform>(one);
    world.add<scene::Drawable>(one);
    scene::SkinnedHand& fingers = world.add<scene::SkinnedHand>(one);
    const auto opacity = [&](double depth) {
        fingers.clearance.depth = depth;
        render::Scene drawn;
        scene::appearance_system(world);
        view::collect_objects(world, drawn);
        return drawn.objects.at(0).opacity;
    };
    CHECK(opacity(-1e-3) == 1.0F);
    CHECK(opacity(2e-3) == 1.0F);
    CHECK(opacity(8e-3) < 0.8F);
    CHECK(opacity(20e-3) < 0.2F);
}
