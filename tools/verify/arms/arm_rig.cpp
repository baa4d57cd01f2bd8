#include "tools/verify/arms/arm_rig.hpp"

#include <algorithm>
#include <utility>

#include "game/session/lesson_session.hpp"
#include "haptics/station/station.hpp"

namespace bolt::arm_validation {

namespace {

constexpr double tick_length = 1e-3;  // s
constexpr std::uint64_t joint_seed = 1;

// Resets the contact state to that after loading: results must not depend on earlier runs.
void reset_contact(servo::ToolContact& contact, const servo::Setup& setup) {
    contact.narrow_phase = collision::make_narrow_phase(contact.world, contact.wrench);
    contact.god_object = {};
    contact.last_step = {};
    contact.cache = {};
    contact.joint_at_head = -1;
    contact.in_hand = false;
    contact.touched = {};
    servo::set_coupling(setup, contact);
}

// Multiplies the stiffness that make_coupling() has chosen. The damper is the one that make_coupling() would
// choose for the new stiffness if the change of the force in a millisecond were not limited.
void stiffen(proxy::Coupling& coupling, double factor) {
    constexpr double margin = 0.8, physical = 2.0;  // haptics/proxy/coupling
    if (factor == 1.0) return;
    coupling.stiffness *= factor;
    coupling.damping = std::min(
        coupling.damping, 0.5 * std::max(0.0, margin * physical - 0.5 * coupling.stiffness * tick_length));
}

station::DeviceLayout layout_of(const ArmFacts& facts, const Pose& tool, double handle_length) {
    station::StationOptions options;
    options.handle_length = handle_length;
    options.home = tool;
    device::Description description = facts.announced();
    description.limits.ramp_up = tick_length;  // the force has ramped up before the measurement
    Result<station::DeviceLayout> layout = station::make_layout(options, std::move(description), {});
    return std::move(*layout);  // a mover that senses poses always has a layout
}

}  // namespace

Result<TightenedAssembly> load_tightened_assembly(const std::string& name) {
    content::LoadedAssembly loaded = content::load_assembly(name);
    if (!loaded.ok()) return fail(loaded.errors.front());
    TightenedAssembly tightened{std::move(loaded.assembly), {}};
    const servo::Setup setup =
        session::make_setup(tightened.assembly, tightened.assembly.law, {}, joint_seed, tick_length);
    tightened.state = servo::initial_state(setup);
    BOLT_TRY(session::pretighten(tightened.assembly, setup, tightened.state));
    Result<std::optional<servo::ToolContact>> contact = session::load_tool_contact(tightened.assembly, setup);
    if (!contact) return fail(contact.error());
    if (!contact->has_value())
        return fail(ErrorCode::bad_content, name + ": has no contact model",
                    "\"contact_model\" in assembly.json");
    tightened.state.tool_contact = std::move(*contact);
    session::seat_nuts(setup, *tightened.state.tool_contact);
    return tightened;
}

ArmRig::ArmRig(TightenedAssembly& tightened_assembly, const RigOptions& options)
    : tightened(tightened_assembly), facts(*options.arm), unheld(options.hand.unheld) {
    layout = layout_of(facts, options.tool, tightened.assembly.wrench.handle_length);
    force::OutputLimits limits = station::limits_of(layout);
    if (!options.controller) limits.damping = limits.angular_damping = 0.0;
    setup = session::make_setup(tightened.assembly, tightened.assembly.law, limits, joint_seed, tick_length);
    setup.wrench.stiffness *= options.wrench_factor;
    servo = servo::initial_state(setup);
    servo.joints = tightened.state.joints;
    servo.tool_contact = std::exchange(tightened.state.tool_contact, std::nullopt);
    reset_contact(*servo.tool_contact, setup);
    stiffen(servo.tool_contact->parameters.coupling, options.coupling_factor);
    station = station::initial_state(layout);
    inputs.mover.usable = true;
    inputs.mover.connection_number = 1;
    inputs.controls.dead_man = true;
    inputs.controls.grip = servo::Grip::wrench;
    inputs.controls.guided_joint = static_cast<std::int16_t>(options.guided_joint);
    arm.parameters = parameters_of(facts, options.hand);
    for (int i = 0; i < 3; ++i) tick();  // the station takes the arm and the wrench
    arm.energy_to_hand = 0.0;
    record = {};
    time = 0.0;
}

ArmRig::~ArmRig() { tightened.state.tool_contact = std::exchange(servo.tool_contact, std::nullopt); }

void ArmRig::tick() {
    Pose sensed = device::encoder_pose(arm);
    if (!facts.senses_rotation) sensed.orientation = Quat(1.0, 0.0, 0.0, 0.0);
    inputs.mover.sample.pose = sensed;
    ++inputs.mover.number;
    const force::OutputCommand before =
        std::exchange(command, station::step(layout, setup, station, servo, inputs, ++ticks).commands.mover);
    device::step(arm, command, setup.dt);
    time += setup.dt;
    record.energy = arm.energy_to_hand;
    record.greatest_energy = std::max(record.greatest_energy, arm.energy_to_hand);
    record.greatest_force = std::max(record.greatest_force, glm::length(command.force));
    record.greatest_torque = std::max(record.greatest_torque, glm::length(command.torque));
    record.step = std::max(record.step, glm::length(command.force - before.force));
    record.torque_step = std::max(record.torque_step, glm::length(command.torque - before.torque));
}

Pose ArmRig::device_pose(const Pose& tool) const {
    const force::WorkspaceState& w = station.workspace;
    const Quat back = glm::conjugate(w.heading * layout.workspace.rotation);
    return {back * (force::lever_end(w, tool) - w.centre) / layout.workspace.scale,
            glm::normalize(back * tool.orientation * glm::conjugate(w.tool_to_device))};
}

double ArmRig::contact_force() const { return glm::length(servo.tool_contact->god_object.rendered.force); }

double ArmRig::coupling_stiffness() const {
    const force::WorkspaceMap& w = layout.workspace;
    return servo.tool_contact->parameters.coupling.stiffness * w.power_ratio * w.scale * w.scale;
}

double ArmRig::nut_stiffness() const {
    const force::WorkspaceMap& w = layout.workspace;
    const force::TorqueRendering& r = setup.torque_rendering;
    if (r.scale > 0.0) return setup.wrench.stiffness * r.scale * w.power_ratio;
    return setup.wrench.stiffness * r.as_force / setup.wrench.handle_length * w.power_ratio * w.scale *
           w.scale;
}

}  // namespace bolt::arm_validation
