#include "tools/verify/arms/arm_facts.hpp"

#include <algorithm>

namespace bolt::arm_validation {

namespace {

using device::Description;

// Descriptions as the drivers in haptics/device announce them. tests/device/arm_facts.cpp compares these with
// the drivers.
Description announced(double force, double torque, const char* name) {
    Description d;
    d.name = d.id = name;
    const bool turns = torque > 0.0;
    d.renders = {true, true, true, turns, turns, turns};
    d.limits.force = force;
    d.limits.torque = torque;
    if (!turns) d.limits.torsion = d.limits.angular_damping = 0.0;
    d.half_workspace = Vec3(0.075);
    return d;
}

Description omega() {
    Description d = announced(12.0, 0.0, "omega");
    d.limits.stiffness = 5000.0;
    d.limits.damping = 15.0;
    return d;
}

Description delta() {
    Description d = announced(20.0, 0.0, "delta.3");
    d.limits.stiffness = 5000.0;
    d.limits.damping = 15.0;
    d.half_workspace = Vec3(0.15);
    return d;
}

Description falcon() {
    Description d = announced(8.0, 0.0, "Falcon");
    d.limits.stiffness = 3000.0;
    d.limits.damping = 5.0;
    d.half_workspace = Vec3(0.04);
    return d;
}

Description sigma() {
    Description d = announced(12.0, 0.2, "sigma.7");
    d.limits.stiffness = 4000.0;
    d.limits.torsion = 2.0;
    d.limits.damping = 15.0;
    d.limits.angular_damping = 0.01;
    return d;
}

Description lambda() {
    Description d = sigma();
    d.name = d.id = "lambda.7";
    d.limits.stiffness = 8000.0;
    d.half_workspace = Vec3(0.11);
    return d;
}

Description touch() {
    Description d = announced(3.3, 0.0, "openhaptics Touch");
    d.limits.stiffness = 400.0;
    d.limits.damping = 3.0;
    d.limits.delay = 2;
    return d;
}

Description premium() {
    Description d = announced(8.5, 0.0, "openhaptics Premium");
    d.limits.stiffness = 800.0;
    d.limits.damping = 5.0;
    d.limits.delay = 2;
    d.half_workspace = Vec3(0.12);
    return d;
}

Description inverse3() {
    Description d = announced(10.0, 0.0, "haply Inverse3");
    d.limits.stiffness = 1000.0;
    d.limits.damping = 5.0;
    d.limits.delay = 3;
    d.half_workspace = Vec3(0.1);
    return d;
}

// An arm behind a plug-in that announces the default values of force::OutputLimits.
Description virtuose() {
    Description d = announced(20.0, 2.0, "plug-in");
    d.half_workspace = Vec3(0.2);
    return d;
}

constexpr Fact assumed(double value) { return {value, Origin::assumed, {}}; }
constexpr Fact unverified(double value, std::string_view source) {
    return {value, Origin::unverified, source};
}
constexpr Fact published(double value, std::string_view source) { return {value, Origin::published, source}; }

constexpr std::string_view force_dimension_sheet = "Force Dimension, data sheet of the arm";
constexpr std::string_view touch_sheet =
    "SensAble, PHANTOM Omni technical specifications (now 3D Systems Touch)";
constexpr std::string_view premium_sheet = "SensAble, PHANTOM Premium 1.5 technical specifications";
constexpr std::string_view falcon_page =
    "github.com/SenseGraphics/h3dapi, wiki page Novint_Falcon: > 400 dpi";

// Makers state an upper bound of the friction ("less than 0.26 N"). Friction helps stability, so half of the
// bound is used. If no figure was found, 0.05 N is used. Light arms are harder to keep stable than heavy
// ones, so the assumed masses are low.
constexpr double wrist_inertia = 1e-4;  // kg·m², of a stylus or a gimbal

const std::array table{
    ArmFacts{"omega3", "omega.3", omega, false, assumed(0.10), assumed(0.05),
             unverified(10e-6, force_dimension_sheet), assumed(wrist_inertia), assumed(1e-4)},
    ArmFacts{"omega7", "omega.6, omega.7", omega, true, assumed(0.15), assumed(0.05),
             unverified(10e-6, force_dimension_sheet), assumed(wrist_inertia),
             unverified(to_radians(0.09), force_dimension_sheet)},
    ArmFacts{"delta3", "delta.3", delta, false, assumed(0.15), assumed(0.05),
             unverified(20e-6, force_dimension_sheet), assumed(wrist_inertia), assumed(1e-4)},
    ArmFacts{"falcon", "Falcon", falcon, false, assumed(0.10), assumed(0.05),
             published(0.0254 / 400.0, falcon_page), assumed(wrist_inertia), assumed(1e-4)},
    ArmFacts{"sigma7", "sigma.7", sigma, true, assumed(0.20), assumed(0.05),
             unverified(1.5e-6, force_dimension_sheet), assumed(wrist_inertia),
             unverified(to_radians(0.013), force_dimension_sheet)},
    ArmFacts{"lambda7", "lambda.7", lambda, true, assumed(0.20), assumed(0.05), assumed(10e-6),
             assumed(wrist_inertia), assumed(1e-3)},
    ArmFacts{"touch", "Touch", touch, true, unverified(0.045, touch_sheet), unverified(0.13, touch_sheet),
             unverified(55e-6, touch_sheet), assumed(2e-5), assumed(1e-3)},
    ArmFacts{"premium", "Premium 1.5", premium, true, unverified(0.075, premium_sheet),
             unverified(0.02, premium_sheet), unverified(30e-6, premium_sheet), assumed(2e-5), assumed(1e-3)},
    ArmFacts{"inverse3", "Inverse3", inverse3, true, assumed(0.15), assumed(0.05), assumed(50e-6),
             assumed(wrist_inertia), assumed(1e-3)},
    ArmFacts{"virtuose", "6-DoF plug-in", virtuose, true, assumed(0.30), assumed(0.05), assumed(20e-6),
             assumed(1e-3), assumed(1e-4)},
};

}  // namespace

std::span<const ArmFacts> arm_table() { return table; }

const ArmFacts* find_arm(std::string_view key) {
    const auto found = std::find_if(table.begin(), table.end(), [&](const auto& a) { return a.key == key; });
    return found == table.end() ? nullptr : &*found;
}

// The usual hand is the arm of Fig. 3 in "Haptic perception of force magnitude and its relation to postural
// arm dynamics in 3D", Sci. Rep. 5 (2015) 18004: 0.554 kg, 6.45 N·s/m, 135 N/m. All other values are ours.
// Those of the three hands lie in the ranges of tests/support/random_arm.hpp, for the loose and the stiff one
// near the ends. "no hand" lies outside: only a very soft spring acts on the position.
const std::array<NamedHandImpedance, hand_impedance_count>& hand_impedances() {
    static constexpr std::array<NamedHandImpedance, hand_impedance_count> hands{
        NamedHandImpedance{"no hand", 0.0, 0.0, 5.0, 1e-4, 2e-3, 0.3, true},
        NamedHandImpedance{"loose", 0.08, 2.0, 60.0, 4e-4, 0.01, 0.5},
        NamedHandImpedance{"usual", 0.554, 6.45, 135.0, 2e-3, 0.05, 2.0},
        NamedHandImpedance{"stiff", 1.0, 20.0, 1000.0, 5e-3, 0.12, 6.0},
    };
    return hands;
}

device::HandAndArmParameters parameters_of(const ArmFacts& arm, const NamedHandImpedance& hand) {
    device::HandAndArmParameters p;
    p.mass = arm.mass.value + hand.mass;
    p.damping = hand.damping;
    p.stiffness = hand.stiffness;
    p.inertia = arm.inertia.value + hand.inertia;
    p.angular_damping = hand.angular_damping;
    p.angular_stiffness = hand.angular_stiffness;
    p.friction = arm.friction.value;
    p.angular_friction = 0.0;
    p.encoder = arm.encoder.value;
    p.angular_encoder = arm.angular_encoder.value;
    p.delay = arm.announced().limits.delay;
    return p;
}

}  // namespace bolt::arm_validation
