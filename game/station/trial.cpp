#include "game/station/trial.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>

#include "haptics/device/device.hpp"

namespace bolt::station_setup {

namespace {

// s; a fault that lasts for less is dropped when another one begins (update_episodes), because the loss of a
// device produces several messages in turn. Device reports are up to 0.1 s old.
constexpr double same_fault_time = 0.3;
constexpr double poll_period = 0.02;         // s
constexpr double supervisor_silence = 0.25;  // s of silence that the device supervisor reports itself

bool renders(const std::optional<device::Description>& d) {
    return d && (station::renders_force(*d) || station::renders_torque(*d));
}
bool renders(const station::DeviceLayout& layout) { return renders(layout.mover) || renders(layout.wheel); }

std::string sample_summary(double count, double seconds, double age, double silence) {
    return fmt::format(
        "{:.0f} samples, {:.0f} a second; the newest {:.0f} ms old, the longest silence {:.0f} ms\n", count,
        seconds > 0.0 ? count / seconds : 0.0, 1e3 * age, 1e3 * silence);
}

std::string output_summary(const DeviceTrial& tried) {
    const device::Description& d = tried.description;
    std::string text;
    if (station::renders_force(d))
        text += fmt::format("    largest force {:.2f} N of at most {:.3g} N\n", tried.stats.largest_force,
                            d.limits.force);
    if (station::renders_torque(d))
        text += fmt::format("    largest torque {:.2f} N·m of at most {:.3g} N·m\n",
                            tried.stats.largest_torque, d.limits.torque);
    return text.empty() ? "    renders no force\n" : text;
}

std::string report(const DeviceTrial& tried, const char* role, double seconds) {
    std::string text = fmt::format("  {}: {}\n    ", tried.description.name, role);
    text += sample_summary(static_cast<double>(tried.stats.samples), seconds, tried.stats.silence,
                           tried.stats.longest_silence);
    if (tried.malformed_samples > 0)
        text += fmt::format("    {} malformed reports\n", tried.malformed_samples);
    return text + output_summary(tried);
}

std::string report(const GloveTrial& tried, double seconds) {
    const hand::GloveIdentity& identity = tried.report.identity;
    std::string text = fmt::format("Glove on {}: ", tried.port.string());
    if (tried.report.handshakes == 0) return text + "it did not answer\n";
    text += fmt::format("CyberGlove, {} hand, {} sensors\n    ",
                        identity.side == hand::Side::left ? "left" : "right", identity.sensors);
    text += sample_summary(tried.frames, seconds, tried.age, tried.report.longest_silence);
    if (tried.report.lost_bytes > 0)
        text += fmt::format("    {} invalid bytes received\n", tried.report.lost_bytes);
    if (const std::string warning = adapter_warning(tried.port); !warning.empty())
        text += fmt::format("    {}\n", warning);
    if (!tried.calibration)
        return text +
               "    no wearer was named (--trainee NAME): without a calibration the hand cannot grasp\n";
    text += fmt::format(
        "    calibrated for {}{}{}\n", tried.calibration->trainee,
        tried.calibration->date.empty() ? "" : " on " + tried.calibration->date,
        tried.calibration->quality > 0.0 ? fmt::format(", quality {:.2f}", tried.calibration->quality) : "");
    return text + (tried.held
                       ? "    the hand holds the wrench\n"
                       : "    the hand does not hold the wrench; close the fingers around its handle to "
                         "take it\n");
}

std::optional<DeviceTrial> device_trial(const std::optional<device::Description>& description,
                                        const station::LinkStats& stats, const device::DeviceStatus* status) {
    if (!description || status == nullptr) return std::nullopt;
    return DeviceTrial{*description, stats, status->malformed_samples, status->losses};
}

}  // namespace

std::string describe(const servo::ThreadPrivileges& privileges) {
    std::string text;
    if (privileges.priority > 0)
        text += fmt::format("  real-time priority {} (SCHED_FIFO)\n", privileges.priority);
    if (privileges.memory_locked) text += "  memory is locked\n";
    for (const std::string& refused : privileges.refused) text += "  " + refused + "\n";
    return text;
}

void update_episodes(std::vector<Episode>& episodes, std::span<const std::string> fault_messages, double time,
                     MessageHandler on_message) {
    const auto persists = [&](const Episode& e) {
        return std::find(fault_messages.begin(), fault_messages.end(), e.message) != fault_messages.end();
    };
    const auto is_new = [&](const std::string& message) {
        return std::none_of(episodes.begin(), episodes.end(),
                            [&](const Episode& e) { return !e.until && e.message == message; });
    };
    if (std::any_of(fault_messages.begin(), fault_messages.end(), is_new))
        std::erase_if(episodes, [&](const Episode& e) {
            return !e.until && time - e.from < same_fault_time && !persists(e);
        });
    for (Episode& e : episodes) {
        if (e.until || persists(e)) continue;
        e.until = time;
        on_message(time, "resolved: " + e.message);
    }
    for (const std::string& message : fault_messages) {
        if (!is_new(message)) continue;
        episodes.push_back({message, time, std::nullopt});
        on_message(time, message);
    }
}

StationTrial run_trial(station::Station& station, const PlannedStation& planned, double seconds,
                       const std::function<bool()>& stop, MessageHandler on_message) {
    const device::Timer timer = device::steady_timer();
    const double begun = timer.now();
    StationTrial trial;
    station::StationControls controls;
    controls.grip = servo::Grip::wrench;
    // Without force output the dead-man switch is set, so that the servo has its normal load. With force
    // output the user's button decides.
    controls.dead_man = !renders(station.layout());
    station.set_controls(controls);
    const double frames =
        station.glove_report() == nullptr ? 0.0 : static_cast<double>(station.glove_report()->frames);
    std::uint64_t dead_man_ticks = 0;
    bool held = false;
    const auto poll = [&] {
        for (station::StationTick tick; station.next_tick(tick);)
            dead_man_ticks += tick.input.dead_man ? 1 : 0;
        const double time = timer.now() - begun;
        update_episodes(trial.episodes, station.fault_messages(), time, on_message);
        if (station.hand() == nullptr || station.hand()->held == held) return;
        held = !held;
        on_message(time, held ? "the hand takes the wrench" : "the hand releases the wrench");
    };
    while (timer.now() - begun < seconds && !stop()) {
        timer.wait(std::min(poll_period, begun + seconds - timer.now()));
        poll();
    }
    trial.seconds = timer.now() - begun;
    if (const hand::GloveReport* glove = station.glove_report()) {
        trial.glove = {planned.glove,
                       *glove,
                       static_cast<double>(glove->frames) - frames,
                       glove->frames > 0 ? timer.now() - glove->newest : trial.seconds,
                       planned.calibration,
                       station.hand() != nullptr && station.hand()->held};
    }
    station.stop();
    poll();
    if (planned.devices.mover)
        trial.mover =
            device_trial(station.layout().mover, station.link_stats().mover, station.mover_status());
    trial.wheel = device_trial(station.layout().wheel, station.link_stats().wheel, station.wheel_status());
    trial.timing = station.servo().timing();
    trial.privileges = station.servo().privileges();
    trial.rate = 1.0 / station.setup().dt;
    trial.dead_man_time = static_cast<double>(dead_man_ticks) * station.setup().dt;
    return trial;
}

std::string describe_station(station::DeviceLayout layout, const DeviceSelection& devices) {
    std::string text;
    if (!devices.mover) {
        layout.mover.reset();
        text = "  no device moves the tool, so it stands still\n";
    }
    std::vector<std::string> with_button;
    bool forces = false;
    const auto add = [&](const std::optional<device::Description>& d, DeviceRole role,
                         const station::Buttons& buttons) {
        if (!d) return;
        text += fmt::format("  {}  {}: {}\n", d->id, d->name, describe(role));
        for (const std::string& line : device::summary_lines(*d)) text += fmt::format("    {}\n", line);
        forces = forces || renders(d);
        if (d->senses_gripper) with_button.push_back(fmt::format("the gripper of {}", d->name));
        if (d->buttons > 0 && buttons.dead_man != 0)
            with_button.push_back(
                fmt::format("button {} of {}", std::countr_zero(buttons.dead_man) + 1, d->name));
    };
    add(layout.mover, DeviceRole::mover, layout.mover_buttons);
    add(layout.wheel, DeviceRole::wheel, layout.wheel_buttons);
    if (!forces) return text + "No forces: no device renders any.\n";
    if (with_button.empty()) return text + "No forces: they require a held button, and no device has one.\n";
    return text + fmt::format("Forces are rendered only while {} is held.\n", fmt::join(with_button, " or "));
}

std::string trial_report(const StationTrial& trial) {
    std::string text = fmt::format("In {:.1f} s\n", trial.seconds);
    if (trial.mover) text += report(*trial.mover, describe(DeviceRole::mover), trial.seconds);
    if (trial.wheel) text += report(*trial.wheel, describe(DeviceRole::wheel), trial.seconds);
    const auto has_force = [](const auto& tried) { return tried && renders(tried->description); };
    if (has_force(trial.mover) || has_force(trial.wheel))
        text += trial.dead_man_time > 0.0
                    ? fmt::format("  the button was held for {:.1f} s\n", trial.dead_man_time)
                    : "  the button was never held, so the servo's load was lower than in use\n";
    if (trial.glove) text += report(*trial.glove, trial.seconds);
    text += fmt::format("Servo at {:.0f} ticks a second:\n", trial.rate) + describe(trial.privileges);
    return text + servo::describe(trial.timing);
}

std::vector<std::string> unfit_reasons(const StationTrial& trial) {
    std::vector<std::string> reasons;
    for (const Episode& e : trial.episodes)
        if (!e.until) reasons.push_back(e.message);
    for (const Episode& e : trial.episodes)
        if (e.until)
            reasons.push_back(fmt::format("{} (from {:.1f} to {:.1f} s)", e.message, e.from, *e.until));
    for (const auto* tried : {&trial.mover, &trial.wheel}) {
        if (!tried->has_value()) continue;
        const device::Description& d = (*tried)->description;
        const double silence = (*tried)->stats.longest_silence;
        // The supervisor reports longer silences and losses. A device that sends nothing at rest is never
        // silent.
        if (renders((*tried)->description) && !d.silent_at_rest && silence > d.limits.max_silence &&
            silence < supervisor_silence && (*tried)->losses == 0)
            reasons.push_back(
                fmt::format("{} was silent for {:.0f} ms; its force is released after {:.0f} ms", d.name,
                            1e3 * silence, 1e3 * d.limits.max_silence));
    }
    const servo::HostAssessment host = servo::assess_host(trial.timing, trial.rate);
    reasons.insert(reasons.end(), host.reasons.begin(),
                   host.reasons.begin() + static_cast<std::ptrdiff_t>(host.violations));
    return reasons;
}

}  // namespace bolt::station_setup
