#include "tests/tool_contact/support.hpp"

namespace bolt::test {

namespace {

content::Assembly shipped(const char* name) {
    content::LoadedAssembly loaded = content::load_assembly(name);
    REQUIRE(loaded.ok());
    return std::move(loaded.assembly);
}

}  // namespace

Workbench::Workbench(const char* name, const force::OutputLimits& limits)
    : Workbench(shipped(name), limits) {}

Workbench::Workbench(content::Assembly lesson, const force::OutputLimits& limits)
    : assembly(std::move(lesson)) {
    setup = session::make_setup(assembly, joint::Law::mechanistic, limits, 1, 0.001);
    state = servo::initial_state(setup);
    Result<std::optional<servo::ToolContact>> loaded_contact = session::load_tool_contact(assembly, setup);
    REQUIRE_MESSAGE(loaded_contact, (loaded_contact ? "" : loaded_contact.error().message()));
    REQUIRE(loaded_contact->has_value());
    state.tool_contact = std::move(*loaded_contact);
}

Pose Workbench::wrench(std::size_t joint, double above, double misfit, const Vec3& beside,
                       const Vec3& towards) const {
    const servo::NutGeometry& nut = setup.nuts[joint];
    const double angle = state.joints[joint].nut.angle;
    Pose best;
    double nearest = -2.0;
    for (int turn = 0; turn < 6; ++turn) {
        const double head = -nut.sense * setup.wrench.head_angle;
        const double handle = angle - head + misfit + static_cast<double>(turn) * pi / 3.0;
        const Vec3 x = servo::direction_at(nut, handle), z = nut.axis;
        if (glm::dot(x, towards) <= nearest) continue;
        nearest = glm::dot(x, towards);
        best.orientation = glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z)));
    }
    best.position = servo::nut_centre(nut, angle) + above * nut.axis + beside.x * nut.e1 + beside.y * nut.e2;
    return best;
}

servo::Output Workbench::step(const Pose& hand, servo::Grip grip) {
    servo::TickInput input;
    input.dead_man = true;
    input.grip = grip;
    input.commanded_tool = servo::to_commanded_tool(hand);
    return servo::tick(setup, state, input);
}

assets::Model plate_with(const PartOnPlate& part) {
    assets::Model model;
    const auto add = [&](const std::string& name, double radius, double low, double high, int sides,
                         int parent) {
        assets::Primitive prism;
        for (const double y : {low, high})
            for (int i = 0; i < sides; ++i) {
                const double angle = (i + 0.5) * 2.0 * pi / sides;
                prism.positions.emplace_back(radius * std::cos(angle), y, -radius * std::sin(angle));
            }
        const auto n = static_cast<std::uint32_t>(sides);
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t j = (i + 1) % n;
            for (const std::uint32_t k : {i, j, n + j, i, n + j, n + i}) prism.indices.push_back(k);
            if (i == 0 || j == 0) continue;
            for (const std::uint32_t k : {0U, j, i, n, n + i, n + j}) prism.indices.push_back(k);
        }
        assets::Node node;
        node.name = name;
        node.mesh = static_cast<int>(model.meshes.size());
        assets::Mesh mesh;
        mesh.name = name;
        mesh.primitives.push_back(std::move(prism));
        model.meshes.push_back(std::move(mesh));
        const int index = static_cast<int>(model.nodes.size());
        if (parent >= 0)
            model.nodes[static_cast<std::size_t>(parent)].children.push_back(index);
        else
            model.roots.push_back(index);
        model.nodes.push_back(std::move(node));
    };
    add("plate", 0.1, -0.03, 0.0, 4, -1);
    assets::Node joint;
    joint.name = "B1";
    model.roots.push_back(static_cast<int>(model.nodes.size()));
    model.nodes.push_back(joint);
    add(part.node, part.radius, 0.0, part.height, part.sides, 1);
    return model;
}

}  // namespace bolt::test
