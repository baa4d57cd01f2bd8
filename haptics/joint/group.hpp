// A group of joints under one law: its state and step, the elastic interaction of its joints through the
// flange, and torque-angle curves. The flange is a plate on an elastic foundation.
//
// Tightening one bolt presses the flange down around it, so neighbouring bolts lose preload; further away the
// plate bends upward and bolts gain preload. No reliable coefficients for a gear casing are published, so
// this model is ours, derived from the flange's own dimensions: a thin plate (Kirchhoff) of flexural rigidity
// D = E h³/(12 (1 − ν²)) on a foundation of stiffness k per area (the parting faces). Its deflection at
// distance r from a force F is
//
//   w(r) = −F ℓ²/(2π D) kei(r/ℓ),   ℓ = (D/k)^¼        (Hertz 1884; Timoshenko & Woinowsky-Krieger, §57)
//
// kei is the Kelvin function of order 0; kei(0) = −π/4. The energy that any set of forces stores
// in plate and foundation is never negative. So the matrix of w between any points is symmetric and positive
// semidefinite, and the interaction never generates energy.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/math.hpp"
#include "haptics/joint/law.hpp"
#include "haptics/joint/mechanistic.hpp"
#include "haptics/joint/nut.hpp"
#include "haptics/joint/published.hpp"

namespace bolt::joint {

struct FlangePlate {
    double rigidity = 0.0;    // D, N·m
    double foundation = 0.0;  // k, Pa/m

    // `thickness` in m, `E` in Pa, `interface_stiffness` (k) in Pa/m.
    static FlangePlate make(double thickness, double E, double poisson, double interface_stiffness);
    [[nodiscard]] double length() const;                        // ℓ, m
    [[nodiscard]] double deflection_per_force(double r) const;  // w/F, m/N
};

// kei(x) = Im K0(x e^{iπ/4}), x ≥ 0; absolute error below 1e-12.
double kelvin_kei(double x);

// The elastic interaction: symmetric compliance between joints, sparse by rows (CSR). Pairs further apart
// than 10 ℓ are omitted, because w is below 10⁻³ of w(0) there. The diagonal, a joint's own deflection, is
// not stored in the rows: it is the same for all.
struct InteractionMatrix {
    double own_compliance = 0.0;           // m/N, the diagonal
    std::vector<std::uint32_t> row_begin;  // size joints + 1
    std::vector<std::uint32_t> column;
    std::vector<double> value;  // m/N
};

// `seats`: m, position of each joint.
InteractionMatrix interaction_matrix(const FlangePlate& plate, std::span<const Vec3> seats);

// A joint under Law::published. The boundaries follow from the law; a tick needs them several times.
struct PublishedLaw {
    PublishedParameters parameters;
    PublishedBoundaries boundaries;
};

struct GroupParameters {
    Law law = Law::mechanistic;
    std::vector<MechanisticParameters> joints;  // by joint under Law::mechanistic, otherwise empty
    std::vector<PublishedLaw> published;        // by joint under Law::published, otherwise empty
    InteractionMatrix interaction;              // empty under Law::published and without a flange
};

// The state of a joint. Clamp force, breakaway, stage and condition are those of the law's own state
// (`mechanistic` or `published`), copied after each step.
struct JointState {
    NutMotion nut;             // angle: relative to the bolt; speed: relative to the assembly
    double common_turn = 0.0;  // rad by which nut and bolt have turned together, tightening positive
    double torque = 0.0;       // N·m applied by wrench or fingers, tightening positive
    double clamp = 0.0;        // N
    // 0…1, share of the breakaway friction that is active: 1 at rest, 0 while the nut slides.
    double breakaway = 0.0;
    Stage stage = Stage::navigation;
    JointCondition condition = JointCondition::intact;
    MechanisticState mechanistic;
    PublishedState published;

    // rad by which the turned part has turned about the bolt's axis in the assembly's frame.
    [[nodiscard]] double rotation() const { return nut.angle + common_turn; }
};

// Parameters under the mechanistic law: derives the joints (seeded scatter, one random stream per joint) and
// their interaction through the flange. `flange` may be null: no interaction.
GroupParameters make_group(std::span<const JointDesign> designs, const FlangePlate* flange,
                           std::uint64_t seed);
// Parameters under the published law, one element for each joint.
GroupParameters make_published_group(const std::vector<PublishedParameters>& joints);

// The states of new joints with their nuts at angle 0. `joints`: number of joints in the group.
std::vector<JointState> initial_state(const GroupParameters& group, std::size_t joints);

// The resistance of a nut on its thread under the group's law. `joint`: index in the group.
Resistance resistance(const GroupParameters& group, std::size_t joint, const JointState& state);

// One step of dt: moves the nut `driven` (−1: none) with the drive, then updates every joint's clamp force.
// The group's forces minimise a strictly convex energy. Each step performs one sweep of exact minimisation,
// joint by joint, from the last solution, so the sweeps never diverge, and the next steps reduce the
// remaining error.
//
// With CounterHold::second_wrench, nut and bolt turn together (resistance_together) if the face under the
// held part and NutDrive::held_part_torque together resist less than the thread. Then the clamp force does
// not change.
//
// Returns what the click mechanism of the drive did in this step.
ClickStep step_group(const GroupParameters& group, std::span<JointState> joints, int driven,
                     const NutDrive& drive, double dt);

// Turns one nut to an angle (rad) kinematically, as a machine does. `friction_share`: +1 while the nut slides
// tightening, −1 loosening (MechanisticState).
void turn_nut(const GroupParameters& group, std::span<JointState> joints, std::size_t joint, double angle,
              double friction_share, double dt);

struct CurveSample {
    double angle = 0.0;  // rad from the start of the run
    Stage stage = Stage::navigation;
    // N·m. Mechanistic law: negative while loosening. Published law: with the signs of the paper's
    // equations (published.hpp).
    double torque = 0.0;
    double clamp = 0.0;  // N
};

struct CurveOptions {
    Direction direction = Direction::tighten;
    double speed = to_radians(30.0);  // rad/s
    double dt = 0.001;                // s, one sample per step
    // Tightening ends `past_yield` after the yield stage has begun, or when the joint breaks or strips.
    // Loosening starts from a joint that was tightened to `torque` (N·m) and rested for 10 s. It ends when
    // the nut has been free for a quarter turn or has reached angle 0.
    double past_yield = to_radians(90.0);
    double torque = 0.0;
};

// The torque-angle curve of a single joint that a test bench turns at constant speed. `group` must have one
// joint. At most 2,000,000 samples.
std::vector<CurveSample> torque_angle_curve(const GroupParameters& group, const CurveOptions& options);

}  // namespace bolt::joint
