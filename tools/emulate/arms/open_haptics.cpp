// An emulated libHD.so.3.4 (see open_haptics.h). It refuses forces outside a frame, before they are enabled
// and while the scheduler is stopped, a second frame in a tick, and a calibration while forces are enabled.
// The order of calls in the vendor's guide excludes these; its library may be less strict. Errors lie on a
// stack that all threads share, the newest on top. After an error the last force keeps acting: the caller
// must end it. Signatures and values: hd.h and hdDefines.h of OpenHaptics 3.4.
#include "tools/emulate/arms/open_haptics.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <limits>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tools/emulate/arms/open_haptics_arm.hpp"

namespace {

using bolt::emulate::HdMatrix;
using bolt::emulate::HdVector;
using bolt::emulate::length;

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
constexpr unsigned no_arm = 0xffffffff, the_arm = 0;
constexpr unsigned calibrated = 0x5000, needs_update = 0x5001, needs_inkwell = 0x5002;
constexpr std::size_t max_errors = 32;
constexpr double tick = 1e-3;  // s

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

// The state of the library between calls, and the faults that a test has caused.
struct Library {
    unsigned calibration = calibrated, raised = 0;
    std::string only_name{};
    HdVector next_force{}, next_torque{};  // set in this frame
    double target_time = 0.0, next_tick = tick, heat = 0.0, speed_limit = 2.0;
    int buttons = 0, initialisations = 0, refused = 0;
    bool open = false, running = false, enabled = false, in_frame = false, frame_done = false,
         in_inkwell = false, unplugged = false, in_use = false, licensed = true, corrupt = false;
    std::vector<Error> errors{};
    std::vector<Callback> callbacks{};
    unsigned long next_handle = 1;
};

bolt::emulate::HdArm arm;
Library library{.calibration =
                    std::getenv("EMULATED_ARM_NEEDS_INKWELL") != nullptr ? needs_inkwell : calibrated};
std::recursive_mutex mutex;  // callbacks call the library
std::atomic<bool> has_own_clock = true;

void push(unsigned code) {
    if (library.errors.size() == max_errors) library.errors.erase(library.errors.begin());
    library.errors.push_back({code, 0, the_arm});
}

// Reports an error of the caller.
void refuse(unsigned code) {
    push(code);
    ++library.refused;
}

bool is_zero(const HdVector& v) { return v == HdVector{}; }

bool renders_force() { return library.open && library.running && library.enabled && !library.unplugged; }

void call_back() {
    library.frame_done = false;
    const std::vector<Callback> now = library.callbacks;
    for (const Callback& callback : now)
        if (callback.function(callback.argument) == 0)
            std::erase_if(library.callbacks, [&](const Callback& c) { return c.handle == callback.handle; });
}

void advance(double seconds) {
    library.target_time += seconds;
    while (arm.time + 0.5 * bolt::emulate::hd_time_step < library.target_time) {
        step(arm, renders_force());
        if (arm.time + 0.5 * bolt::emulate::hd_time_step < library.next_tick) continue;
        library.next_tick = arm.time + tick;
        if (library.running) call_back();
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

bool check_handle(unsigned device) {
    if (library.open && device == the_arm) return true;
    refuse(bad_handle);
    return false;
}

bool is_initialised() {
    if (library.open) return true;
    refuse(invalid_operation);
    return false;
}

// Returns true if a force may be set now; otherwise reports the error.
bool may_render() {
    if (!is_initialised()) return false;
    if (!library.in_frame)
        refuse(outside_frame);
    else if (!library.running || !library.enabled)
        refuse(invalid_operation);
    return library.in_frame && library.running && library.enabled;
}

void check_frame() {
    if (const unsigned code = std::exchange(library.raised, 0); code != 0) push(code);
    const bool renders_now = renders_force() && (!is_zero(arm.force) || !is_zero(arm.gimbal_torque));
    if (renders_now && library.heat >= 1.0) push(warm_motors);
    if (renders_force() && length(arm.velocity) > library.speed_limit) push(too_fast);
}

// mm
HdVector reported_position() {
    HdVector at = measured_position(arm, library.calibration == calibrated);
    for (double& c : at) c *= 1e3;
    return at;
}

// Column by column, as OpenGL stores it.
void get_transform(double* out) {
    const HdMatrix turned = orientation(arm);
    const HdVector at = reported_position();
    for (std::size_t column = 0; column < 3; ++column) {
        for (std::size_t row = 0; row < 3; ++row) out[4 * column + row] = turned[row][column];
        out[4 * column + 3] = 0.0;
        out[12 + column] = at[column];
    }
    out[15] = 1.0;
    if (library.corrupt) std::fill(out, out + 16, std::numeric_limits<double>::quiet_NaN());
}

}  // namespace

extern "C" {

void emu_hd_reset(void) {
    scheduler = {};
    const std::lock_guard lock(mutex);
    arm = {};
    library = Library{};
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
void emu_hd_buttons(int mask) { library.buttons = mask; }
void emu_hd_calibration(unsigned status) { library.calibration = status; }
void emu_hd_inkwell(void) {
    library.in_inkwell = true;
    if (library.calibration == needs_inkwell) library.calibration = needs_update;
}
void emu_hd_only_name(const char* name) { library.only_name = name != nullptr ? name : ""; }
void emu_hd_unplug(int on) {
    const std::lock_guard lock(mutex);
    library.unplugged = on != 0;
}
void emu_hd_in_use(int on) { library.in_use = on != 0; }
void emu_hd_licensed(int on) { library.licensed = on != 0; }
void emu_hd_heat(double heat) { library.heat = heat; }
void emu_hd_speed_limit(double v) { library.speed_limit = v; }
void emu_hd_corrupt(int on) { library.corrupt = on != 0; }
void emu_hd_raise(unsigned error) { library.raised = error; }
void emu_hd_late(double seconds) { library.next_tick += seconds; }
void emu_hd_switch_off(void) { library.enabled = false; }
void emu_hd_force(double out[6]) {
    const std::lock_guard lock(mutex);
    const HdVector on_hand = renders_force() ? arm.force : HdVector{};
    const HdVector torque = renders_force() && arm.report.renders == 6 ? torque_on_hand(arm) : HdVector{};
    std::copy(on_hand.begin(), on_hand.end(), out);
    std::copy(torque.begin(), torque.end(), out + 3);
}
int emu_hd_open(void) { return library.open ? 1 : 0; }
int emu_hd_running(void) { return library.running ? 1 : 0; }
int emu_hd_initialisations(void) { return library.initialisations; }
int emu_hd_refused(void) { return library.refused; }

unsigned hdInitDevice(const char* name) {
    const std::lock_guard lock(mutex);
    ++library.initialisations;
    const bool known = library.only_name.empty() || (name != nullptr && library.only_name == name);
    const unsigned error = !library.licensed                ? no_licence
                           : library.unplugged              ? no_communication
                           : library.in_use || library.open ? already_initiated
                           : !known                         ? bad_configuration
                                                            : 0;
    if (error != 0) {
        push(error);
        return no_arm;
    }
    library.open = true;
    library.enabled = library.in_frame = false;
    arm.force = arm.gimbal_torque = library.next_force = library.next_torque = {};
    return the_arm;
}
void hdDisableDevice(unsigned device) {
    const std::lock_guard lock(mutex);
    if (!check_handle(device)) return;
    library.open = library.enabled = library.in_frame = false;
}
void hdBeginFrame(unsigned device) {
    const std::lock_guard lock(mutex);
    if (!check_handle(device)) return;
    if (library.in_frame || (library.running && library.frame_done)) return refuse(illegal_begin);
    library.in_frame = true;
    if (library.unplugged) push(no_communication);
}
void hdEndFrame(unsigned device) {
    const std::lock_guard lock(mutex);
    if (!check_handle(device)) return;
    if (!library.in_frame) return refuse(illegal_end);
    library.in_frame = false;
    library.frame_done = true;
    if (saturate(arm, library.next_force, library.next_torque)) push(too_much_force);
    arm.force = library.next_force;
    arm.gimbal_torque = library.next_torque;
    check_frame();
}
void hdGetDoublev(unsigned what, double* out) {
    const std::lock_guard lock(mutex);
    if (!is_initialised() || library.unplugged) return;
    switch (what) {
        case position: {
            const HdVector at = reported_position();
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
            std::fill(out, out + 6, library.heat);  // one for each motor
            break;
        case force:
            std::copy(library.next_force.begin(), library.next_force.end(), out);
            break;
        default:
            refuse(invalid_enum);
    }
}
void hdGetIntegerv(unsigned what, int* out) {
    const std::lock_guard lock(mutex);
    if (!is_initialised() || library.unplugged) return;
    switch (what) {
        case buttons:
            *out = library.buttons;
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
    if (!is_initialised() || library.unplugged) return;
    if (what != inkwell) return refuse(invalid_enum);
    *out = library.in_inkwell ? 0 : 1;  // the switch is closed while the stylus is out
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
        std::copy(in, in + 3, library.next_force.begin());
    else
        std::transform(in, in + 3, library.next_torque.begin(), [](double t) { return 1e-3 * t; });
}
void hdEnable(unsigned what) {
    const std::lock_guard lock(mutex);
    if (!is_initialised()) return;
    if (what != force_output) return refuse(invalid_enum);
    library.enabled = true;
}
void hdDisable(unsigned what) {
    const std::lock_guard lock(mutex);
    if (!is_initialised()) return;
    if (what != force_output) return refuse(invalid_enum);
    library.enabled = false;
}
Error hdGetError(void) {
    const std::lock_guard lock(mutex);
    if (library.errors.empty()) return {0, 0, no_arm};
    const Error newest = library.errors.back();
    library.errors.pop_back();
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
    return is_initialised() ? library.calibration : needs_inkwell;
}
void hdUpdateCalibration(unsigned) {
    const std::lock_guard lock(mutex);
    if (!is_initialised()) return;
    if (!library.running || library.enabled || library.calibration == needs_inkwell)
        return refuse(invalid_operation);
    library.calibration = calibrated;
}
void hdSetSchedulerRate(unsigned long) {}
void hdStartScheduler(void) {
    const std::lock_guard lock(mutex);
    if (!is_initialised()) return;
    library.running = true;
    library.next_tick = arm.time + tick;
    if (has_own_clock && !scheduler.joinable()) scheduler = std::jthread(run_scheduler);
}
void hdStopScheduler(void) {
    scheduler = {};  // joins
    const std::lock_guard lock(mutex);
    library.running = false;
}
unsigned long hdScheduleAsynchronous(unsigned (*function)(void*), void* argument, unsigned short) {
    const std::lock_guard lock(mutex);
    if (!is_initialised()) return 0;
    library.callbacks.push_back({library.next_handle, function, argument});
    return library.next_handle++;
}
void hdUnschedule(unsigned long handle) {
    const std::lock_guard lock(mutex);
    if (std::erase_if(library.callbacks, [&](const Callback& c) { return c.handle == handle; }) == 0)
        refuse(invalid_operation);
}
}
