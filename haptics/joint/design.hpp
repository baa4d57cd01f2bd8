// A joint as its author states it, in SI: what content files become and what the laws are derived from.
#pragma once

#include <string>
#include <vector>

#include "engine/base/math.hpp"
#include "haptics/joint/fastener.hpp"

namespace bolt::joint {

// Friction presets for repeated use; the coefficients themselves are given apart.
enum class Lubrication { as_received, dry, oiled, mos2 };

struct FrictionDesign {
    double thread = 0.12;        // μ_G, running
    double bearing = 0.12;       // μ_K, running, under the turned nut
    double static_ratio = 1.15;  // breakaway / running
    double scatter = 0.0;        // standard deviation of both from bolt to bolt, relative
    Lubrication lubrication = Lubrication::as_received;
};

struct Member {
    double thickness = 0.0;  // m, along the bolt
    double E = 0.0;          // Pa
};

struct JointDesign {
    std::string id;
    ThreadSize thread;
    PropertyClass bolt_class;
    double nut_strength = 0.0;      // Pa, proof stress of the nut (ISO 898-2); 0: matched to the bolt
    double bolt_length = 0.0;       // m, under the head
    double bolt_thread_length = 0;  // m; 0: ISO 4014
    bool washer_under_head = false;
    bool washer_under_nut = false;
    std::vector<Member> members;   // what is clamped, without washers
    double member_diameter = 0.0;  // m, D_A of VDI 2230 (outer diameter of the clamped part); 0: unlimited
    FrictionDesign friction;
    double roughness_Rz = 16e-6;   // m, of the faces: chooses the embedding class
    double misfit = 5e-6;          // m, scale over which the seat closes (non-parallel faces, thread draw-in)
    double embedding_time = 5.0;   // s, time constant of embedding
    double prevailing_torque = 0;  // N·m, of a locking nut
    double running_torque = 0.02;  // N·m, mean drag of the free thread; it fluctuates with the angle
    double start_gap = 0.0;        // m, nut face to seat when the nut is hand-started (angle 0)
    double nut_mass = 0.0;         // kg; 0: from the nut's volume
    Vec3 seat{0.0};                // m, centre of the nut's seat in the assembly's frame
    Vec3 axis{0.0, 1.0, 0.0};      // unit, from the members towards the nut

    [[nodiscard]] double grip_length() const {  // l_K: members and washers
        double l = 0.0;
        for (const Member& m : members) l += m.thickness;
        const double washer = thread.size.washer_thickness;
        return l + (washer_under_head ? washer : 0.0) + (washer_under_nut ? washer : 0.0);
    }
};

}  // namespace bolt::joint
