#include "haptics/joint/torque.hpp"

#include <cmath>

namespace bolt::joint {

TorqueLevers torque_levers(const Thread& thread, double mu_thread, double mu_bearing,
                           double bearing_mean_diameter) {
    TorqueLevers levers;
    levers.lead = thread.pitch / (2.0 * pi);
    levers.thread = mu_thread * 0.5 * thread.d2 / std::cos(thread_half_angle);
    levers.bearing = mu_bearing * 0.5 * bearing_mean_diameter;
    return levers;
}

double sliding_slope(const Thread& thread, double mu_thread, double share) {
    const double lead = thread.pitch / (pi * thread.d2);
    const double friction = share * mu_thread / std::cos(thread_half_angle);
    return (lead + friction) / (1.0 - lead * friction);
}

double equivalent_stress_ratio(const Thread& thread, double mu_thread, double kappa, double share) {
    const double shear = kappa * (thread.d2 / thread.d0()) * sliding_slope(thread, mu_thread, share);
    return std::sqrt(1.0 + 3.0 * square(shear));
}

AssemblyPreload assembly_preload(const Thread& thread, const PropertyClass& bolt, double mu_thread,
                                 double mu_bearing, double bearing_mean_diameter, double utilisation) {
    AssemblyPreload preload;
    const double stress = utilisation * bolt.R_p02 / equivalent_stress_ratio(thread, mu_thread, bolt.kappa);
    preload.force = stress * thread.A_s;
    const double thread_lever = 0.5 * thread.d2 * sliding_slope(thread, mu_thread);
    preload.torque = preload.force * (thread_lever + 0.5 * bearing_mean_diameter * mu_bearing);
    return preload;
}

}  // namespace bolt::joint
