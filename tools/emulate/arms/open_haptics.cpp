// An emulated libHD.so.3.4 (see open_haptics.h). It refuses forces outside a frame, before they are enabled
// and while the scheduler stands, a second frame in a tick, and a calibration while forces are enabled. The
// order of calls in the vendor's guide excludes these; its library may be less strict. Errors lie on a stack
// that all threads share, the newest on top. After an error the last force keeps acting: the caller must end
// it. Signatures and values: hd.h and hdDefines.h of OpenHaptics 3.4.
#include "tools/emulate/arms/open_haptics.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace {

using Vector = std::array<double, 3>;
using Matrix = std::array<Vector, 3>;  // rows

constexpr unsigned invalid_enum = 0x100, invalid_operation = 0x102, bad_handle = 0x104, warm_motors = 0x200,
                   too_much_force = 0x201, too_fast = 0x203, already_initiated = 0x301,
                   no_communication = 0x302, bad_configuration = 0x303, illegal_begin = 0x400,
                   illegal_end = 0x401, outside_frame = 0x402, no_licence = 0x600;
constexpr unsigned buttons = 0x2000, inkwell = 0x2002, position = 0x2050, velocity = 0x2051,
                   transform = 0x2052, angular_velocity = 0x2053, gimbal_angles = 0x2150, model = 0x2501,
                   serial = 0x2504, usable_box = 0x2551, senses = 0x2553, renders = 0x2554,
                   calibration_style = 0x2555, max_stiffness = 0x2602, max_force = 0x2603,
                   lasting_force = 0x2604, motor_heat = 0x2605, force = 0x2700, gimbal_torque = 0x2704,
                   force_output = 0x4000;
constexpr unsigned calibrated = 0x5000, needs_update = 0x5001, needs_inkwell = 0x5002;
constexpr unsigned no_arm = 0xffffffff, the_arm = 0;
constexpr std::size_t most_errors = 32;
constexpr double encoder_step = 55e-6;                     // m
constexpr double dt = 25e-6, tick = 1e-3;                  // s
constexpr Vector most_gimbal_torque{0.188, 0.188, 0.048};  // N·m

struct Error {
    unsigned code;
    int internal_code;
    unsigned device;
};

struct Callback {
    unsigned long handle;
    unsigned (*function)(void*);
    void* argument;
};

struct Arm {
    EmulatedHdHand hand{0.5, 300.0, 12.0, 0.2};
    EmulatedHdReport report{"Touch", 6, 3, {-80, -50, -50, 80, 70, 70}, 0.5, 3.3, 0.88};
    std::string model{"Touch"}, only_name{};
    Vector intention{}, position{}, velocity{}, force{}, gimbal_torque{}, gimbal{};
    Vector next_force{}, next_torque{};  // set in this frame
    Matrix forearm{Vector{1, 0, 0}, Vector{0, 1, 0}, Vector{0, 0, 1}};
    double time = 0.0, target_time = 0.0, next_tick = tick, heat = 0.0, speed_limit = 2.0;
    unsigned calibration = calibrated, raised = 0;
    int buttons = 0, initialisations = 0, refused = 0;
    bool open = false, running = false, enabled = false, in_frame = false, frame_done = false,
         in_inkwell = false, unplugged = false, in_use = false, licensed = true, corrupt = false;
    std::vector<Error> errors{};
    std::vector<Callback> callbacks{};
    unsigned long next_handle = 1;
};

Arm arm{.calibration = std::getenv("EMULATED_ARM_NEEDS_INKWELL") != nullptr ? needs_inkwell : calibrated};
std::recursive_mutex mutex;  // callbacks call the library
std::atomic<bool> has_own_clock = true;

void push(unsigned code) {
    if (arm.errors.size() == most_errors) arm.errors.erase(arm.errors.begin());
    arm.errors.push_back({code, 0, the_arm});
}

// An error of the caller.
void refuse(unsigned code) {
    push(code);
    ++arm.refused;
}

double length(const Vector& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }
bool is_zero(const Vector& v) { return v == Vector{}; }

Matrix product(const Matrix& a, const Matrix& b) {
    Matrix out{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 3; ++k) out[i][j] += a[i][k] * b[k][j];
    return out;
}

Matrix transposed(const Matrix& a) {
    Matrix out{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) out[i][j] = a[j][i];
    return out;
}

Matrix turn_about(std::size_t axis, double angle) {
    const std::size_t next = (axis + 1) % 3, last = (axis + 2) % 3;
    Matrix out{};
    out[axis][axis] = 1.0;
    out[next][next] = out[last][last] = std::cos(angle);
    out[next][last] = -std::sin(angle);
    out[last][next] = std::sin(angle);
    return out;
}

// From a neutral gimbal: the tip to the right, the tip down and clockwise are positive.
Matrix orientation(const Vector& gimbal) {
    return product(arm.forearm, product(turn_about(1, -gimbal[0]),
                                        product(turn_about(0, -gimbal[1]), turn_about(2, -gimbal[2]))));
}

// The direction about which motor `i` turns the stylus, from the difference of two orientations.
Vector motor_axis(std::size_t i) {
    constexpr double h = 1e-5;
    Vector more = arm.gimbal, less = arm.gimbal;
    more[i] += h;
    less[i] -= h;
    const Matrix turned = product(orientation(more), transposed(orientation(less)));
    return {(turned[2][1] - turned[1][2]) / (4 * h), (turned[0][2] - turned[2][0]) / (4 * h),
            (turned[1][0] - turned[0][1]) / (4 * h)};
}

double determinant(const Matrix& m) {
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        sum += m[0][i] * (m[1][j] * m[2][k] - m[1][k] * m[2][j]);
    }
    return sum;
}

// The torque on the stylus whose component along each motor's axis is that motor's torque (Cramer's rule).
Vector torque_on_hand() {
    const Matrix axes{motor_axis(0), motor_axis(1), motor_axis(2)};
    Vector torque{};
    for (std::size_t i = 0; i < 3; ++i) {
        Matrix replaced = axes;
        for (std::size_t row = 0; row < 3; ++row) replaced[row][i] = arm.gimbal_torque[row];
        torque[i] = determinant(replaced) / determinant(axes);
    }
    return torque;
}

bool acts() { return arm.open && arm.running && arm.enabled && !arm.unplugged; }

void step() {
    for (std::size_t i = 0; i < 3; ++i) {
        const double spring = arm.hand.stiffness * (arm.intention[i] - arm.position[i]);
        const double acting = acts() ? arm.force[i] : 0.0;
        const double inverse_mass = dt / arm.hand.mass;
        // Implicit in the damping.
        const double free =
            (arm.velocity[i] + inverse_mass * (spring + acting)) / (1.0 + inverse_mass * arm.hand.damping);
        arm.velocity[i] =
            std::copysign(std::max(std::abs(free) - inverse_mass * arm.hand.friction, 0.0), free);
        arm.position[i] += dt * arm.velocity[i];
    }
    arm.time += dt;
}

void call_back() {
    arm.frame_done = false;
    const std::vector<Callback> now = arm.callbacks;
    for (const Callback& callback : now)
        if (callback.function(callback.argument) == 0)
            std::erase_if(arm.callbacks, [&](const Callback& c) { return c.handle == callback.handle; });
}

void advance(double seconds) {
    arm.target_time += seconds;
    while (arm.time + 0.5 * dt < arm.target_time) {
        step();
        if (arm.time + 0.5 * dt < arm.next_tick) continue;
        arm.next_tick = arm.time + tick;
        if (arm.running) call_back();
    }
}

void run_scheduler(const std::stop_token& stop) {
    using Clock = std::chrono::steady_clock;
    Clock::time_point before = Clock::now();
    while (!stop.stop_requested()) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        const Clock::time_point now = Clock::now();
        const std::lock_guard lock(mutex);
        advance(std::min(std::chrono::duration<double>(now - before).count(), 0.1));
        before = now;
    }
}

std::jthread scheduler;  // last, so that it ends before what it uses

bool reaches(unsigned device) {
    if (arm.open && device == the_arm) return true;
    refuse(bad_handle);
    return false;
}

bool is_initialised() {
    if (arm.open) return true;
    refuse(invalid_operation);
    return false;
}

// Returns true if a force may be set now; otherwise notes the error.
bool may_render() {
    if (!is_initialised()) return false;
    if (!arm.in_frame)
        refuse(outside_frame);
    else if (!arm.running || !arm.enabled)
        refuse(invalid_operation);
    return arm.in_frame && arm.running && arm.enabled;
}

void check_frame() {
    if (const unsigned code = std::exchange(arm.raised, 0); code != 0) push(code);
    const bool renders_now = acts() && (!is_zero(arm.force) || !is_zero(arm.gimbal_torque));
    if (renders_now && arm.heat >= 1.0) push(warm_motors);
    if (acts() && length(arm.velocity) > arm.speed_limit) push(too_fast);
}

// Limits the force to that of the motors. Returns whether it was greater.
bool saturate() {
    const double most = std::min(arm.report.force, 1e3);
    const double long_ = length(arm.next_force);
    const bool saturated = long_ > most * (1.0 + 1e-9);
    if (saturated)
        for (double& c : arm.next_force) c *= most / long_;
    bool any = saturated;
    for (std::size_t i = 0; i < 3; ++i) {
        any |= std::abs(arm.next_torque[i]) > most_gimbal_torque[i] * (1.0 + 1e-9);
        arm.next_torque[i] = std::clamp(arm.next_torque[i], -most_gimbal_torque[i], most_gimbal_torque[i]);
    }
    return any;
}

// mm; a position that is not calibrated is off.
Vector measured_position() {
    Vector out{};
    for (std::size_t i = 0; i < 3; ++i)
        out[i] = 1e3 * encoder_step * std::round(arm.position[i] / encoder_step) +
                 (arm.calibration == calibrated ? 0.0 : 20.0);
    return out;
}

void get_transform(double* out) {
    const Matrix turned = orientation(arm.gimbal);
    const Vector at = measured_position();
    for (std::size_t column = 0; column < 3; ++column) {
        for (std::size_t row = 0; row < 3; ++row) out[4 * column + row] = turned[row][column];
        out[4 * column + 3] = 0.0;
        out[12 + column] = at[column];
    }
    out[15] = 1.0;
    if (arm.corrupt) std::fill(out, out + 16, std::numeric_limits<double>::quiet_NaN());
}

}  // namespace

extern "C" {

void emu_hd_reset(void) {
    scheduler = {};
    const std::lock_guard lock(mutex);
    arm = Arm{};
    has_own_clock = false;
}
void emu_hd_own_clock(void) { has_own_clock = true; }
void emu_hd_advance(double seconds) { advance(seconds); }
void emu_hd_hand(EmulatedHdHand hand) { arm.hand = hand; }
void emu_hd_intend(double x, double y, double z) { arm.intention = {x, y, z}; }
void emu_hd_turn(const double gimbal[3], const double forearm[3][3]) {
    std::copy(gimbal, gimbal + 3, arm.gimbal.begin());
    for (std::size_t i = 0; i < 3; ++i) std::copy(forearm[i], forearm[i] + 3, arm.forearm[i].begin());
}
void emu_hd_report(EmulatedHdReport report) {
    arm.report = report;
    arm.model = report.model != nullptr ? report.model : "";
}
void emu_hd_buttons(int mask) { arm.buttons = mask; }
void emu_hd_calibration(unsigned status) { arm.calibration = status; }
void emu_hd_inkwell(void) {
    arm.in_inkwell = true;
    if (arm.calibration == needs_inkwell) arm.calibration = needs_update;
}
void emu_hd_only_name(const char* name) { arm.only_name = name != nullptr ? name : ""; }
void emu_hd_unplug(int on) {
    const std::lock_guard lock(mutex);
    arm.unplugged = on != 0;
}
void emu_hd_in_use(int on) { arm.in_use = on != 0; }
void emu_hd_licensed(int on) { arm.licensed = on != 0; }
void emu_hd_heat(double heat) { arm.heat = heat; }
void emu_hd_speed_limit(double v) { arm.speed_limit = v; }
void emu_hd_corrupt(int on) { arm.corrupt = on != 0; }
void emu_hd_raise(unsigned error) { arm.raised = error; }
void emu_hd_late(double seconds) { arm.next_tick += seconds; }
void emu_hd_switch_off(void) { arm.enabled = false; }
void emu_hd_force(double out[6]) {
    const std::lock_guard lock(mutex);
    const Vector on_hand = acts() ? arm.force : Vector{};
    const Vector torque = acts() && arm.report.renders == 6 ? torque_on_hand() : Vector{};
    std::copy(on_hand.begin(), on_hand.end(), out);
    std::copy(torque.begin(), torque.end(), out + 3);
}
int emu_hd_open(void) { return arm.open ? 1 : 0; }
int emu_hd_running(void) { return arm.running ? 1 : 0; }
int emu_hd_initialisations(void) { return arm.initialisations; }
int emu_hd_refused(void) { return arm.refused; }

unsigned hdInitDevice(const char* name) {
    const std::lock_guard lock(mutex);
    ++arm.initialisations;
    const bool known = arm.only_name.empty() || (name != nullptr && arm.only_name == name);
    const unsigned error = !arm.licensed            ? no_licence
                           : arm.unplugged          ? no_communication
                           : arm.in_use || arm.open ? already_initiated
                           : !known                 ? bad_configuration
                                                    : 0;
    if (error != 0) {
        push(error);
        return no_arm;
    }
    arm.open = true;
    arm.enabled = arm.in_frame = false;
    arm.force = arm.gimbal_torque = arm.next_force = arm.next_torque = {};
    return the_arm;
}
void hdDisableDevice(unsigned device) {
    const std::lock_guard lock(mutex);
    if (!reaches(device)) return;
    arm.open = arm.enabled = arm.in_frame = false;
}
void hdBeginFrame(unsigned device) {
    const std::lock_guard lock(mutex);
    if (!reaches(device)) return;
    if (arm.in_frame || (arm.running && arm.frame_done)) return refuse(illegal_begin);
    arm.in_frame = true;
    if (arm.unplugged) push(no_communication);
}
void hdEndFrame(unsigned device) {
    const std::lock_guard lock(mutex);
    if (!reaches(device)) return;
    if (!arm.in_frame) return refuse(illegal_end);
    arm.in_frame = false;
    arm.frame_done = true;
    if (saturate()) push(too_much_force);
    arm.force = arm.next_force;
    arm.gimbal_torque = arm.next_torque;
    check_frame();
}
void hdGetDoublev(unsigned what, double* out) {
    const std::lock_guard lock(mutex);
    if (!is_initialised() || arm.unplugged) return;
    switch (what) {
        case position: {
            const Vector at = measured_position();
            std::copy(at.begin(), at.end(), out);
            break;
        }
        case velocity:
            std::transform(arm.velocity.begin(), arm.velocity.end(), out, [](double v) { return 1e3 * v; });
            break;
        case angular_velocity:
            std::fill(out, out + 3, 0.0);
            break;
        case transform:
            get_transform(out);
            break;
        case gimbal_angles:
            std::copy(arm.gimbal.begin(), arm.gimbal.end(), out);
            break;
        case usable_box:
            std::copy(std::begin(arm.report.box), std::end(arm.report.box), out);
            break;
        case max_stiffness:
            *out = arm.report.stiffness;
            break;
        case max_force:
            *out = arm.report.force;
            break;
        case lasting_force:
            *out = arm.report.lasting_force;
            break;
        case motor_heat:
            std::fill(out, out + 6, arm.heat);  // one for each motor
            break;
        case force:
            std::copy(arm.next_force.begin(), arm.next_force.end(), out);
            break;
        default:
            refuse(invalid_enum);
    }
}
void hdGetIntegerv(unsigned what, int* out) {
    const std::lock_guard lock(mutex);
    if (!is_initialised() || arm.unplugged) return;
    switch (what) {
        case buttons:
            *out = arm.buttons;
            break;
        case senses:
            *out = arm.report.senses;
            break;
        case renders:
            *out = arm.report.renders;
            break;
        case calibration_style:
            *out = 4;
            break;
        default:
            refuse(invalid_enum);
    }
}
void hdGetBooleanv(unsigned what, unsigned char* out) {
    const std::lock_guard lock(mutex);
    if (!is_initialised() || arm.unplugged) return;
    if (what != inkwell) return refuse(invalid_enum);
    *out = arm.in_inkwell ? 0 : 1;  // the switch is closed while the stylus is out
}
const char* hdGetString(unsigned what) {
    const std::lock_guard lock(mutex);
    if (!is_initialised()) return nullptr;
    if (what == serial) return "2001-0042";
    if (what == model) return arm.report.model != nullptr ? arm.model.c_str() : nullptr;
    refuse(invalid_enum);
    return nullptr;
}
void hdSetDoublev(unsigned what, const double* in) {
    const std::lock_guard lock(mutex);
    if (what != force && what != gimbal_torque) return refuse(invalid_enum);
    if (!may_render()) return;
    if (what == gimbal_torque && arm.report.renders != 6) return refuse(invalid_operation);
    if (what == force)
        std::copy(in, in + 3, arm.next_force.begin());
    else
        std::transform(in, in + 3, arm.next_torque.begin(), [](double t) { return 1e-3 * t; });
}
void hdEnable(unsigned what) {
    const std::lock_guard lock(mutex);
    if (!is_initialised()) return;
    if (what != force_output) return refuse(invalid_enum);
    arm.enabled = true;
}
void hdDisable(unsigned what) {
    const std::lock_guard lock(mutex);
    if (!is_initialised()) return;
    if (what != force_output) return refuse(invalid_enum);
    arm.enabled = false;
}
Error hdGetError(void) {
    const std::lock_guard lock(mutex);
    if (arm.errors.empty()) return {0, 0, no_arm};
    const Error newest = arm.errors.back();
    arm.errors.pop_back();
    return newest;
}
const char* hdGetErrorString(unsigned code) {
    switch (code) {
        case already_initiated:
            return "device already initiated";
        case no_communication:
            return "communication error";
        case no_licence:
            return "invalid license";
        case warm_motors:
            return "warm motors";
        default:
            return "error";
    }
}
unsigned hdCheckCalibration(void) {
    const std::lock_guard lock(mutex);
    return is_initialised() ? arm.calibration : needs_inkwell;
}
void hdUpdateCalibration(unsigned) {
    const std::lock_guard lock(mutex);
    if (!is_initialised()) return;
    if (!arm.running || arm.enabled || arm.calibration == needs_inkwell) return refuse(invalid_operation);
    arm.calibration = calibrated;
}
void hdSetSchedulerRate(unsigned long) {}
void hdStartScheduler(void) {
    const std::lock_guard lock(mutex);
    if (!is_initialised()) return;
    arm.running = true;
    arm.next_tick = arm.time + tick;
    if (has_own_clock && !scheduler.joinable()) scheduler = std::jthread(run_scheduler);
}
void hdStopScheduler(void) {
    scheduler = {};  // joins
    const std::lock_guard lock(mutex);
    arm.running = false;
}
unsigned long hdScheduleAsynchronous(unsigned (*function)(void*), void* argument, unsigned short) {
    const std::lock_guard lock(mutex);
    if (!is_initialised()) return 0;
    arm.callbacks.push_back({arm.next_handle, function, argument});
    return arm.next_handle++;
}
void hdUnschedule(unsigned long handle) {
    const std::lock_guard lock(mutex);
    if (std::erase_if(arm.callbacks, [&](const Callback& c) { return c.handle == handle; }) == 0)
        refuse(invalid_operation);
}
}
