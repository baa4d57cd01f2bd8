#include "game/session/servo_setup.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace bolt::session {

servo::Setup make_setup(const content::Assembly& assembly, joint::Law law, const force::OutputLimits& limits,
                        std::uint64_t seed, double dt) {
    std::vector<joint::JointDesign> designs;
    double greatest = 0.0;
    for (const content::AssemblyJoint& joint : assembly.joints) {
        designs.push_back(joint.design);
        greatest = std::max(greatest, joint.spec.torque.high);
    }
    const content::FlangeDesign& f = assembly.flange;
    joint::FlangePlate plate;
    if (f.coupled) plate = joint::FlangePlate::make(f.thickness, f.E, f.poisson, f.interface_stiffness);

    servo::SetupDescription description;
    description.joints = designs;
    description.law = law;
    description.published = assembly.published;
    description.flange = f.coupled ? &plate : nullptr;
    description.jaw = assembly.wrench.jaw;
    description.head_thickness = assembly.wrench.head_thickness;
    description.jaw_throat = assembly.wrench.jaw_depth;
    description.jaw_tip = assembly.wrench.jaw_tip;
    description.head_angle = assembly.wrench.head_angle;
    description.handle_length = assembly.wrench.handle_length;
    description.greatest_torque = greatest;
    description.click_swing = assembly.wrench.click_swing;
    description.click_accuracy = assembly.wrench.click_accuracy;
    description.limits = limits;
    description.seed = seed;
    description.dt = dt;
    return servo::make_setup(description);
}

Status pretighten(const content::Assembly& assembly, const servo::Setup& setup, servo::State& state) {
    constexpr double speed = to_radians(120.0);
    constexpr int longest = 4'000'000;
    for (const std::size_t i : assembly.passes.back().order) {
        const double target = assembly.joints[i].spec.torque.target;
        joint::JointState& joint = state.joints[i];
        int steps = 0;
        // Into yield as the specification has it: where the yield stage begins, and not on to a torque.
        const bool into_yield = assembly.joints[i].spec.strategy == content::Strategy::yield;
        const auto tight = [&] {
            return joint.torque >= target || (into_yield && joint.stage == joint::Stage::yield);
        };
        while (!tight() && joint.condition == joint::Condition::sound && ++steps < longest) {
            const bool near = joint.stage != joint::Stage::navigation;
            const double step = (near ? 0.1 : 1.0) * speed * setup.dt;
            joint::turn_nut(setup.group, state.joints, i, joint.nut.angle + step, 1.0, setup.dt);
        }
        if (!tight())
            return fail(ErrorCode::bad_content,
                        fmt::format("joint {} cannot be tightened to {:.1f} N·m: it is {}",
                                    assembly.joints[i].design.id, target, joint::name(joint.condition)));
        joint.nut.speed = 0.0;
    }
    for (double rest = 0.0; rest < 10.0; rest += setup.dt)
        joint::step_group(setup.group, state.joints, -1, joint::Handle{}, setup.dt);
    return {};
}

}  // namespace bolt::session
