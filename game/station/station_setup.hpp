// Which of the devices that are there a station uses, and what for. Pure: device::list_devices() says what is
// there.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "content/format/assembly.hpp"
#include "content/trainee/glove_calibration.hpp"
#include "game/session/lesson_session.hpp"
#include "haptics/device/hid_devices.hpp"
#include "haptics/device/virtual_devices.hpp"
#include "haptics/hand/glove_driver.hpp"
#include "haptics/station/gloved_hand.hpp"
#include "haptics/station/station.hpp"

namespace bolt::station_setup {

enum class Use : std::uint8_t {
    mover,  // moves the tool
    wheel,  // turns the wrench on its bolt and renders its torque
};
// The role of such a device; none: a station cannot use it.
std::optional<Use> use_of(device::HidKind kind);
const char* words(Use use);

// The device with this id. Fails if there is none, and then suggests the nearest id, or if it cannot be
// opened, and then names the remedy.
Result<device::ListedDevice> find(std::span<const device::ListedDevice> there, const std::string& id);

struct Choice {
    std::optional<device::ListedDevice> mover, wheel;
};

// The devices with these ids, at most one per role. Fails as find(), if two have the same role, or if one has
// none.
Result<Choice> choose(std::span<const device::ListedDevice> there, std::span<const std::string> ids);

// The first usable device of each role.
Choice choose_any(std::span<const device::ListedDevice> there);
std::vector<std::string> ids_of(const Choice& choice);

// The wearer of the glove: the stored calibration, and the pose of the hand at a wrench.

// The default folder of calibrations, by the XDG base directory specification.
Result<std::filesystem::path> calibrations_folder();

// Waits up to 6 s for the first sample and returns the glove's identity. Fails if the port cannot be opened
// or no glove answers.
Result<hand::GloveIdentity> await_glove(hand::GloveDriver& driver, const std::filesystem::path& port);

// A message if the serial adapter's latency timer delays the glove's bytes; empty if it does not.
std::string about_adapter(const std::filesystem::path& port);

// The trainee's stored calibration for this glove. `folder` empty: calibrations_folder(). Fails if there is
// none for this side or it is for another number of sensors.
Result<content::GloveCalibration> calibration_of(const std::string& trainee, const hand::GloveIdentity& glove,
                                                 const std::filesystem::path& folder = {});

// The pose of the wrist, in the tool's frame, of a hand around the handle at `along` m from the jaw, thumb
// towards the jaw, palm on the side of the tool's normal. The nearest pose to a natural grip at which closing
// the hand grasps the handle.
Pose wrist_at_handle(const hand::Hand& hand, const collision::ToolShape& tool, double along);

// The gloved hand at the assembly's wrench. Fails if the wrench has no contact model.
Result<station::HandSetup> hand_plan(const content::Assembly& assembly,
                                     const content::GloveCalibration& calibration);

// Prepares a station from the user's request: devices, a wheel configuration, a glove and its wearer, an
// assembly. Reports all errors of the request before a device is opened; only the glove is queried. The
// result may be changed before Station::start.

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

// The interface between a lesson and its station. start_bench() returns one that runs on its own threads;
// tests implement one in virtual time.

class Bench {
  public:
    Bench() = default;
    Bench(const Bench&) = delete;
    Bench& operator=(const Bench&) = delete;
    virtual ~Bench() = default;

    virtual void set_controls(const station::StationControls& controls) = 0;
    // Fails if the command queue is full (station::Station::send).
    [[nodiscard]] virtual Status send(const station::StationCommand& command) = 0;
    // Rates from mouse and keyboard if no device moves the tool; call it every frame.
    virtual void push(const device::PuckInput& push) = 0;
    virtual bool next_tick(station::TickRecord& tick) = 0;       // all ticks in order; false: no more yet
    virtual const station::TickRecord& latest_tick() = 0;        // in a pause too
    [[nodiscard]] virtual std::uint64_t lost_ticks() const = 0;  // not read in time and dropped
    virtual const station::DisplayedHand* hand() = 0;            // null: no gloved hand
    virtual std::vector<std::string> troubles() = 0;

    [[nodiscard]] virtual const station::Layout& layout() const = 0;
    [[nodiscard]] virtual const servo::Setup& setup() const = 0;

    // Stops the station at zero force. Returns the timing of its servo thread, null if it has none.
    virtual const servo::Timing* stop() = 0;
};

// Starts the station. `puck` receives push() and moves the tool if no device does.
Result<std::unique_ptr<Bench>> start_bench(station::StationOptions options,
                                           std::optional<device::VirtualPuck> puck);

}  // namespace bolt::station_setup
