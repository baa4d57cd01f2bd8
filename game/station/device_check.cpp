#include "game/station/device_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>

#include "haptics/station/station_tick.hpp"

namespace bolt::station_setup {

namespace {

constexpr double tick_time = 1e-3;       // s
constexpr double check_interval = 0.02;  // s between two polls of the trial
constexpr double button_timeout = 5.0;   // s without the button until the trial ends
constexpr double release_time = 0.05;    // s until the force has ended and the device has the command for it

// Data that the servo thread and the thread that waits for it exchange.
struct CheckedDevice {
    device::DeviceThread& thread;
    device::Timer timer = device::steady_timer();
    servo::Histogram age{};    // written by the servo thread
    std::uint64_t number = 0;  // of the last sample
    std::uint64_t samples = 0;
    std::optional<station::StiffnessTrial> trial{};  // stepped by the servo thread
    std::uint32_t dead_man = 0;                      // mask; 0: the device has no such button
    std::atomic<bool> held = false, ended = false;

    void tick(const servo::Deadline& deadline) {
        const device::DeviceSnapshot& snapshot = thread.snapshot();
        force::DeviceInput input;
        input.pose = snapshot.sample.pose;
        input.fresh = snapshot.number != number;
        input.missed = static_cast<std::uint32_t>(deadline.missed);
        samples += input.fresh && number != 0 ? snapshot.number - number : 0;
        if (input.fresh && number != 0 && snapshot.sample.time > 0.0)
            servo::add(age, static_cast<std::int64_t>(1e9 * (timer.now() - snapshot.sample.time)));
        number = snapshot.number;
        if (!trial) return;
        input.dead_man = snapshot.usable && (dead_man == 0 || (snapshot.sample.buttons & dead_man) != 0);
        held = input.dead_man;
        thread.command(station::step(*trial, input, tick_time), true);
        ended = trial->end != station::TrialEnd::none;
    }
};

Result<servo::ServoThread> run_ticks(CheckedDevice& checked) {
    servo::ThreadOptions options;
    options.rate = 1.0 / tick_time;
    return servo::ServoThread::start(options, [&checked](const servo::Deadline& deadline) {
        checked.tick(deadline);
        return true;
    });
}

// Waits for the end of the trial. Returns the reason if it was aborted, or else an empty text.
Result<std::string> wait_for_trial(CheckedDevice& checked, const std::function<bool()>& stop) {
    BOLT_TRY_ASSIGN(auto servo, run_ticks(checked));
    double held_at = checked.timer.now();
    std::string none;
    while (!checked.ended && none.empty()) {
        checked.timer.wait(check_interval);
        if (checked.held) held_at = checked.timer.now();
        if (checked.timer.now() - held_at > button_timeout)
            none = fmt::format("its button was not held for {:g} s", button_timeout);
        if (stop && stop()) none = "it was interrupted";
    }
    checked.timer.wait(release_time);
    return none;
}

std::string end_of(const station::StiffnessTrial& trial) {
    switch (trial.end) {
        case station::TrialEnd::rendered_as_reported:
            return "the full reported stiffness";
        case station::TrialEnd::oscillation:
            return fmt::format("at {:.2g} N/mm the handle keeps oscillating",
                               1e-3 * stiffness_of(trial, trial.level));
        case station::TrialEnd::energy:
            return fmt::format("at {:.2g} N/mm a spring at rest gives energy to the hand",
                               1e-3 * stiffness_of(trial, trial.level));
        case station::TrialEnd::fault:
            return fmt::format("at {:.2g} N/mm the force was blocked: {}",
                               1e-3 * stiffness_of(trial, trial.level), force::message_for(trial.fault));
        case station::TrialEnd::none:
            break;
    }
    return "unfinished";
}

std::string stiffness_report(const DeviceCheck& check) {
    if (!check.stiffness) return fmt::format("  stiffness not measured: {}\n", check.why_not_measured);
    const station::StiffnessTrial& trial = *check.stiffness;
    std::string text =
        trial.stable > 0.0
            ? fmt::format("  stable on this computer up to {:.2g} N/mm of the reported {:.2g} N/mm: {}\n",
                          1e-3 * trial.stable, 1e-3 * trial.limits.stiffness, end_of(trial))
            : fmt::format("  not stable on this computer at any stiffness that was tried: {}\n",
                          end_of(trial));
    if (const auto response = median_response(trial))
        text += fmt::format(
            "  the handle moves by 0.03 mm within {:.0f} ms of a command (median of {} steps of {:.2g} N; "
            "the inertia of arm and hand included)\n",
            1e3 * *response, trial.responses.size(), trial.limits.force);
    return text;
}

}  // namespace

double trial_force(const device::Description& description, const force::LimitBounds& bounds) {
    const double greatest = force::lowered(description.limits, bounds).force;
    return station::renders_force(description) ? station::trial_force_share * greatest : 0.0;
}

Result<DeviceCheck> check_device(device::DeviceThread& thread, const DeviceCheckOptions& options) {
    CheckedDevice checked{thread};
    DeviceCheck check;
    if (!thread.status().description)
        return fail(ErrorCode::no_device, "the device is not open", "an open device");
    check.description = *thread.status().description;
    check.description.limits = force::lowered(check.description.limits, options.bounds);
    const double begun = checked.timer.now();
    {
        BOLT_TRY_ASSIGN(const auto servo, run_ticks(checked));
        while (checked.timer.now() - begun < options.seconds && !(options.stop && options.stop()))
            checked.timer.wait(std::min(check_interval, begun + options.seconds - checked.timer.now()));
    }
    check.seconds = checked.timer.now() - begun;
    check.samples = checked.samples;
    check.why_not_measured = options.why_not_measured;
    if (trial_force(check.description, {}) <= 0.0) {
        check.why_not_measured = "it renders no force";
    } else if (options.measures_stiffness) {
        checked.trial = station::begin_stiffness_trial(check.description);
        checked.dead_man = check.description.buttons > 0 ? options.dead_man : 0;
        BOLT_TRY_ASSIGN(check.why_not_measured, wait_for_trial(checked, options.stop));
        if (check.why_not_measured.empty()) check.stiffness = std::move(checked.trial);
    }
    const device::DeviceStatus& status = thread.status();
    if (status.state != device::DeviceState::usable)
        return fail(
            ErrorCode::no_device,
            status.fault_message.empty() ? check.description.name + " sends nothing" : status.fault_message,
            "a device that sends its state");
    check.health = status.health;
    check.malformed_samples = status.malformed_samples;
    check.writes = status.writes;
    check.mean_write = status.writes > 0 ? status.write_time / static_cast<double>(status.writes) : 0.0;
    check.longest_write = status.longest_write;
    check.age = checked.age;
    return check;
}

std::string device_check_report(const DeviceCheck& check) {
    std::string text = fmt::format("{}  {}\n", check.description.id, check.description.name);
    for (const auto& lines : {device::summary_lines(check.description), device::summary_lines(check.health)})
        for (const std::string& line : lines) text += fmt::format("  {}\n", line);
    if (check.seconds > 0.0)
        text += fmt::format("  sent {:.0f} samples a second{}\n",
                            static_cast<double>(check.samples) / check.seconds,
                            check.samples == 0 ? "; it is at rest" : "");
    if (check.malformed_samples > 0) text += fmt::format("  {} malformed reports\n", check.malformed_samples);
    if (check.age.count > 0)
        text += fmt::format(
            "  from the driver's reading of a sample until a servo tick takes it: {:.2f} ms (median; 99 %: "
            "{:.2f} ms)\n",
            1e3 * servo::quantile(check.age, 0.5), 1e3 * servo::quantile(check.age, 0.99));
    if (check.writes > 0)
        text += fmt::format("  the driver takes a command in {:.3f} ms (mean of {}; longest {:.2f} ms)\n",
                            1e3 * check.mean_write, check.writes, 1e3 * check.longest_write);
    return text + stiffness_report(check);
}

}  // namespace bolt::station_setup
