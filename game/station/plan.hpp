// Prepares a station from the user's request: devices, a wheel configuration, a glove and its wearer, an
// assembly. Reports all errors of the request before a device is opened; only the glove is queried. The
// result may be changed before Station::start.
#pragma once

#include "content/format/assembly.hpp"
#include "game/session/lesson_session.hpp"
#include "game/station/choice.hpp"
#include "game/station/wearer.hpp"
#include "haptics/station/station.hpp"

namespace bolt::station_setup {

struct Wanted {
    std::vector<std::string> devices{};  // ids, one per role; choose_any() proposes some
    std::filesystem::path rig{};  // wheel configuration file; empty: the defaults of device::WheelConfig
    device::DeviceFactory otherwise{};  // moves the tool if no device does, for example mouse and keyboard
    std::filesystem::path glove{};      // serial port; empty: no glove
    std::string trainee{};              // wearer of the glove; empty: its samples are read but form no hand
    std::filesystem::path calibrations{};  // empty: calibrations_folder()

    double force_scale = 1.0;  // 0 … 1, scale of the forces in a lesson

    bool obstacles = true;   // if the assembly has contact models
    bool tight = false;      // all joints begin tightened
    std::size_t joint = 0;   // on whose nut the wrench begins
    std::uint64_t seed = 1;  // of the scatter of the joints' parameters
};

// The description of the station remains valid after `plan` is moved into a station.
struct Planned {
    station::StationOptions plan;
    Choice choice;
    std::filesystem::path glove;                    // its port; empty: none
    std::optional<content::GloveCalibration> worn;  // calibration of the glove's wearer
    bool obstacles = false;
};

// Copies `assembly`.
Result<Planned> make_plan(const content::Assembly& assembly, const Wanted& wanted);

// For a lesson: obstacles, task and seed come from `course` and override `wanted`. `home` is the tool's
// initial pose. The lesson's own session must be prepared from the same `course` and get the station's limits
// (session::use_device), so that both compute the same ticks.
Result<Planned> plan_lesson(const content::Assembly& assembly, const session::CourseOptions& course,
                            const Wanted& wanted, const Pose& home);

// Pose of a wrench on a joint's nut with its handle where it can swing by 30°. Without obstacles any
// direction is free.
Pose wrench_on_nut(const servo::Setup& setup, const servo::ToolContact* touch, std::size_t joint,
                   double nut_angle);

}  // namespace bolt::station_setup
