// Prepares a station from a request: selects devices and their roles, finds the calibration of the glove's
// wearer, and describes the station to start. Also defines the interface between a lesson and its station.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "content/format/assembly.hpp"
#include "content/station/station_file.hpp"
#include "content/trainee/glove_calibration.hpp"
#include "game/session/lesson_session.hpp"
#include "haptics/device/connected_devices.hpp"
#include "haptics/device/preparation.hpp"
#include "haptics/device/simulated_arm.hpp"
#include "haptics/device/virtual_devices.hpp"
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

// The device with this id. Fails if there is none, and then suggests the nearest id, or if it cannot be
// opened, and then names the remedy.
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
// and cannot have its role, or with ErrorCode::usage if one of `ids` has the role of another device in the
// file: its settings are for that one.
Status add_devices_of(const content::StationFile& station, std::span<const device::ListedDevice> connected,
                      std::vector<std::string>& ids);

// The default folder of calibrations, by the XDG base directory specification.
Result<std::filesystem::path> calibrations_folder();

// Waits up to 6 s for the first sample and returns the glove's identity. Fails if the port cannot be opened
// or no glove answers.
Result<hand::GloveIdentity> wait_for_glove(hand::GloveDriver& driver, const std::filesystem::path& port);

// Returns a warning if the serial adapter's latency timer delays the glove's bytes; otherwise an empty text.
std::string adapter_warning(const std::filesystem::path& port);

// The trainee's stored calibration for this glove. `folder` empty: calibrations_folder(). Fails if there is
// none for this side or it is for another number of sensors.
Result<content::GloveCalibration> find_calibration(const std::string& trainee,
                                                   const hand::GloveIdentity& glove,
                                                   const std::filesystem::path& folder = {});

// The pose of the wrist, in the tool's frame, of a hand around the handle at `along` m from the jaw, thumb
// towards the jaw, palm on the side of the tool's normal. Of the poses near a natural grip, the one at which
// the most closures of the hand grasp the handle; of equal ones the nearest.
Pose wrist_at_handle(const hand::Hand& hand, const collision::ToolShape& tool, double along);

// The gloved hand at the assembly's wrench. Fails if the wrench has no contact model.
Result<station::HandSetup> make_hand_setup(const content::Assembly& assembly,
                                           const content::GloveCalibration& calibration);

struct StationRequest {
    std::vector<std::string> devices{};  // ids, at most one per role
    // Its settings apply to those of its devices that are in `devices`; its glove and tool are not used.
    content::StationFile station{};
    // Used instead of the station's; empty: the station's, or the defaults of device::WheelConfig.
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
    bool obstacles = false;                                // the assembly has contact models
};

// Applies the settings of a station file to those devices of `planned` whose ids it names: the map, the
// limits and the buttons go to the options. Returns the configuration of the wheel.
device::WheelConfig apply_station(const content::StationFile& station, PlannedStation& planned);

// Fails for an invalid request before it opens a device; opens only the glove, to query its identity. The
// result holds a copy of `assembly`.
Result<PlannedStation> plan_station(const content::Assembly& assembly, const StationRequest& request);

// The station of a lesson: obstacles, task and seed come from `lesson` and override `request`. `home` is the
// tool's initial pose. The lesson's own session must be prepared from the same `lesson` and get the station's
// limits (session::set_device_limits), so that both compute the same ticks.
Result<PlannedStation> plan_lesson_station(const content::Assembly& assembly,
                                           const session::LessonOptions& lesson,
                                           const StationRequest& request, const Pose& home);

// The pose of a wrench on a joint's nut with a handle direction in which it can swing by 30°. `contact` null:
// there are no obstacles, and every direction is free.
Pose initial_wrench_pose(const servo::Setup& setup, const servo::ToolContact* contact, std::size_t joint,
                         double nut_angle);

// A station as a lesson uses it. start_threaded_station() returns one that runs on its own threads,
// start_frame_stepped_station() one whose ticks run in step().
class LessonStation {
  public:
    LessonStation() = default;
    LessonStation(const LessonStation&) = delete;
    LessonStation& operator=(const LessonStation&) = delete;
    virtual ~LessonStation() = default;

    virtual void set_controls(const station::StationControls& controls) = 0;
    // Fails if the command queue is full (station::Station::send).
    [[nodiscard]] virtual Status send(const station::StationCommand& command) = 0;
    // Input from mouse and keyboard, used if no device moves the tool, or a simulated arm does; call it every
    // frame.
    virtual void set_puck_input(const device::PuckInput& /*input*/) {}
    virtual void set_hand_motion(const device::HandMotion& /*motion*/) {}
    // Call once a frame with the time since the last one, s. Runs the ticks of that time if the station has
    // no threads.
    virtual void step(double /*seconds*/) {}
    // Reads the next tick in order; false: there is none yet.
    virtual bool next_tick(station::StationTick& tick) = 0;
    virtual const station::StationTick& latest_tick() = 0;       // is updated in a pause too
    [[nodiscard]] virtual std::uint64_t lost_ticks() const = 0;  // dropped because they were not read in time
    virtual const station::DisplayedHand* hand() = 0;            // null: no gloved hand
    virtual std::vector<std::string> fault_messages() = 0;       // of devices and glove, present ones
    // Needs of the device that moves the tool before it can be opened again, after it was lost.
    virtual device::ArmNeeds needs() { return {}; }
    virtual device::DeviceHealth health() { return {}; }  // of that device
    virtual void permit_move() {}  // to that device, for its next attempt (device::MovePermission)

    [[nodiscard]] virtual const station::Layout& layout() const = 0;
    [[nodiscard]] virtual const servo::Setup& setup() const = 0;

    // Stops the station at zero force. Returns the timing of its servo thread, null if it has none.
    virtual const servo::Timing* stop() = 0;
};

// The virtual device that mouse and keyboard move if no device moves the tool; monostate: none.
using VirtualMover = std::variant<std::monostate, device::VirtualPuck, device::SimulatedArm>;

// Starts the station on its own threads. `permission`: of the device that moves the tool; may be null.
Result<std::unique_ptr<LessonStation>> start_threaded_station(
    station::StationOptions options, VirtualMover mover,
    std::shared_ptr<device::MovePermission> permission = {});

// Starts a station without threads, whose simulated arm moves in the time of the frames: no tick is missed
// on a busy computer, and the same input gives the same lesson. `arm`: device::simulated_arm_description() or
// device::tracked_hand_description().
Result<std::unique_ptr<LessonStation>> start_frame_stepped_station(const station::StationOptions& options,
                                                                   const device::Description& arm);

}  // namespace bolt::station_setup
