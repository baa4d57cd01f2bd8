// From what somebody asks for (devices, a rig file, a glove and whose hand is in it, an assembly) to a
// station that can be started. Everything that can be wrong with that is said here, before a device is opened
// for work; the glove is asked what it is. What is returned may be changed before Station::start.
#pragma once

#include "content/format/assembly.hpp"
#include "game/play/course.hpp"
#include "game/station/choice.hpp"
#include "game/station/wearer.hpp"
#include "haptics/station/station.hpp"

namespace bolt::station {

struct Wanted {
    std::vector<std::string> devices{};    // ids, one for each use; choose_any() has a proposal
    std::filesystem::path rig{};           // what is known of the wheel; empty: device/rig.hpp's
    device::Open otherwise{};              // moves the tool where no device does: mouse and keyboard, say
    std::filesystem::path glove{};         // its port; empty: none
    std::string trainee{};                 // who wears it; empty: its samples are read, and make no hand
    std::filesystem::path calibrations{};  // empty: where they are kept

    double force_scale = 1.0;  // 0 … 1 of the forces, in a lesson

    bool obstacles = true;   // where the assembly models them
    bool tight = false;      // all joints are tight already
    std::size_t joint = 0;   // on whose nut the wrench is to begin
    std::uint64_t seed = 1;  // of the joints' scatter
};

// What there is to say of it stays when the plan itself is moved into a station.
struct Planned {
    Plan plan;
    Choice choice;
    std::filesystem::path glove;                    // its port; empty: none
    std::optional<content::GloveCalibration> worn;  // by whom the glove's hand is
    bool obstacles = false;
};

// `assembly` is copied.
Result<Planned> make_plan(const content::Assembly& assembly, const Wanted& wanted);

// For a lesson, of which obstacles, task and seed are in `course`, not in `wanted`. `home`: where the tool is
// when it begins. Whoever follows the lesson prepares it once more and gives that the devices that the
// station has (play::use_device): then both come to the same.
Result<Planned> plan_lesson(const content::Assembly& assembly, const play::CourseOptions& course,
                            const Wanted& wanted, const Pose& home);

// A wrench on a joint's nut, its handle where there is room to turn it. Without obstacles it is anywhere.
Pose wrench_on_nut(const servo::Setup& setup, const servo::Touch* touch, std::size_t joint, double nut_angle);

}  // namespace bolt::station
