// Joint designs for tests.
#pragma once

#include "haptics/joint/design.hpp"
#include "haptics/joint/group.hpp"

namespace bolt::test {

// M16×75 class 8.8 through two 24 mm cast-iron flanges, oiled, no scatter.
inline joint::JointDesign m16_flange_joint(double mu = 0.12) {
    joint::JointDesign d;
    d.id = "B1";
    d.thread = joint::parse_thread("M16").value();
    d.bolt_class = joint::property_class("8.8", 0.016).value();
    d.bolt_length = 0.075;
    d.washer_under_head = d.washer_under_nut = true;
    d.members = {{0.024, 110e9}, {0.024, 110e9}};
    d.friction.thread = d.friction.bearing = mu;
    d.friction.lubrication = joint::Lubrication::oiled;
    d.start_gap = 2e-3;
    return d;
}

// A random joint within the range of the assembly format.
inline joint::JointDesign random_joint(Random& random) {
    joint::JointDesign d = m16_flange_joint(random.uniform(0.06, 0.35));
    const auto names = joint::thread_names();
    d.thread = joint::parse_thread(names[random.bits() % names.size()]).value();
    const auto classes = joint::property_class_names();
    const double size = d.thread.size.d;
    d.bolt_class = joint::property_class(classes[random.bits() % classes.size()], size).value();
    d.friction.bearing = random.uniform(0.06, 0.35);
    d.friction.static_ratio = random.uniform(1.0, 1.4);
    d.friction.lubrication = static_cast<joint::Lubrication>(random.bits() % 4);
    const double grip = size * random.uniform(0.8, 8.0);
    d.members = {{0.5 * grip, random.uniform(60e9, 210e9)}, {0.5 * grip, random.uniform(60e9, 210e9)}};
    d.bolt_length =
        grip + 2 * d.thread.size.washer_thickness + d.thread.size.nut_height + 3 * d.thread.thread.pitch;
    d.misfit = random.uniform(1e-6, 30e-6);
    d.roughness_Rz = random.uniform(4e-6, 100e-6);
    d.embedding_time = random.uniform(0.5, 20.0);
    d.prevailing_torque = random.chance(0.3) ? random.uniform(0.1, 10.0) : 0.0;
    d.start_gap = random.uniform(0.0, 2.0) * d.thread.thread.pitch;
    if (random.chance(0.1)) d.nut_strength = 0.5 * d.bolt_class.R_m;  // the nut strips
    return d;
}

inline joint::GroupParameters single(const joint::JointDesign& d) {
    return joint::make_group({&d, 1}, nullptr, 1);
}

}  // namespace bolt::test
