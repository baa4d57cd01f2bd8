#include "haptics/device/device_thread.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>

#include <system_error>
#include <thread>

namespace bolt::device {

namespace {

constexpr double tell_every = 0.1;  // s between two reports of nothing but counts

// True if the report must be published now.
bool changed(const DeviceReport& now, const DeviceReport& before) {
    return now.state != before.state || now.openings != before.openings || now.losses != before.losses ||
           now.trouble != before.trouble;
}

}  // namespace

void run_once(DeviceSupervisor& supervisor, DeviceMailboxes& mailboxes, DeviceSnapshot& snapshot) {
    const std::optional<Sample> sample = supervisor.poll([&] {
        mailboxes.commands.update();
        return mailboxes.commands.latest();
    });
    const DeviceReport& report = supervisor.report();
    const bool usable = report.state == DeviceState::usable;
    if (!sample && usable == snapshot.usable && report.openings == snapshot.opening) return;
    snapshot.usable = usable;
    snapshot.opening = report.openings;
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
    std::uint64_t number = 0;               // of orders; the servo's
    std::atomic<double> back{timer.now()};  // s, from the device
    std::jthread thread;

    void run(const std::stop_token& stop) {
        if (options.priority > 0) {
            sched_param wanted{};
            wanted.sched_priority = options.priority;
            // Errors are ignored: the servo's thread reports missing permission (servo/thread.hpp).
            pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted);
        }
        DeviceSnapshot snapshot;
        DeviceReport before;
        double told_at = 0.0;
        while (!stop.stop_requested()) {
            run_once(supervisor, mailboxes, snapshot);
            back.store(timer.now(), std::memory_order_relaxed);
            const DeviceReport& now = supervisor.report();
            if (!changed(now, before) && timer.now() - told_at < tell_every) continue;
            before = now;
            told_at = timer.now();
            mailboxes.reports.write(now);
        }
        supervisor.close();
        mailboxes.reports.write(supervisor.report());
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
        return fail(ErrorCode::failed, fmt::format("cannot start the device thread: {}", error.what()));
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

const DeviceReport& DeviceThread::report() {
    shared_->mailboxes.reports.update();
    return shared_->mailboxes.reports.latest();
}

double DeviceThread::blocked_for() const {
    return shared_->timer.now() - shared_->back.load(std::memory_order_relaxed);
}

Result<std::shared_ptr<const Description>> DeviceThread::wait_until_open(double timeout) {
    const double until = shared_->timer.now() + timeout;
    while (report().openings == 0) {
        if (shared_->timer.now() >= until)
            return fail(ErrorCode::no_device,
                        report().trouble.empty() ? "the device does not open in time" : report().trouble);
        shared_->timer.wait(5e-3);
    }
    return report().description;
}

}  // namespace bolt::device
