// Prepares a station from a request: selects devices and their roles, finds the calibration of the glove's
// wearer, and describes the station to start. lesson_station.hpp starts one for a lesson.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "content/format/assembly.hpp"
#include "content/station/station_file.hpp"
#include "content/trainee/glove_calibration.hpp"
#include "game/session/lesson_session.hpp"
#include "haptics/device/connected_devices.hpp"
#include "haptics/device/preparation.hpp"
#include "haptics/hand/glove_driver.hpp"
#include "haptics/station/gloved_hand.hpp"
#include "haptics/station/station.hpp"

namespace bolt::station_setup {

enum class DeviceRole : std::uint8_t {
    mover,  // moves the tool
    wheel,  // turns the wrench on its bolt and renders its torque
};
// The role of a kind of device; none: a station cannot use it.
std::optional<DeviceRole> role_of(device::DeviceKind kind);
const char* describe(DeviceRole role);

// In the following, `connected` is the result of device::list_devices().

// The device with this id. Fails if there is none, with the nearest id as a suggestion, or if the device
// cannot be opened, with the remedy.
Result<device::ListedDevice> find_device(std::span<const device::ListedDevice> connected,
                                         const std::string& id);

struct DeviceSelection {
    std::optional<device::ListedDevice> mover, wheel;
};

// The devices with these ids, at most one per role. Fails as find_device(), if two have the same role, or if
// one has none.
Result<DeviceSelection> select_devices(std::span<const device::ListedDevice> connected,
                                       std::span<const std::string> ids);

// The first usable device of each role.
DeviceSelection select_any_devices(std::span<const device::ListedDevice> connected);
std::vector<std::string> ids_of(const DeviceSelection& selection);

// If `ids` is empty, sets it to the devices of the station file. Fails if a device of the file is connected
// and cannot have its role. Fails with ErrorCode::usage if one of `ids` would take a role that the file gives
// to another device, because the file's settings are for that device.
Status add_devices_of(const content::StationFile& station, std::span<const device::ListedDevice> connected,
                      std::vector<std::string>& ids);

// The default folder of calibrations, by the XDG base directory specification.
Result<std::filesystem::path> calibrations_folder();

// Waits up to 6 s for the first sample and returns the glove's identity. Fails if the port cannot be opened
// or no glove answers.
Result<hand::GloveIdentity> wait_for_glove(hand::GloveDriver& driver, const std::filesystem::path& port);

// Opens the port for a moment and returns the identity of the glove there. Fails as wait_for_glove(), or if
// the port cannot be accessed.
Result<hand::GloveIdentity> find_glove(const std::filesystem::path& port);

// Returns a warning if the serial adapter's latency timer delays the glove's bytes; otherwise an empty text.
std::string adapter_warning(const std::filesystem::path& port);

// The trainee's stored calibration for this glove. `folder` empty: calibrations_folder(). Fails if there is
// none for this side or it is for another number of sensors.
Result<content::GloveCalibration> find_calibration(const std::string& trainee,
                                                   const hand::GloveIdentity& glove,
                                                   const std::filesystem::path& folder = {});

hand::GloveWearer wearer_of(const content::GloveCalibration& calibration);

// The pose of the wrist, in the tool's frame, of a hand around the handle at `along` m from the jaw, thumb
// towards the jaw, palm on the side of the tool's normal. Tries poses near a natural one with several
// closures of the hand. Returns the pose at which the most closures grasp the handle; of equal poses, the one
// nearest to the natural one.
Pose wrist_at_handle(const hand::Hand& hand, const collision::ToolShape& tool, double along);

// The gloved hand at the assembly's wrench. Fails if the wrench has no contact model.
Result<station::HandSetup> make_hand_setup(const content::Assembly& assembly,
                                           const content::GloveCalibration& calibration);

struct StationRequest {
    std::vector<std::string> devices{};  // ids, at most one per role
    // The settings of the station file apply to those of its devices that are in `devices`; its glove and
    // tool are not used.
    content::StationFile station{};
    // Replaces the station's wheel configuration; empty: that of the station, or the defaults of
    // device::WheelConfig.
    std::filesystem::path wheel_config_file{};
    // Moves the tool if no device does, for example mouse and keyboard.
    device::DeviceFactory fallback_mover{};
    std::filesystem::path glove{};  // serial port; empty: no glove
    std::string trainee{};          // wearer of the glove; empty: its samples are read but form no hand
    std::filesystem::path calibrations{};  // empty: calibrations_folder()

    device::ArmDialog arm_dialog{};  // of an arm that must be prepared

    double force_scale = 1.0;  // 0 … 1, scale of the forces in a lesson

    bool obstacles = true;   // if the assembly has contact models
    bool tightened = false;  // all joints begin tightened
    std::size_t joint = 0;   // on whose nut the wrench starts
    std::uint64_t seed = 1;  // of the scatter of the joints' parameters
};

// The other members remain valid after `options` is moved into a station.
struct PlannedStation {
    station::StationOptions options;  // may be changed before Station::start
    DeviceSelection devices;
    std::filesystem::path glove;                           // serial port; empty: no glove
    std::optional<content::GloveCalibration> calibration;  // of the glove's wearer
    bool obstacles = false;  // contacts are simulated: requested, and the assembly has contact models
};

// Applies the settings of a station file to those devices of `planned` whose ids it names: the workspace
// mapping, the limits and the buttons go to the options. Returns the configuration of the wheel.
device::WheelConfig apply_station(const content::StationFile& station, PlannedStation& planned);

// Fails for an invalid request before it opens a device; opens only the glove, to query its identity. The
// result holds a copy of `assembly`.
Result<PlannedStation> plan_station(const content::Assembly& assembly, const StationRequest& request);

// The station of a lesson: obstacles, task and seed come from `lesson` and override `request`. `home` is the
// tool's initial pose. A lesson replays the station's ticks with a servo of its own, so both need equal
// setups: prepare the lesson's session from the same `lesson`, and give it the station's limits
// (session::set_device_limits).
Result<PlannedStation> plan_lesson_station(const content::Assembly& assembly,
                                           const session::LessonOptions& lesson,
                                           const StationRequest& request, const Pose& home);

// The pose of a wrench on a joint's nut with a handle direction in which it can swing by 30°. `contact` null:
// there are no obstacles, and every direction is free.
Pose initial_wrench_pose(const servo::Setup& setup, const servo::ToolContact* contact, std::size_t joint,
                         const joint::JointState& state);

}  // namespace bolt::station_setup
