#include "haptics/joint/torque.hpp"

#include <cmath>

namespace bolt::joint {

TorqueLevers torque_levers(const Thread& thread, double mu_thread, double mu_bearing, double bearing_mean_diameter) {
    TorqueLevers levers;
    levers.lead = thread.pitch / (2.0 * pi);
    levers.thread = mu_thread * 0.5 * thread.d2 / std::cos(thread_half_angle);
    levers.bearing = mu_bearing * 0.5 * bearing_mean_diameter;
    return levers;
}

double vdi_tightening_torque(double force, const Thread& thread, double mu_thread, double mu_bearing,
                             double bearing_mean_diameter) {
    return force *
           (0.16 * thread.pitch + 0.58 * thread.d2 * mu_thread + 0.5 * bearing_mean_diameter * mu_bearing);
}

double equivalent_stress_ratio(const Thread& thread, double mu_thread, double kappa, double share) {
    const double slope = thread.pitch / (pi * thread.d2) + share * 1.155 * mu_thread;
    return std::sqrt(1.0 + 3.0 * square(kappa * (thread.d2 / thread.d0()) * slope));
}

AssemblyPreload assembly_preload(const Thread& thread, const PropertyClass& bolt, double mu_thread, double mu_bearing,
                                 double bearing_mean_diameter, double utilisation) {
    AssemblyPreload preload;
    const double stress = utilisation * bolt.R_p02 / equivalent_stress_ratio(thread, mu_thread, bolt.kappa);
    preload.force = stress * thread.A_s;
    preload.torque = vdi_tightening_torque(preload.force, thread, mu_thread, mu_bearing, bearing_mean_diameter);
    return preload;
}

}  // namespace bolt::joint
