#include "haptics/device/device_thread.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <cmath>
#include <system_error>
#include <thread>

namespace bolt::device {

namespace {

bool renders(const Description& d) {
    return std::any_of(d.renders.begin(), d.renders.end(), [](bool axis) { return axis; });
}

}  // namespace

DeviceSupervisor::DeviceSupervisor(DeviceFactory open, Timer timer, const SupervisorOptions& options)
    : open_(std::move(open)),
      timer_(std::move(timer)),
      options_(options),
      retry_delay_(options.first_retry_delay) {
    next_try_ = timer_.now();
}

DeviceSupervisor::~DeviceSupervisor() { close(); }

bool DeviceSupervisor::expects_samples() const {
    return status_.description->sensing != Sensing::velocity && !status_.description->silent_at_rest;
}

namespace {

// A position is plausible up to `plausible_reaches` times the reach from its middle; for an arm of unknown
// reach, up to `plausible_distance` (m).
constexpr double plausible_reaches = 4.0, plausible_distance = 2.0;

bool is_within_reach(const Vec3& position, const Vec3& reach) {
    const double half = std::max({reach.x, reach.y, reach.z});
    return glm::length(position) <= (half > 0.0 ? plausible_reaches * half : plausible_distance);
}

}  // namespace

bool DeviceSupervisor::is_valid(const Sample& s) const {
    switch (status_.description->sensing) {
        case Sensing::pose:
            return finite(s.pose.position) &&
                   is_within_reach(s.pose.position, status_.description->half_workspace) &&
                   std::abs(glm::dot(s.pose.orientation, s.pose.orientation) - 1.0) < 1e-2;
        case Sensing::velocity:
            return finite(s.velocity) && finite(s.angular_velocity);
        case Sensing::angle:
            return std::isfinite(s.angle);
    }
    return false;
}

bool DeviceSupervisor::try_open(std::uint64_t number) {
    Result<std::unique_ptr<DeviceDriver>> opened = open_();
    const double now = timer_.now();
    next_try_ = now + retry_delay_;
    retry_delay_ = std::min(2.0 * retry_delay_, options_.max_retry_delay);
    if (!opened) {
        ++status_.failed_openings;
        status_.fault_message = opened.error().message();
        status_.preparation = preparation_of(opened.error());
        return false;
    }
    ++status_.openings;
    status_.preparation = {};
    device_ = std::move(*opened);
    status_.description = std::make_shared<const Description>(device_->description());
    // One sample period, so that reading does not delay the next command.
    const double period = 1.0 / std::clamp(status_.description->rate, 1.0, 1e4);
    read_timeout_ = std::clamp(period, 1e-3, renders(*status_.description) ? 2e-3 : 10e-3);
    last_sample_ = now;
    command_number_ = number;
    command_time_ = now - options_.command_timeout;
    may_hold_force_ = true;  // an earlier user may have left a force
    rendering_ = false;
    status_.state = DeviceState::silent;
    if (!expects_samples()) {
        status_.state = DeviceState::usable;
        status_.fault_message.clear();
    }
    return true;
}

void DeviceSupervisor::close() {
    if (!device_) return;
    // An error means that the device is already lost.
    if (renders(*status_.description) && device_->write({})) ++status_.writes;
    device_.reset();
    status_.health = {};
    status_.state = DeviceState::absent;
}

void DeviceSupervisor::handle_loss(const Error& error) {
    ++status_.losses;
    status_.fault_message = error.message();
    device_.reset();
    status_.health = {};
    status_.state = DeviceState::absent;
    next_try_ = timer_.now() + retry_delay_;
}

Status DeviceSupervisor::write(const ForceCommand& requested, double now) {
    if (!renders(*status_.description)) return {};
    const bool is_new = requested.number != command_number_;
    if (is_new) {
        command_number_ = requested.number;
        command_time_ = now;
    }
    const bool stale = now - command_time_ >= options_.command_timeout;
    force::OutputCommand command;
    const bool is_finite = finite(requested.command.force) && finite(requested.command.torque);
    if (requested.enabled && !stale && is_finite)
        command = clamp_to_limits(*status_.description, requested.command);
    const bool forces = command.force != Vec3(0.0) || command.torque != Vec3(0.0);
    // A new command is written even if its force is unchanged: some devices drop the force when writes stop.
    if (!(forces && is_new) && !(!forces && may_hold_force_)) return {};
    if (stale && requested.enabled && rendering_) ++status_.command_timeouts;
    const double begun = timer_.now();
    BOLT_TRY(device_->write(command));
    const double taken = timer_.now() - begun;
    status_.write_time += taken;
    status_.longest_write = std::max(status_.longest_write, taken);
    ++status_.writes;
    may_hold_force_ = rendering_ = forces;
    return {};
}

void DeviceSupervisor::track_silence(bool received, double now) {
    if (received) {
        ++status_.samples;
        last_sample_ = now;
        // A successful opening does not reset the delay: some devices are lost at the first read or write.
        retry_delay_ = options_.first_retry_delay;
        status_.state = DeviceState::usable;
        status_.fault_message.clear();
        return;
    }
    if (!expects_samples() || now - last_sample_ < options_.max_silence) return;
    status_.state = DeviceState::silent;
    const std::string message = status_.description->name + " is connected but sends no valid samples";
    if (status_.fault_message != message) status_.fault_message = message;
    if (now - last_sample_ < options_.reopen_after) return;
    ++status_.silence_timeouts;
    close();
    next_try_ = now + retry_delay_;
}

std::optional<Sample> DeviceSupervisor::poll(FunctionRef<ForceCommand()> latest_command) {
    if (!device_) {
        const double now = timer_.now();
        if (now < next_try_) {
            timer_.wait(std::min(next_try_ - now, 5e-3));
            return {};
        }
        if (!try_open(latest_command().number)) return {};
    }
    Result<std::optional<Sample>> read = device_->read(read_timeout_);
    if (!read) {
        handle_loss(read.error());
        return {};
    }
    const double now = timer_.now();
    status_.health = device_->health();
    std::optional<Sample> sample = *read;
    if (sample && !is_valid(*sample)) {
        ++status_.malformed_samples;
        sample.reset();
    }
    if (Status written = write(latest_command(), now); !written) {
        handle_loss(written.error());
        return sample;
    }
    track_silence(sample.has_value(), now);
    return sample;
}

namespace {

constexpr double publish_interval = 0.1;  // s between two updates of the status if only counters have changed

// Returns true if the status must be published now.
bool changed(const DeviceStatus& now, const DeviceStatus& before) {
    return now.state != before.state || now.openings != before.openings || now.losses != before.losses ||
           now.fault_message != before.fault_message || now.preparation != before.preparation;
}

}  // namespace

void run_once(DeviceSupervisor& supervisor, DeviceMailboxes& mailboxes, DeviceSnapshot& snapshot) {
    const std::optional<Sample> sample = supervisor.poll([&] {
        mailboxes.commands.update();
        return mailboxes.commands.latest();
    });
    const DeviceStatus& status = supervisor.status();
    const bool usable = status.state == DeviceState::usable;
    if (!sample && usable == snapshot.usable && status.openings == snapshot.connection_number) return;
    snapshot.usable = usable;
    snapshot.connection_number = status.openings;
    if (sample) {
        snapshot.sample = *sample;
        ++snapshot.number;
    }
    mailboxes.snapshots.write(snapshot);
}

struct DeviceThread::Shared {
    Shared(DeviceFactory open, const DeviceThreadOptions& o)
        : options(o), supervisor(std::move(open), timer, o.supervisor) {}

    DeviceThreadOptions options;
    Timer timer = steady_timer();
    DeviceSupervisor supervisor;
    DeviceMailboxes mailboxes;
    std::uint64_t number = 0;                      // of commands; used by the servo thread
    std::atomic<double> last_return{timer.now()};  // s, time of the driver's last return
    std::jthread thread;

    void run(const std::stop_token& stop) {
        if (options.priority > 0) {
            sched_param parameters{};
            parameters.sched_priority = options.priority;
            // Errors are ignored: the servo's thread reports missing permission (servo/servo_thread.hpp).
            pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
        }
        DeviceSnapshot snapshot;
        DeviceStatus before;
        double published_at = 0.0;
        while (!stop.stop_requested()) {
            run_once(supervisor, mailboxes, snapshot);
            last_return.store(timer.now(), std::memory_order_relaxed);
            const DeviceStatus& now = supervisor.status();
            if (!changed(now, before) && timer.now() - published_at < publish_interval) continue;
            before = now;
            published_at = timer.now();
            mailboxes.statuses.write(now);
        }
        supervisor.close();
        mailboxes.statuses.write(supervisor.status());
    }
};

DeviceThread::DeviceThread(std::unique_ptr<Shared> shared) : shared_(std::move(shared)) {}
DeviceThread::DeviceThread(DeviceThread&&) noexcept = default;
DeviceThread& DeviceThread::operator=(DeviceThread&&) noexcept = default;
DeviceThread::~DeviceThread() = default;

Result<DeviceThread> DeviceThread::start(DeviceFactory open, const DeviceThreadOptions& options) {
    auto shared = std::make_unique<Shared>(std::move(open), options);
    try {
        shared->thread = std::jthread([s = shared.get()](const std::stop_token& stop) { s->run(stop); });
    } catch (const std::system_error& error) {
        return fail(ErrorCode::failed, fmt::format("cannot start the device thread: {}", error.what()),
                    "a system that permits another thread");
    }
    return DeviceThread(std::move(shared));
}

void DeviceThread::command(const force::OutputCommand& command, bool enabled) {
    shared_->mailboxes.commands.write({command, enabled, ++shared_->number});
}

const DeviceSnapshot& DeviceThread::snapshot() {
    shared_->mailboxes.snapshots.update();
    return shared_->mailboxes.snapshots.latest();
}

const DeviceStatus& DeviceThread::status() {
    shared_->mailboxes.statuses.update();
    return shared_->mailboxes.statuses.latest();
}

double DeviceThread::blocked_for() const {
    return shared_->timer.now() - shared_->last_return.load(std::memory_order_relaxed);
}

Result<std::shared_ptr<const Description>> DeviceThread::wait_until_open(
    double timeout, const PreparationHandler& on_preparation) {
    double until = shared_->timer.now() + timeout;
    while (status().openings == 0) {
        if (on_preparation) {
            const bool needs = status().preparation.need != DeviceNeed::none;
            const bool waits = on_preparation(status().preparation);
            if (!waits) until = 0.0;
            if (waits && needs) until = shared_->timer.now() + timeout;
        }
        if (shared_->timer.now() >= until) {
            if (!status().fault_message.empty()) {
                Error error;
                error.code = ErrorCode::no_device;
                error.what = status().fault_message;
                set_preparation(error, status().preparation);
                return fail(std::move(error));
            }
            return fail(ErrorCode::no_device, "the device does not open in time",
                        fmt::format("a connected device that opens within {:g} s", timeout));
        }
        shared_->timer.wait(5e-3);
    }
    if (on_preparation) (void)on_preparation({});
    return status().description;
}

}  // namespace bolt::device
