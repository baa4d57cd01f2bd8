// Arms of 3D Systems (Touch, Touch X, Premium) through the vendor's library OpenHaptics HD, loaded at run
// time. Functions, units and values: hd.h and hdDefines.h of OpenHaptics 3.4. Not tried on hardware.
#pragma once

#include <filesystem>
#include <vector>

#include "haptics/device/device.hpp"

namespace bolt::device {

// An error of the vendor's library (HDErrorInfo); code 0: none.
struct OpenHapticsError {
    unsigned code;
    int internal_code;
    unsigned arm;
};

// The vendor's functions. They report errors on a stack that all threads share; get_error() takes the newest.
struct OpenHapticsApi {
    std::filesystem::path library;
    unsigned (*init_device)(const char* name) = nullptr;
    void (*disable_device)(unsigned arm) = nullptr;
    void (*begin_frame)(unsigned arm) = nullptr;
    void (*end_frame)(unsigned arm) = nullptr;
    void (*get_doubles)(unsigned what, double* values) = nullptr;
    void (*get_integers)(unsigned what, int* values) = nullptr;
    const char* (*get_string)(unsigned what) = nullptr;
    void (*set_doubles)(unsigned what, const double* values) = nullptr;
    void (*enable)(unsigned what) = nullptr;
    void (*disable)(unsigned what) = nullptr;
    OpenHapticsError (*get_error)() = nullptr;
    const char* (*get_error_text)(unsigned code) = nullptr;
    unsigned (*check_calibration)() = nullptr;
    void (*update_calibration)(unsigned style) = nullptr;
    void (*start_scheduler)() = nullptr;
    void (*stop_scheduler)() = nullptr;
    unsigned long (*schedule)(unsigned (*callback)(void*), void* argument, unsigned short priority) = nullptr;
    void (*unschedule)(unsigned long callback) = nullptr;
};

// Where the library may be: in $OH_SDK_BASE/lib (the vendor's installer sets the variable; the folder lib is
// not confirmed), in /usr/lib, or in the loader's path. Version 3.4 is preferred to 3.0.
std::vector<std::filesystem::path> open_haptics_libraries();

// ErrorCode::no_device if the library is absent; another code if it cannot be loaded or lacks a function.
// Neither moves nor reserves an arm.
Result<OpenHapticsApi> load_open_haptics(const std::vector<std::filesystem::path>& candidates);

// Opens the arm that the vendor's setup program made the default one, and calibrates it if that needs no help
// of the user. Its limits are those that it reports, at most those of its model (docs/decisions.md).
// `timer` is read from the vendor's thread too.
Result<std::unique_ptr<DeviceDriver>> open_open_haptics(const OpenHapticsApi& api, Timer timer);

}  // namespace bolt::device
