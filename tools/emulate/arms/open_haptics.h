// Controls of the emulated libHD.so.3.4, which has the functions of OpenHaptics HD that its manual names. One
// arm with a stylus, which a hand holds: mass, spring and damper to an intended position, and the friction of
// the arm. SI units, the vendor's frame (x to the right, y up, z to the user), which is ours.
#pragma once

extern "C" {

struct EmulatedHdHand {
    double mass;       // kg, of hand and arm
    double stiffness;  // N/m, of the spring to the intended position
    double damping;    // N·s/m
    double friction;   // N, along each axis
};

// The description that the arm reports, in the vendor's units.
struct EmulatedHdReport {
    const char* model;
    int senses, renders;                     // degrees of freedom
    double box[6];                           // mm, lower corner, upper corner
    double stiffness, force, lasting_force;  // N/mm, N, N
};

// Resets to a calibrated Touch that is switched on and connected and rests at the origin, at time 0. From
// then on only emu_hd_advance() advances its time. Before the first call, and again after emu_hd_own_clock(),
// the scheduler runs in a thread, in real time. If EMULATED_ARM_NEEDS_INKWELL is set, the arm needs its
// inkwell until emu_hd_inkwell() or emu_hd_reset().
void emu_hd_reset(void);
void emu_hd_own_clock(void);
void emu_hd_advance(double seconds);
void emu_hd_hand(struct EmulatedHdHand hand);
void emu_hd_intend(double x, double y, double z);  // where the hand wants to be
// Yaw, pitch and roll of the gimbal (rad), on a forearm with this orientation.
void emu_hd_turn(const double gimbal[3], const double forearm[3][3]);
void emu_hd_report(struct EmulatedHdReport report);
void emu_hd_buttons(int mask);
// 0x5000: calibrated, 0x5001: needs an update, 0x5002: needs the inkwell.
void emu_hd_calibration(unsigned status);
void emu_hd_inkwell(void);                // the stylus is pushed into the inkwell
void emu_hd_only_name(const char* name);  // hdInitDevice refuses other names; null: it accepts any
void emu_hd_unplug(int on);
void emu_hd_in_use(int on);  // another program has opened the arm
void emu_hd_licensed(int on);
void emu_hd_heat(double heat);      // of the motors; from 1 on, each frame with a force warns of warm motors
void emu_hd_speed_limit(double v);  // m/s above which a frame is an error; 2 by default
void emu_hd_corrupt(int on);        // the transform is not a number
void emu_hd_raise(unsigned error);  // the error appears at the end of the next frame
void emu_hd_late(double seconds);   // delays the next tick
void emu_hd_switch_off(void);       // the library switches the forces off by itself

// Values that an observer sees.
void emu_hd_force(double force[6]);  // N and N·m that act on the hand now
int emu_hd_open(void);
int emu_hd_running(void);          // whether the scheduler runs
int emu_hd_initialisations(void);  // calls of hdInitDevice
int emu_hd_refused(void);          // calls that the library refused because they were wrong
}
