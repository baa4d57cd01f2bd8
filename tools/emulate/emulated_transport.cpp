#include "tools/emulate/emulated_transport.hpp"

#include <algorithm>

namespace bolt::emulate {

namespace {

constexpr double step = 0.00025;          // s
constexpr std::size_t most_waiting = 64;  // reports that the kernel keeps for a reader; later ones are lost

tl::unexpected<Error> gone() {
    Error error;
    error.code = ErrorCode::no_device;
    error.what = "the emulated device was unplugged";
    error.lost = true;
    return fail(std::move(error));
}

}  // namespace

Result<std::span<const std::uint8_t>> EmulatedTransport::read(double timeout) {
    const double until = plug_.time + timeout;
    while (true) {
        if (plug_.pulled) return gone();
        for (Bytes& report : plug_.device->advance(plug_.time))
            if (waiting_.size() < most_waiting) waiting_.push_back(std::move(report));
        if (!waiting_.empty() || plug_.time >= until) break;
        plug_.time = std::min(plug_.time + step, until);
    }
    if (waiting_.empty()) return std::span<const std::uint8_t>();
    read_ = std::move(waiting_.front());
    waiting_.pop_front();
    return std::span<const std::uint8_t>(read_);
}

Status EmulatedTransport::write(std::span<const std::uint8_t> report) {
    plug_.time += plug_.write_takes;
    if (plug_.pulled) return gone();
    plug_.device->output(report);
    return {};
}

Status EmulatedTransport::send_feature(std::span<const std::uint8_t> report) {
    if (plug_.pulled) return gone();
    plug_.device->set_feature(report);
    return {};
}

Result<std::span<const std::uint8_t>> EmulatedTransport::get_feature(std::span<std::uint8_t> report) {
    if (plug_.pulled) return gone();
    const Bytes answer = plug_.device->get_feature(report[0]);
    if (answer.empty()) return fail(ErrorCode::no_device, "the emulated device refuses");
    const std::size_t n = std::min(answer.size(), report.size());
    std::copy_n(answer.begin(), n, report.begin());
    return std::span<const std::uint8_t>(report.data(), n);
}

}  // namespace bolt::emulate
