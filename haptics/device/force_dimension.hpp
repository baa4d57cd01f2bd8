// Arms of Force Dimension (delta, omega, sigma, lambda) through the vendor's library libdrd, loaded at run
// time. Functions, units and frames: dhdc.h and drdc.h of the Force Dimension SDK 3.17. Not tried on
// hardware.
#pragma once

#include <filesystem>
#include <vector>

#include "haptics/device/device.hpp"

namespace bolt::device {

// The vendor's functions. Each returns a negative value for an error; `id` is the handle of an open arm.
// dhdGetStatus fills 17 ints or, in older versions, 14.
struct ForceDimensionApi {
    std::filesystem::path library;
    int (*get_device_count)() = nullptr;
    int (*open_id)(char index) = nullptr;
    int (*close)(char id) = nullptr;
    bool (*is_initialized)(char id) = nullptr;
    int (*auto_init)(char id) = nullptr;
    int (*stop_regulation)(bool keep_force, char id) = nullptr;
    bool (*has_wrist)(char id) = nullptr;
    bool (*has_active_wrist)(char id) = nullptr;
    int (*set_max_force)(double newton, char id) = nullptr;
    int (*set_max_torque)(double newton_metre, char id) = nullptr;
    int (*enable_force)(unsigned char on, char id) = nullptr;
    int (*brake)(char id) = nullptr;
    int (*get_status)(int* status, char id) = nullptr;
    int (*get_frame)(double* x, double* y, double* z, double rotation[3][3], char id) = nullptr;
    unsigned (*get_button_mask)(char id) = nullptr;
    int (*set_forces)(double fx, double fy, double fz, double tx, double ty, double tz, double gripper,
                      char id) = nullptr;
    int (*get_error)() = nullptr;
    const char* (*get_error_text)() = nullptr;
    // Null in a library that lacks them; the arm can be used without them.
    bool (*has_gripper)(char id) = nullptr;
    int (*get_gripper_angle)(double* radian, char id) = nullptr;  // negative on a left-handed arm
    int (*get_type)(char id) = nullptr;
    const char* (*get_name)(char id) = nullptr;
    int (*get_serial)(unsigned short* serial, char id) = nullptr;
    int (*compensate_gravity)(int on, char id) = nullptr;
    int (*set_mounted_mass)(double kilogram, char id) = nullptr;
};

// Where the library may be: in $FDSDK, the folder of the SDK, in /usr/local/lib, or in the loader's path.
std::vector<std::filesystem::path> force_dimension_libraries();

// ErrorCode::no_device if the library is absent; another code if it cannot be loaded or lacks a function.
Result<ForceDimensionApi> load_force_dimension(const std::vector<std::filesystem::path>& candidates);

struct ForceDimensionOptions {
    int index = 0;               // of the arm, from 0
    bool may_move = false;       // the arm may move by itself to find its position, if it has not done so yet
    double effector_mass = 0.0;  // kg, of the mounted handle or tool; 0: that of the factory
};

// Opens arm `index`, which then compensates its weight; the brakes hold it when it is closed. If the arm must
// move by itself and `may_move` is false, the error has DeviceNeed::permission. The limits are those of the
// model or, for an unknown model, the smallest of the arms with the same joints (docs/decisions.md). The
// speed limit that the factory has set stays.
Result<std::unique_ptr<DeviceDriver>> open_force_dimension(const ForceDimensionApi& api,
                                                           const ForceDimensionOptions& options, Timer timer);

}  // namespace bolt::device
