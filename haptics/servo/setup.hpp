// Everything a tick reads and never changes. Made once, when an assembly is loaded; all allocation happens
// here.
#pragma once

#include <span>
#include <vector>

#include "engine/base/pose.hpp"
#include "haptics/contact/jaw.hpp"
#include "haptics/force/guiding.hpp"
#include "haptics/force/output_limits.hpp"
#include "haptics/force/torque_rendering.hpp"
#include "haptics/joint/design.hpp"
#include "haptics/joint/group.hpp"

namespace bolt::servo {

// A nut in the assembly's frame: right-handed thread, `axis` from the members towards the nut, e1 × e2 =
// axis.
struct NutPlace {
    Vec3 seat{0.0};
    Vec3 axis{0.0, 1.0, 0.0};
    Vec3 e1{1.0, 0.0, 0.0};
    Vec3 e2{0.0, 0.0, -1.0};
    double height = 0.0;           // m
    double across_flats = 0.0;     // s, m
    double bearing = 0.0;          // m, diameter of its faces within the chamfers
    double corner_pressure = 0.0;  // Pa, at which its corners give way (joint/corner.hpp)
    double start_gap = 0.0;        // m, face to seat at angle 0
    double lead = 0.0;             // m/rad
};

// A nut's own frame to the assembly: origin on its bearing face, +Z along the bolt away from the members, a
// corner of the hexagon along +X.
Pose nut_pose(const NutPlace& nut, double nut_angle);

struct Wrench {
    contact::Jaw jaw;
    double head_angle = 0.0;     // rad, between jaw and handle; flipping the wrench changes its side
    double handle_length = 0.0;  // m
    double half_play = 0.0;      // rad, jaw on hexagon, to either side
    double stiffness = 0.0;      // N·m/rad, wrench and hand coupling
    joint::Click click;          // without a setting: that is an input's
    double deviation = 0.0;      // relative, of what it trips at from what it is set to
};

struct Setup {
    double dt = 0.001;
    joint::GroupParameters group;
    std::vector<NutPlace> nuts;
    Wrench wrench;
    double finger_stiffness = 5.0;   // N·m/rad
    double finger_force = 65.0;      // N across the flats at which fingertips slip on the nut
    double hold_stiffness = 1000.0;  // N/m, engaged tool against the nut's centre
    double hold_torsion = 5.0;       // N·m/rad, against tilting
    force::TorqueRendering torque;
    force::Guiding guiding;
    force::OutputLimits limits;

    // N·m that fingertips can put on a nut.
    [[nodiscard]] double finger_torque(const NutPlace& nut) const {
        return 0.5 * finger_force * nut.across_flats;
    }
};

struct Description {
    std::span<const joint::JointDesign> joints;
    joint::Law law = joint::Law::mechanistic;
    joint::PublishedParameters published;
    const joint::FlangePlate* flange = nullptr;
    double jaw = 0.0;              // m
    double head_thickness = 0.0;   // m; 0, here and below: as our models have it (contact/jaw.hpp)
    double jaw_throat = 0.0;       // m, from the middle of the jaw to its bottom
    double jaw_tip = 0.0;          // m, and to its tips
    double head_angle = 0.0;       // rad
    double handle_length = 0.0;    // m
    double greatest_torque = 0.0;  // N·m that the lesson asks for: what the device's range is scaled to
    force::OutputLimits limits;
    double click_swing = 0.0;     // rad, of a click-type torque wrench; 0: the wrench is none
    double click_accuracy = 0.0;  // relative: this wrench deviates by no more, the seed says by how much
    std::uint64_t seed = 0;
    double dt = 0.001;
};

Setup make_setup(const Description& description);

}  // namespace bolt::servo
