// Controls of the emulated libdrd.so.3, which has the functions of Force Dimension's library that we use. One
// arm with a wrist, which a hand holds: mass, spring and damper to an intended position. SI units, the
// vendor's frame (x to the user, y to the right, z up).
#pragma once

extern "C" {

struct EmulatedArmHand {
    double mass;       // kg, of hand and arm
    double stiffness;  // N/m, of the spring to the intended position
    double damping;    // N·s/m
};

// Resets to an arm that is switched on and connected, has not found its position and rests at the origin, at
// time 0. From then on only emu_advance() advances its time. Before the first call its clock is the
// computer's, and environment variables control it:
// - EMULATED_ARM_INITIALIZED: if set, the arm knows its position from the start
// - EMULATED_ARM_HOMING: s that it otherwise takes to find its position
// - EMULATED_ARM_SWITCH: a file; while it does not exist, the arm is switched off
// - EMULATED_ARM_BUTTONS: mask of the buttons
// - EMULATED_ARM_DELAY: s from a call until its force acts
// - EMULATED_ARM_HAND: a file "x y z buttons"; the hand holds the arm rigidly there. To move the hand, write a
//   new file and rename it.
void emu_reset(void);
void emu_advance(double seconds);
void emu_hand(struct EmulatedArmHand hand);
void emu_intend(double x, double y, double z);  // where the hand wants to be
void emu_turn(const double rotation[3][3]);     // orientation of the grip
void emu_initialized(int on);                   // whether the arm knows its position
void emu_active_wrist(int on);                  // whether it renders torque: a sigma.7; otherwise an omega.6
void emu_model(int type, const char* name, int serial);  // the name may be null
// Masses, kg, of the arm and of the tool mounted on it; 0 by default. Their weight at the handle grows with
// the height, as on an arm with rotating links. The library compensates the weight at the position of the
// last call that set the forces.
void emu_weight(double arm, double mounted);
void emu_buttons(unsigned mask);
void emu_gripper(double opening);  // 0 closed … 1 fully open; a model with a gripper: an omega.7 or a sigma.7
void emu_unplug(int on);
void emu_in_use(int on);         // another program has opened the arm
void emu_speed_limit(double v);  // m/s above which it brakes; 2 by default
void emu_stale(int on);          // the library returns the last position again, and reports that
void emu_corrupt(int on);        // positions are not numbers
void emu_millimetres(int on);    // positions are in mm

// Values that an observer sees.
void emu_position(double xyz[3]);  // m
void emu_force(double force[6]);   // N and N·m that act on the hand now
int emu_moved_by_itself(void);     // number of searches for its position
int emu_braked(void);
int emu_open(void);
int emu_speed_limit_changes(void);  // calls that changed the factory's over-speed threshold
}
