// An emulated libdrd.so.3 (see force_dimension.h). It refuses what the vendor's library refuses: an arm that
// is not open, forces before the arm knows its position. Forces have no effect before dhdEnableForce.
// Signatures, order of calls and errors: dhdc.h and drdc.h of the Force Dimension SDK 3.17.
#include "tools/emulate/arms/force_dimension.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <fstream>
#include <limits>
#include <span>
#include <thread>
#include <utility>

namespace {

using Vector = std::array<double, 3>;

constexpr int no_error = 0, error_no_device = 5, error_not_ready = 12, error_in_use = 20;
constexpr int time_guard = 1, motor_saturated = 2, cause_speed = 2, cause_software = 4;
constexpr double encoder_step = 10e-6;  // m
constexpr double dt = 25e-6;            // s
constexpr char arm_id = 0;
constexpr double open_gripper = 0.5236;  // rad, 30°
constexpr std::array types_with_gripper{35, 37, 104, 105, 108, 109};
constexpr std::array left_handed_types{36, 37, 105, 109};

struct EmulatedArm {
    EmulatedArmHand hand{0.5, 300.0, 12.0};
    Vector intention{}, position{}, velocity{}, force{}, torque{};
    std::array<Vector, 3> rotation{Vector{1, 0, 0}, Vector{0, 1, 0}, Vector{0, 0, 1}};  // rows
    double time = 0.0, max_force = 1e9, max_torque = 1e9, speed_limit = 2.0;
    bool open = false, initialized = false, enabled = false, braked = true, unplugged = false, in_use = false,
         active_wrist = false, stale = false, corrupt = false, millimetres = false;
    Vector measured{};
    int cause = 0, searches = 0;
    unsigned buttons = 0;
    double gripper = 1.0;                                  // 0 closed … 1 fully open
    int type = 0, serial = 1234, speed_limit_changes = 0;  // type 0: by active_wrist
    const char* name = "omega.6";
    double weight = 0.0, mounted = 0.0, known_mounted = 0.0;  // kg
    bool compensates = false;
    double compensation = 0.0;                               // N along z
    double delay = 0.0;                                      // s from a call until its force acts
    std::deque<std::pair<double, Vector>> delayed_forces{};  // time from which it acts, and the force
};

unsigned held_buttons() {
    const char* mask = std::getenv("EMULATED_ARM_BUTTONS");
    return mask != nullptr ? static_cast<unsigned>(std::atoi(mask)) : 0U;
}

double given_delay() {
    const char* seconds = std::getenv("EMULATED_ARM_DELAY");
    return seconds != nullptr ? std::atof(seconds) : 0.0;
}

EmulatedArm arm{.initialized = std::getenv("EMULATED_ARM_INITIALIZED") != nullptr,
                .buttons = held_buttons(),
                .delay = given_delay()};
bool has_own_clock = true;
thread_local int last_error = no_error;

int refuse(int error) {
    last_error = error;
    return -1;
}

int type_of_arm() {
    constexpr int omega6 = 34, sigma7 = 104;
    return arm.type != 0 ? arm.type : arm.active_wrist ? sigma7 : omega6;
}

bool is_among(std::span<const int> types) {
    return std::find(types.begin(), types.end(), type_of_arm()) != types.end();
}

void follow_clock();

// Switches the arm off while the file of EMULATED_ARM_SWITCH is absent; the arm then loses its position.
void follow_switch() {
    const char* file = std::getenv("EMULATED_ARM_SWITCH");
    if (!has_own_clock || file == nullptr) return;
    arm.unplugged = access(file, F_OK) != 0;
    if (arm.unplugged) arm.open = arm.enabled = arm.initialized = false;
}

// Places the hand where the file of EMULATED_ARM_HAND says: x y z (m, the arm's axes) and the mask of its
// buttons. The arm follows at once. A file that is absent or incomplete changes nothing.
void follow_hand() {
    const char* name = std::getenv("EMULATED_ARM_HAND");
    if (!has_own_clock || name == nullptr) return;
    std::ifstream file(name);
    Vector position{};
    unsigned buttons = 0;
    if (!(file >> position[0] >> position[1] >> position[2] >> buttons)) return;
    arm.intention = arm.position = position;
    arm.velocity = {};
    arm.buttons = buttons;
}

// Returns true if the arm is open and connected; otherwise sets the error of the call.
bool check_handle(char id) {
    follow_clock();
    follow_switch();
    if (arm.open && !arm.unplugged && id == arm_id) return true;
    refuse(error_no_device);
    return false;
}

// Applies the forces whose delay has passed.
void apply_delayed_forces() {
    for (; !arm.delayed_forces.empty() && arm.delayed_forces.front().first <= arm.time;
         arm.delayed_forces.pop_front())
        arm.force = arm.delayed_forces.front().second;
}

bool renders() { return arm.open && arm.enabled && !arm.braked && !arm.unplugged; }

double length(const Vector& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

// Shortens `v` to `most`. Returns whether it was longer.
bool shorten(Vector& v, double most) {
    const double long_ = length(v);
    if (long_ <= most) return false;
    for (double& c : v) c *= most / long_;
    return true;
}

void brake(int cause) {
    arm.braked = true;
    arm.enabled = false;
    arm.cause = cause;
}

// N along z: the weight of this mass at the present position.
double weight_of(double mass) { return 9.81 * mass * (1.0 + arm.position[2] / 0.1); }

void step() {
    apply_delayed_forces();
    const double braking = arm.braked && !arm.unplugged ? 60.0 : 0.0;  // N·s/m, of short-circuited motors
    for (std::size_t i = 0; i < 3; ++i) {
        const double spring = arm.hand.stiffness * (arm.intention[i] - arm.position[i]);
        const double lift =
            i != 2 ? 0.0 : (renders() ? arm.compensation : 0.0) - weight_of(arm.weight + arm.mounted);
        const double acting = lift + (renders() ? arm.force[i] : 0.0);
        const double damping = arm.hand.damping + braking;
        // Implicit in the damping.
        arm.velocity[i] =
            (arm.velocity[i] + dt / arm.hand.mass * (spring + acting)) / (1.0 + dt / arm.hand.mass * damping);
        arm.position[i] += dt * arm.velocity[i];
    }
    if (renders() && length(arm.velocity) > arm.speed_limit) brake(cause_speed);
}

void advance(double seconds) {
    const double until = arm.time + seconds;
    for (; arm.time + 0.5 * dt < until; arm.time += dt) step();
}

void follow_clock() {
    using Clock = std::chrono::steady_clock;
    static Clock::time_point before = Clock::now();
    if (!has_own_clock) return;
    const Clock::time_point now = Clock::now();
    const double elapsed = std::chrono::duration<double>(now - before).count();
    if (elapsed < dt) return;
    before = now;
    advance(std::min(elapsed, 0.1));
    follow_hand();
}

}  // namespace

extern "C" {

void emu_reset(void) {
    arm = {};
    has_own_clock = false;
}
void emu_advance(double seconds) { advance(seconds); }
void emu_hand(EmulatedArmHand hand) { arm.hand = hand; }
void emu_intend(double x, double y, double z) { arm.intention = {x, y, z}; }
void emu_turn(const double rotation[3][3]) {
    for (std::size_t i = 0; i < 3; ++i) std::copy(rotation[i], rotation[i] + 3, arm.rotation[i].begin());
}
void emu_initialized(int on) { arm.initialized = on != 0; }
void emu_active_wrist(int on) {
    arm.active_wrist = on != 0;
    arm.name = arm.active_wrist ? "sigma.7" : "omega.6";
}
void emu_model(int type, const char* name, int serial) {
    arm.type = type;
    arm.name = name;
    arm.serial = serial;
}
void emu_weight(double of_arm, double mounted) {
    arm.weight = of_arm;
    arm.mounted = mounted;
}
void emu_buttons(unsigned mask) { arm.buttons = mask; }
void emu_gripper(double opening) { arm.gripper = opening; }
void emu_unplug(int on) {
    arm.unplugged = on != 0;
    if (on != 0) arm.open = arm.enabled = false;
}
void emu_in_use(int on) { arm.in_use = on != 0; }
void emu_speed_limit(double v) { arm.speed_limit = v; }
void emu_stale(int on) { arm.stale = on != 0; }
void emu_corrupt(int on) { arm.corrupt = on != 0; }
void emu_millimetres(int on) { arm.millimetres = on != 0; }
void emu_position(double xyz[3]) { std::copy(arm.position.begin(), arm.position.end(), xyz); }
void emu_force(double force[6]) {
    const EmulatedArm none{};
    const EmulatedArm& acting = renders() ? arm : none;
    std::copy(acting.force.begin(), acting.force.end(), force);
    std::copy(acting.torque.begin(), acting.torque.end(), force + 3);
}
int emu_moved_by_itself(void) { return arm.searches; }
int emu_braked(void) { return arm.braked ? 1 : 0; }
int emu_open(void) { return arm.open ? 1 : 0; }
int emu_speed_limit_changes(void) { return arm.speed_limit_changes; }

int dhdGetDeviceCount(void) {
    follow_switch();
    return arm.unplugged ? 0 : 1;
}
int drdOpenID(char index) {
    follow_switch();
    if (index != 0 || arm.unplugged) return refuse(error_no_device);
    if (arm.in_use || arm.open) return refuse(error_in_use);
    arm.open = true;
    arm.compensates = false;
    arm.known_mounted = 0.0;
    arm.braked = true;
    arm.enabled = false;
    arm.force = arm.torque = {};
    return arm_id;
}
int drdClose(char id) {
    if (!check_handle(id)) return -1;
    arm.open = arm.enabled = false;
    return 0;
}
bool drdIsInitialized(char id) { return check_handle(id) && arm.initialized; }
int drdAutoInit(char id) {
    if (!check_handle(id)) return -1;
    ++arm.searches;
    if (const char* seconds = std::getenv("EMULATED_ARM_HOMING"); has_own_clock && seconds != nullptr)
        std::this_thread::sleep_for(std::chrono::duration<double>(std::atof(seconds)));
    arm.position = arm.velocity = {};
    arm.initialized = true;
    return 0;
}
int drdStop(bool, char id) {
    if (!check_handle(id)) return -1;
    return arm.initialized ? 0 : refuse(error_not_ready);
}
int dhdGetSystemType(char id) { return check_handle(id) ? type_of_arm() : -1; }
const char* dhdGetSystemName(char id) { return check_handle(id) ? arm.name : nullptr; }
int dhdGetSerialNumber(unsigned short* serial, char id) {
    if (!check_handle(id) || arm.serial < 0) return -1;
    *serial = static_cast<unsigned short>(arm.serial);
    return 0;
}
int dhdSetGravityCompensation(int on, char id) {
    if (!check_handle(id)) return -1;
    arm.compensates = on != 0;
    return 0;
}
int dhdSetEffectorMass(double kilogram, char id) {
    if (!check_handle(id)) return -1;
    arm.known_mounted = kilogram;
    return 0;
}
int dhdSetVelocityThreshold(unsigned, char id) {
    if (!check_handle(id)) return -1;
    ++arm.speed_limit_changes;
    return 0;
}
bool dhdHasWrist(char id) { return check_handle(id); }
bool dhdHasActiveWrist(char id) { return check_handle(id) && arm.active_wrist; }
int dhdSetMaxForce(double newton, char id) {
    if (!check_handle(id)) return -1;
    arm.max_force = newton;
    return 0;
}
int dhdSetMaxTorque(double newton_metre, char id) {
    if (!check_handle(id)) return -1;
    arm.max_torque = newton_metre;
    return 0;
}
int dhdEnableForce(unsigned char on, char id) {
    if (!check_handle(id)) return -1;
    arm.enabled = on != 0;
    arm.braked = on == 0;
    arm.cause = 0;
    arm.force = arm.torque = {};
    return 0;
}
int dhdStop(char id) {
    if (!check_handle(id)) return -1;
    brake(cause_software);
    return 0;
}
int dhdGetStatus(int* status, char id) {
    if (!check_handle(id)) return -1;
    std::fill(status, status + 17, 0);
    status[0] = status[1] = 1;  // powered, connected
    status[3] = arm.initialized ? 1 : 0;
    status[4] = arm.braked ? 1 : 0;
    status[5] = arm.enabled ? 1 : 0;
    status[14] = arm.cause;
    return 0;
}
int dhdGetPositionAndOrientationFrame(double* x, double* y, double* z, double rotation[3][3], char id) {
    if (!check_handle(id)) return -1;
    double* const out[] = {x, y, z};
    for (std::size_t i = 0; i < 3; ++i) {
        if (!arm.stale) arm.measured[i] = encoder_step * std::round(arm.position[i] / encoder_step);
        *out[i] = arm.corrupt ? std::numeric_limits<double>::quiet_NaN()
                              : (arm.millimetres ? 1e3 : 1.0) * arm.measured[i];
        std::copy(arm.rotation[i].begin(), arm.rotation[i].end(), rotation[i]);
    }
    return arm.stale ? time_guard : 0;
}
bool dhdHasGripper(char id) { return check_handle(id) && is_among(types_with_gripper); }
bool dhdIsLeftHanded(char id) { return check_handle(id) && is_among(left_handed_types); }
int dhdGetGripperAngleRad(double* radian, char id) {
    if (!dhdHasGripper(id)) return -1;
    *radian = (is_among(left_handed_types) ? -1.0 : 1.0) * open_gripper * arm.gripper;
    return 0;
}
unsigned dhdGetButtonMask(char id) { return check_handle(id) ? arm.buttons : 0U; }
int dhdSetForceAndTorqueAndGripperForce(double fx, double fy, double fz, double tx, double ty, double tz,
                                        double, char id) {
    if (!check_handle(id)) return -1;
    if (!arm.initialized) return refuse(error_not_ready);
    Vector force{fx, fy, fz}, torque{tx, ty, tz};
    const bool force_saturated = shorten(force, arm.max_force);
    const bool torque_saturated = shorten(torque, arm.active_wrist ? arm.max_torque : 0.0);
    if (arm.delay > 0.0)
        arm.delayed_forces.emplace_back(arm.time + arm.delay, force);
    else
        arm.force = force;
    arm.torque = torque;
    arm.compensation = arm.compensates ? weight_of(arm.weight + arm.known_mounted) : 0.0;
    return force_saturated || torque_saturated ? motor_saturated : 0;
}
int dhdErrorGetLast(void) { return last_error; }
const char* dhdErrorGetLastStr(void) {
    switch (last_error) {
        case error_no_device:
            return "no device found";
        case error_not_ready:
            return "device not ready";
        case error_in_use:
            return "device already in use";
        default:
            return "no error";
    }
}
}
