#include "haptics/device/line.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>

#include <system_error>
#include <thread>

namespace bolt::device {

namespace {

constexpr double tell_every = 0.1;  // s between two reports of nothing but counts

// Whether somebody who looks has to hear of it now.
bool changed(const Report& now, const Report& before) {
    return now.state != before.state || now.openings != before.openings || now.losses != before.losses ||
           now.trouble != before.trouble;
}

}  // namespace

void serve(Keeper& keeper, Mailboxes& boxes, Told& told) {
    const std::optional<Sample> sample = keeper.turn([&] {
        boxes.orders.update();
        return boxes.orders.latest();
    });
    const Report& report = keeper.report();
    const bool usable = report.state == State::usable;
    if (!sample && usable == told.usable && report.openings == told.opening) return;
    told.usable = usable;
    told.opening = report.openings;
    if (sample) {
        told.sample = *sample;
        ++told.number;
    }
    boxes.told.write(told);
}

struct Line::Shared {
    Shared(Open open, const LineOptions& o) : options(o), keeper(std::move(open), timer, o.keeper) {}

    LineOptions options;
    Timer timer = steady_timer();
    Keeper keeper;
    Mailboxes boxes;
    std::uint64_t number = 0;               // of orders; the servo's
    std::atomic<double> back{timer.now()};  // s, from the device
    std::jthread thread;

    void run(const std::stop_token& stop) {
        if (options.priority > 0) {
            sched_param wanted{};
            wanted.sched_priority = options.priority;
            // Where it is not allowed the servo's thread says so (servo/thread.hpp).
            pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted);
        }
        Told told;
        Report before;
        double told_at = 0.0;
        while (!stop.stop_requested()) {
            serve(keeper, boxes, told);
            back.store(timer.now(), std::memory_order_relaxed);
            const Report& now = keeper.report();
            if (!changed(now, before) && timer.now() - told_at < tell_every) continue;
            before = now;
            told_at = timer.now();
            boxes.reports.write(now);
        }
        keeper.close();
        boxes.reports.write(keeper.report());
    }
};

Line::Line(std::unique_ptr<Shared> shared) : shared_(std::move(shared)) {}
Line::Line(Line&&) noexcept = default;
Line& Line::operator=(Line&&) noexcept = default;
Line::~Line() = default;

Result<Line> Line::start(Open open, const LineOptions& options) {
    auto shared = std::make_unique<Shared>(std::move(open), options);
    try {
        shared->thread = std::jthread([s = shared.get()](const std::stop_token& stop) { s->run(stop); });
    } catch (const std::system_error& error) {
        return fail(ErrorCode::failed, fmt::format("a device's thread does not start: {}", error.what()));
    }
    return Line(std::move(shared));
}

void Line::order(const force::OutputCommand& command, bool enabled) {
    shared_->boxes.orders.write({command, enabled, ++shared_->number});
}

const Told& Line::told() {
    shared_->boxes.told.update();
    return shared_->boxes.told.latest();
}

const Report& Line::report() {
    shared_->boxes.reports.update();
    return shared_->boxes.reports.latest();
}

double Line::away() const { return shared_->timer.now() - shared_->back.load(std::memory_order_relaxed); }

Result<std::shared_ptr<const Description>> Line::await(double patience) {
    const double until = shared_->timer.now() + patience;
    while (report().openings == 0) {
        if (shared_->timer.now() >= until)
            return fail(ErrorCode::no_device,
                        report().trouble.empty() ? "the device does not open in time" : report().trouble);
        shared_->timer.wait(5e-3);
    }
    return report().description;
}

}  // namespace bolt::device
