#include "game/cli/try_station.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "content/format/assembly.hpp"
#include "engine/base/console.hpp"
#include "game/cli/interruption.hpp"
#include "game/station/trial.hpp"
#include "haptics/device/device.hpp"
#include "haptics/device/virtual_devices.hpp"
#include "haptics/hand/glove_driver.hpp"

namespace bolt::cli {

namespace {

std::string begins(const StationOptions& options, const content::Assembly& assembly,
                   const station_setup::Planned& planned, const station::Station& station) {
    const std::string& joint = assembly.joints.front().design.id;
    std::string text = "Devices:\n" + station_setup::introduce(station.layout(), planned.choice);
    text += fmt::format("The wrench sits on nut {} of {}, which is tight{}.\n", joint, assembly.name,
                        planned.obstacles ? "" : "; nothing can be bumped into");
    if (!options.glove.empty() && planned.worn)
        text += "It is in the hand as soon as the gloved hand closes.\n";
    return text + fmt::format("For {:g} s from now on:\n", options.seconds);
}

}  // namespace

int try_station(const StationOptions& options) {
    const content::Loaded loaded = content::load_assembly(options.assembly);
    if (!loaded.ok()) return print_error(loaded.errors);
    device::VirtualPuck still({}, device::steady_timer());  // where there is no device that moves the tool
    station_setup::Wanted wanted;
    wanted.devices = options.devices;
    wanted.rig = options.rig;
    wanted.otherwise = still.open();
    wanted.glove = options.glove;
    wanted.trainee = options.trainee;
    wanted.calibrations = options.calibrations;
    wanted.tight = true;

    Result<station_setup::Planned> planned = station_setup::make_plan(loaded.assembly, wanted);
    if (!planned) return print_error(planned.error());
    if (!planned->choice.mover) planned->plan.mover_buttons = {0, 0, 0, 0};
    Result<station::Station> station = station::Station::start(std::move(planned->plan));
    if (!station) return print_error(station.error());
    if (Status said = print(begins(options, loaded.assembly, *planned, *station)); !said)
        return print_error(said.error());

    catch_interruption();
    Status said;
    const station_setup::Trial trial = station_setup::try_station(
        *station, *planned, options.seconds, [&] { return interrupted() || !said; },
        [&](double time, const std::string& words) {
            if (said) said = print(fmt::format("  {:5.1f} s  {}\n", time, words));
        });
    const std::vector<std::string> against = station_setup::against(trial);
    if (said)
        said = print(station_setup::report(trial) +
                     (against.empty() ? "This station is good enough\n"
                                      : fmt::format("This station is not good enough, because\n  {}\n",
                                                    fmt::join(against, "\n  "))));
    if (!said) return print_error(said.error());
    return against.empty() ? 0 : static_cast<int>(ErrorCode::failed);
}

std::string what_to_try() {
    const std::vector<std::string> ids =
        station_setup::ids_of(station_setup::choose_any(device::list_devices()));
    std::string text;
    if (!ids.empty())
        text = fmt::format("  boltwright doctor --device {} tries {}\n", fmt::join(ids, " --device "),
                           ids.size() == 1 ? "it" : "them");
    if (const auto ports = hand::serial_ports(); !ports.empty())
        text += fmt::format("  boltwright doctor --glove {} --trainee NAME tries a glove there\n",
                            ports.front().string());
    return text;
}

}  // namespace bolt::cli
