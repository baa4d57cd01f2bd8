// The part of the driver of OpenHaptics' arms that runs on the vendor's thread, and the constants of
// hdDefines.h that it uses.
#pragma once

#include <array>
#include <atomic>
#include <optional>

#include "engine/base/lock_free.hpp"
#include "haptics/device/open_haptics.hpp"

namespace bolt::device::open_haptics {

// Results of check_calibration(), and the capability that switches the forces on and off.
inline constexpr unsigned calibrated = 0x5000, needs_update = 0x5001, force_output = 0x4000;
// Errors. Those below first_fault end the forces for a while, the others until the arm is opened again.
inline constexpr unsigned warm_motors = 0x200, first_fault = 0x300, already_initiated = 0x301,
                          no_licence = 0x600;

// A frame, here and in OpenHaptics, is a tick of the library's scheduler.
inline constexpr double frame_time = 1e-3;  // s, the scheduler's period
inline constexpr int max_buttons = 4;

using Doubles = std::array<double, 16>;  // room for the longest value, the transform

// The values of parameter `what` of hdDefines.h: 16 values, NaN where the library reports none; and the first
// integer value, 0 if the library reports none.
Doubles get_doubles(const OpenHapticsApi& api, unsigned what);
int get_integer(const OpenHapticsApi& api, unsigned what);

// Pops the errors from the stack and passes their codes to `note`, the newest first.
template <class Note>
void take_errors(const OpenHapticsApi& api, const Note& note) {
    constexpr int max_errors = 100;  // a broken library may never report 0
    for (int i = 0; i < max_errors; ++i) {
        const unsigned code = api.get_error().code;
        if (code == 0) return;
        note(code);
    }
}

// The properties of an open arm.
struct ArmProperties {
    Description description;
    Vec3 centre{0.0};  // m, of the reach, in the vendor's frame
    bool senses_rotation = false;
    unsigned calibration_style = 0;
};

struct TimedCommand {
    force::OutputCommand output;
    double time = -1e9;  // s, when it was written
};

// s without a frame after which the device thread switches the forces off, because the library keeps
// rendering the last force. The next frame switches them on again, and the force grows from zero.
inline constexpr double max_frame_age = 15e-3;

struct FrameReport {
    double time = 0.0;  // s, of the frame
    Sample sample;
    std::uint64_t number = 0;    // counts the valid samples of a calibrated arm
    unsigned calibration = 0;    // as the library reports it; 0: not checked yet
    unsigned fault = 0;          // the error that has ended the forces for good; 0: none
    std::optional<double> heat;  // of the hottest motor, 0 … 1
    bool cooling = false;        // no force until the motors are cool
    bool released = false;       // a frame without force has ended since release()
};

// Runs one frame at each tick of the vendor's scheduler, on the vendor's thread. A late frame delays the
// control of the motors, so a frame never waits for the device thread: it takes the latest command from one
// mailbox and leaves a report in another.
class FrameCallback {
  public:
    FrameCallback(const OpenHapticsApi& api, unsigned id, const ArmProperties& arm, Timer timer)
        : api_(api), id_(id), arm_(arm), timer_(std::move(timer)), before_(timer_.now()) {}

    static unsigned run(void* self);  // for the scheduler

    // For the device thread.
    void release() { releases_.store(true, std::memory_order_relaxed); }  // no force from the next frame on
    TripleBuffer<TimedCommand> commands;
    TripleBuffer<FrameReport> reports;

  private:
    void run_frame();
    void calibrate();
    void take_sample(const Pose& pose, double now);
    void note_error(unsigned code, double now);
    bool is_paused(double now);
    void observe_heat();
    void update_strength(bool renders, double elapsed);
    void render(bool has_pose, double now, double elapsed);

    OpenHapticsApi api_;
    unsigned id_;
    ArmProperties arm_;
    Timer timer_;
    FrameReport report_;
    double before_;               // s, time of the last frame
    double strength_ = 1.0;       // share of the command that is rendered
    double paused_until_ = -1e9;  // s
    int frames_to_heat_ = 0;      // frames until the heat is queried again
    std::atomic<bool> releases_ = false;
};

}  // namespace bolt::device::open_haptics
