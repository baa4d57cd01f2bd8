#include "game/cli/try_station.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "content/format/load.hpp"
#include "engine/base/console.hpp"
#include "game/cli/interruption.hpp"
#include "game/station/trial.hpp"
#include "haptics/device/puck.hpp"
#include "haptics/device/timer.hpp"
#include "haptics/glove/serial_line.hpp"

namespace bolt::cli {

namespace {

std::string begins(const StationOptions& options, const content::Assembly& assembly,
                   const station::Planned& planned, const station::Station& station) {
    const std::string& joint = assembly.joints.front().design.id;
    std::string text = "Devices:\n" + station::introduce(station.layout(), planned.choice);
    text += fmt::format("The wrench sits on nut {} of {}, which is tight{}.\n", joint, assembly.name,
                        planned.obstacles ? "" : "; nothing can be bumped into");
    if (!options.glove.empty() && planned.worn)
        text += "It is in the hand as soon as the gloved hand closes.\n";
    return text + fmt::format("For {:g} s from now on:\n", options.seconds);
}

}  // namespace

int try_station(const StationOptions& options) {
    const content::Loaded loaded = content::load_assembly(options.assembly);
    if (!loaded.ok()) return complain(loaded.errors);
    device::Puck still({}, device::steady_timer());  // where there is no device that moves the tool
    station::Wanted wanted;
    wanted.devices = options.devices;
    wanted.rig = options.rig;
    wanted.otherwise = still.open();
    wanted.glove = options.glove;
    wanted.trainee = options.trainee;
    wanted.calibrations = options.calibrations;
    wanted.tight = true;

    Result<station::Planned> planned = station::make_plan(loaded.assembly, wanted);
    if (!planned) return complain(planned.error());
    if (!planned->choice.mover) planned->plan.mover_buttons = {0, 0, 0, 0};
    Result<station::Station> station = station::Station::start(std::move(planned->plan));
    if (!station) return complain(station.error());
    if (Status said = say(begins(options, loaded.assembly, *planned, *station)); !said)
        return complain(said.error());

    catch_interruption();
    Status said;
    const station::Trial trial = station::try_station(
        *station, *planned, options.seconds, [&] { return interrupted() || !said; },
        [&](double time, const std::string& words) {
            if (said) said = say(fmt::format("  {:5.1f} s  {}\n", time, words));
        });
    const std::vector<std::string> against = station::against(trial);
    if (said)
        said = say(station::report(trial) +
                   (against.empty() ? "This station is good enough\n"
                                    : fmt::format("This station is not good enough, because\n  {}\n",
                                                  fmt::join(against, "\n  "))));
    if (!said) return complain(said.error());
    return against.empty() ? 0 : static_cast<int>(ErrorCode::failed);
}

std::string what_to_try() {
    const std::vector<std::string> ids = station::ids_of(station::choose_any(device::list()));
    std::string text;
    if (!ids.empty())
        text = fmt::format("  boltwright doctor --device {} tries {}\n", fmt::join(ids, " --device "),
                           ids.size() == 1 ? "it" : "them");
    if (const auto ports = glove::serial_ports(); !ports.empty())
        text += fmt::format("  boltwright doctor --glove {} --trainee NAME tries a glove there\n",
                            ports.front().string());
    return text;
}

}  // namespace bolt::cli
