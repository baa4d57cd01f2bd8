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
        const double head = -setup.wrench.head_angle;
        const double handle = angle - head + misfit + static_cast<double>(turn) * pi / 3.0;
        const Vec3 x = std::cos(-handle) * nut.e1 + std::sin(-handle) * nut.e2, z = nut.axis;
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

}  // namespace bolt::test
