// Wheels and pucks: for any descriptor and reports the driver opens the device or returns an error, stays
// within the bounds of each report, and returns plausible angles and speeds.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>

#include "haptics/device/space_mouse.hpp"
#include "haptics/device/usb_force_feedback.hpp"
#include "haptics/device/wheel.hpp"
#include "tools/emulate/wheel.hpp"

namespace {

using namespace bolt;
using namespace bolt::device;

// Returns the input in pieces; the first byte of each gives its length.
class DeviceThread : public HidTransport {
  public:
    DeviceThread(std::span<const std::uint8_t>& left, double& time) : left_(left), time_(time) {}
    Result<std::span<const std::uint8_t>> read(double timeout) override {
        time_ += timeout;
        if (left_.empty()) return fail(ErrorCode::no_device, "the end", "samples");
        const std::size_t n = std::min<std::size_t>(left_[0] % 64, left_.size() - 1);
        const auto piece = left_.subspan(1, n);
        left_ = left_.subspan(1 + n);
        return piece;
    }
    Status write(std::span<const std::uint8_t> report) override {
        if (report.empty()) std::abort();
        return {};
    }
    Status send_feature(std::span<const std::uint8_t> report) override { return write(report); }
    Result<std::span<const std::uint8_t>> get_feature(std::span<std::uint8_t> report) override {
        const auto piece = read(0.0);
        if (!piece) return piece;
        const std::size_t n = std::min(piece->size(), report.size());
        std::copy_n(piece->begin(), n, report.begin());
        return std::span<const std::uint8_t>(report.data(), n);
    }

  private:
    std::span<const std::uint8_t>& left_;
    double& time_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 2) return 0;
    static const ReportDescriptor board = *parse_report_descriptor(emulate::board_descriptor());
    static const ReportDescriptor other = *parse_report_descriptor(emulate::generic_wheel_descriptor());
    std::span<const std::uint8_t> left(data + 1, size - 1);
    std::optional<ReportDescriptor> own;
    if (data[0] % 4 >= 2) {  // the input begins with a descriptor
        const std::size_t n = std::min<std::size_t>(left[0] * 2U, left.size() - 1);
        const auto parsed = parse_report_descriptor(left.subspan(1, n));
        left = left.subspan(1 + n);
        if (parsed) own = *parsed;
    }
    const ReportDescriptor& descriptor = own ? *own : data[0] % 2 == 0 ? board : other;

    double time = 0.0;
    const SecondsClock clock = [&] { return time; };
    const WheelConfig rig{.counts_per_turn = data[0] % 8 >= 4 ? 4000.0 : 0.0};
    auto line = std::make_unique<DeviceThread>(left, time);
    Result<std::unique_ptr<DeviceDriver>> device =
        data[0] % 3 == 0   ? make_space_mouse(std::move(line), descriptor, "puck", "1", {}, clock)
        : data[0] % 3 == 1 ? make_wheel(std::move(line), descriptor, "wheel", "1", rig, clock)
                           : make_open_ffboard(std::move(line), descriptor, "board", "1", rig, clock);
    if (!device) {
        if (device.error().message().empty()) std::abort();
        return 0;
    }
    const double most = std::max((*device)->description().limits.torque, 1.0);
    while (true) {
        const auto sample = (*device)->read(0.002);
        if (!sample) break;
        time += 0.0001;
        if (*sample) {
            const Sample& s = **sample;
            if (!std::isfinite(s.angle) || glm::length(s.velocity) > 1.0 ||
                glm::length(s.angular_velocity) > 4.0)
                std::abort();
            if (rig.counts_per_turn == 0.0 && std::abs(s.angle) > 600.0) std::abort();
            if (!(*device)->write({.torque = Vec3(0.0, 0.0, most * std::sin(s.angle))})) std::abort();
        }
    }
    return 0;
}
