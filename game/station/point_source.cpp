#include "game/station/point_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace bolt::station_setup {

namespace {

constexpr double touch_period = 1e-3;  // s

}  // namespace

Result<std::vector<PointPair>> measure_points(PointSource& source, std::span<const Vec3> targets) {
    std::vector<PointPair> pairs;
    for (std::size_t i = 0; i < targets.size(); ++i) {
        BOLT_TRY_ASSIGN(const Vec3 measured, source.measure(i, targets.size(), targets[i]));
        pairs.push_back({measured, targets[i]});
    }
    return pairs;
}

Result<Vec3> average_touch(std::span<const Vec3> positions, const TouchOptions& options) {
    if (positions.size() < options.min_samples)
        return fail(ErrorCode::failed, fmt::format("the device sent {} positions", positions.size()),
                    fmt::format("at least {}", options.min_samples));
    Vec3 mean(0.0);
    for (const Vec3& position : positions) mean += position / static_cast<double>(positions.size());
    double motion = 0.0;
    for (const Vec3& position : positions) motion = std::max(motion, glm::length(position - mean));
    if (!finite(mean))
        return fail(ErrorCode::failed, "the device sent an invalid position", "finite positions");
    if (motion > options.max_motion)
        return fail(ErrorCode::failed, fmt::format("the hand moved by {:.1f} mm", motion / mm),
                    fmt::format("at most {:.1f} mm", options.max_motion / mm));
    return mean;
}

ArmTip::ArmTip(TouchIo io, const Vec3& tip, const TouchOptions& options)
    : io_(std::move(io)), tip_(tip), options_(options), sample_time_(io_.timer.now()) {}

// Waits for one polling period, then returns the latest snapshot, new or not.
Result<device::DeviceSnapshot> ArmTip::next_snapshot() {
    io_.timer.wait(touch_period);
    if (io_.stop()) return fail(ErrorCode::failed, "the registration was interrupted", {});
    device::DeviceSnapshot snapshot = io_.snapshot();
    const double now = io_.timer.now();
    if (snapshot.usable && snapshot.number != sample_) sample_time_ = now;
    if (now - sample_time_ > options_.max_silence)
        return fail(ErrorCode::no_device, "the arm sends no positions", "an arm that stays connected");
    return snapshot;
}

Status ArmTip::wait_for_press() {
    (void)io_.confirmed();  // an earlier press of Enter does not count
    buttons_ = ~0U;         // a button that is already held does not count
    while (true) {
        BOLT_TRY_ASSIGN(const device::DeviceSnapshot snapshot, next_snapshot());
        const bool fresh = snapshot.usable && snapshot.number != sample_;
        sample_ = snapshot.number;
        const std::uint32_t pressed = fresh ? snapshot.sample.buttons & ~buttons_ : 0;
        if (fresh) buttons_ = snapshot.sample.buttons;
        if (pressed != 0 || io_.confirmed()) return {};
    }
}

Result<std::vector<Vec3>> ArmTip::positions() {
    std::vector<Vec3> positions;
    for (const double end = io_.timer.now() + options_.duration; io_.timer.now() < end;) {
        BOLT_TRY_ASSIGN(const device::DeviceSnapshot snapshot, next_snapshot());
        if (!snapshot.usable || snapshot.number == sample_) continue;
        sample_ = snapshot.number;
        buttons_ = snapshot.sample.buttons;
        positions.push_back(snapshot.sample.pose * tip_);
    }
    return positions;
}

Result<Vec3> ArmTip::measure(std::size_t number, std::size_t count, const Vec3& target) {
    return touch(number,
                 fmt::format("Point {} of {}: touch ({:.3f}, {:.3f}, {:.3f}) m, hold still, and press "
                             "a button of the arm or Enter.",
                             number + 1, count, target.x, target.y, target.z));
}

Result<Vec3> ArmTip::touch(std::size_t number, std::string_view request) {
    sample_time_ = io_.timer.now();  // samples were not read between two points
    while (true) {
        io_.show(request);
        BOLT_TRY(wait_for_press());
        BOLT_TRY_ASSIGN(const std::vector<Vec3> touched, positions());
        Result<Vec3> mean = average_touch(touched, options_);
        if (mean) {
            io_.show(fmt::format("Point {}: measured.", number + 1));
            return mean;
        }
        io_.show(fmt::format("Point {}: {}. Once more.", number + 1, mean.error().message()));
    }
}

}  // namespace bolt::station_setup
