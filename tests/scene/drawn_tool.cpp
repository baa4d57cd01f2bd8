// The drawn tool over a scripted swing, in the workplace that windows, headsets, walls and films draw.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <glm/gtc/quaternion.hpp>
#include <map>
#include <set>
#include <string>

#include "game/lesson/step_requirements.hpp"
#include "game/scene/systems.hpp"
#include "game/scene/workplace.hpp"
#include "haptics/servo/engagement.hpp"
#include "tests/trainer/player.hpp"

using namespace bolt;

namespace {

struct ToolWorkplace {
    session::SessionSetup at;
    scene::LessonModels models;
    std::unique_ptr<scene::GpuLessonModels> on_gpu = std::make_unique<scene::GpuLessonModels>();
    scene::Workplace workplace;
    scene::Postures postures;
    std::optional<session::LessonTracker> tracker;

    explicit ToolWorkplace(const content::Assembly& assembly) {
        auto prepared = session::prepare_session(assembly, {});
        REQUIRE(prepared);
        at = std::move(*prepared);
        auto loaded = scene::load_lesson_models(at.assembly);
        REQUIRE(loaded);
        models = std::move(*loaded);
        on_gpu->workpiece = boxes_of(models.workpiece.model);
        on_gpu->workshop = boxes_of(models.workshop);
        for (const scene::ToolModel& tool : models.tools) on_gpu->tools.push_back(boxes_of(tool.model));
        on_gpu->hand = boxes_of(models.hand);
        scene::SceneWorld world;
        world::add_haptics(world, at.state);
        auto made = scene::make_workplace(std::move(world), models, *on_gpu, at.assembly, at.setup);
        REQUIRE(made);
        workplace = std::move(*made);
        postures = scene::make_postures(nullptr, at.setup.wrench.handle_length, hand::Side::right,
                                        scene::widest_nut(at.setup));
        tracker.emplace(session::LessonTracker{
            lesson::begin(at.assembly, lesson::Mode::guided, lesson::Task::tighten), 0});
    }

    // The part of an uploaded model that make_workplace() reads.
    static render::GpuModel boxes_of(const assets::Model& model) {
        render::GpuModel uploaded;
        for (const assets::Mesh& mesh : model.meshes) {
            uploaded.meshes.push_back({static_cast<std::uint32_t>(uploaded.parts.size()), 1});
            render::MeshPart part;
            for (const assets::Primitive& p : mesh.primitives)
                for (const glm::vec3& corner : p.positions) part.box.add(corner);
            uploaded.parts.push_back(part);
        }
        return uploaded;
    }

    // A tick and a frame with the handle at this angle on the nut of joint 0, tightening positive.
    void step(double handle) {
        const servo::NutGeometry& nut = at.setup.nuts[0];
        const Vec3 centre = servo::nut_centre(nut, at.state.joints[0].nut.angle);
        const Vec3 x = servo::direction_at(nut, handle);
        const Quat q = glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(nut.axis, x), nut.axis)));
        servo::TickInput input;
        input.dead_man = true;
        input.grip = servo::Grip::wrench;
        for (int i = 0; i < 3; ++i) input.commanded_tool.position[i] = static_cast<float>(centre[i]);
        const double orientation[] = {q.w, q.x, q.y, q.z};
        for (int i = 0; i < 4; ++i) input.commanded_tool.orientation[i] = static_cast<float>(orientation[i]);
        const servo::Output output = servo::tick(at.setup, at.state, input);
        session::TickContext tick{{at.state, input, output}, at.setup, *tracker};
        const world::WriteHaptics access(workplace.world);
        ecs::run(session::tick_systems, access, tick);
        scene::placement_system(workplace.world, {at.setup, postures, Vec3(0.5)});
    }

    // rad about the bolt's axis, of each drawn part of the tool in use, by the name of its node.
    [[nodiscard]] std::map<std::string, double> angles() {
        std::map<std::string, double> found;
        const servo::NutGeometry& nut = at.setup.nuts[0];
        const assets::Model& model = models.tools[at.setup.tool].model;
        workplace.world.view<const scene::ToolPart, const scene::Transform, const scene::Drawable>().each(
            [&](const scene::ToolPart& part, const scene::Transform& transform,
                const scene::Drawable& drawn) {
                if (part.tool != at.setup.tool) return;
                const glm::dmat4 tool = glm::dmat4(transform.world) * glm::inverse(part.tool_from_mesh);
                found[model.nodes[static_cast<std::size_t>(drawn.node)].name] =
                    servo::angle_of(nut, Vec3(tool[0]));
            });
        return found;
    }
    // The names of the visible nodes of the tool in use.
    [[nodiscard]] std::set<std::string> visible() {
        std::set<std::string> found;
        const assets::Model& model = models.tools[at.setup.tool].model;
        workplace.world.view<const scene::ToolPart, const scene::Drawable>().each(
            [&](ecs::Entity entity, const scene::ToolPart& part, const scene::Drawable& drawn) {
                const scene::Appearance* appearance = workplace.world.find<scene::Appearance>(entity);
                if (part.tool == at.setup.tool && (appearance == nullptr || !appearance->hidden))
                    found.insert(model.nodes[static_cast<std::size_t>(drawn.node)].name);
            });
        return found;
    }
};

}  // namespace

TEST_CASE(
    "Ratchet: the drawn socket stands still while the handle swings back, and turns with it in a pull") {
    content::Assembly assembly = trainer_test::assembly("dn200-pn16");
    REQUIRE(content::choose_tool(assembly, "ratchet"));
    ToolWorkplace fixture(assembly);
    double handle = to_radians(20.0);
    for (int i = 0; i < 50; ++i) fixture.step(handle);
    REQUIRE(fixture.at.state.engagement.joint == 0);
    const auto swing = [&](double degrees) {
        const std::map<std::string, double> before = fixture.angles();
        const int steps = static_cast<int>(std::abs(degrees) * 20.0);
        for (int i = 0; i < steps; ++i) fixture.step(handle += to_radians(degrees) / steps);
        REQUIRE(fixture.at.state.engagement.joint == 0);
        std::map<std::string, double> turned = fixture.angles();
        for (auto& [name, angle] : turned) angle = to_degrees(wrap(angle - before.at(name), 2.0 * pi));
        return turned;
    };
    // Pull until the nut resists by more than the pawl.
    const auto torque = [&] { return fixture.at.state.joints[0].torque; };
    for (int i = 0; i < 100000 && torque() < 30.0; ++i) fixture.step(handle += to_radians(0.2));
    REQUIRE(torque() >= 30.0);
    (void)swing(-20.0);  // off the load

    const auto back = swing(-60.0);
    for (const char* name : {"socket", "socket_size", "drive"}) {
        CAPTURE(name);
        REQUIRE(back.contains(name));
        CHECK(std::abs(back.at(name)) < 0.6);  // the play
    }
    for (const char* name : {"head", "neck", "grip", "lever"}) {
        CAPTURE(name);
        REQUIRE(back.contains(name));
        CHECK(back.at(name) == doctest::Approx(-60.0).epsilon(0.001));
    }
    (void)swing(8.0);  // the pawl takes hold, and the play is used up
    const auto pulled = swing(6.0);
    for (const char* name : {"socket", "socket_size", "drive"}) {
        CAPTURE(name);
        CHECK(pulled.at(name) > 1.0);  // the nut turns, less by the twist of the tool
        CHECK(pulled.at(name) == doctest::Approx(pulled.at("socket")));
    }
}

TEST_CASE("Electronic torque wrench: its display shows the torque, and its light the step's window") {
    content::Assembly assembly = trainer_test::assembly("dn200-pn16");
    assembly.wrench.kind = content::ToolKind::electronic_torque_wrench;
    assembly.wrench.model.clear();  // it is generated
    ToolWorkplace fixture(assembly);
    double handle = to_radians(15.0);
    for (int i = 0; i < 50; ++i) fixture.step(handle);
    REQUIRE(fixture.at.state.engagement.joint == 0);
    lesson::Lesson& lesson = fixture.tracker->lesson;
    while (lesson.due()->kind != lesson::StepKind::tighten || lesson.due()->joint != 0) ++lesson.current;
    const content::ToleranceWindow window = lesson::torque_window(lesson, *lesson.due());
    const auto shows_torque = [&] {
        const std::set<std::string> visible = fixture.visible();
        const double torque = fixture.at.state.joints[0].torque;
        bool right = visible.contains("decimal_point") && visible.contains("grip");
        for (int digit = 0; digit < 4; ++digit)
            for (int segment = 0; segment < 7; ++segment) {
                using Kind = tool_models::DisplayElement::Kind;
                const bool on = tool_models::is_on({Kind::segment, digit, segment}, {torque, {}});
                right = right && on == visible.contains(fmt::format("segment_{}_{}", digit, segment));
            }
        return right;
    };
    CHECK(shows_torque());
    double torque = 0.0;
    const auto pull_to = [&](double goal) {
        for (int i = 0; i < 100000 && torque < goal; ++i) {
            fixture.step(handle += to_radians(0.05));
            torque = fixture.at.state.joints[0].torque;
        }
        REQUIRE(torque >= goal);
        CHECK(shows_torque());
        return fixture.visible();
    };
    const std::set<std::string> below = pull_to(0.5 * window.low);
    CHECK_FALSE(below.contains("light"));
    CHECK_FALSE(below.contains("light_exceeded"));
    const std::set<std::string> reached = pull_to(window.target);
    CHECK(reached.contains("light"));
    CHECK_FALSE(reached.contains("light_exceeded"));
    const std::set<std::string> exceeded = pull_to(1.02 * window.high);
    CHECK_FALSE(exceeded.contains("light"));
    CHECK(exceeded.contains("light_exceeded"));
}
