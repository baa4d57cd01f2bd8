// The latency of a report from the device to its reader, and of a command to the device. The guest's clock
// counts instructions, so the result does not depend on the speed of this machine.
#include <algorithm>
#include <array>
#include <atomic>

#include "haptics/device/hid_transport.hpp"
#include "tests/kernel/guest.hpp"
#include "tools/emulate/puck.hpp"
#include "tools/emulate/wheel.hpp"

using namespace bolt;
using namespace bolt::device;
using namespace bolt::test;

namespace {

constexpr std::size_t reports = 1000;

struct Times {
    std::array<std::atomic<double>, reports> sent{};
    std::array<std::atomic<double>, reports> received{};
};

// A device that sends a numbered report every millisecond, the rate of the fastest supported devices.
class Metronome : public emulate::HidDevice {
  public:
    explicit Metronome(Times& times) : times_(times) {
        description_ = {0x1209, 0xffb0, "Metronome", "", emulate::board_descriptor()};
    }
    [[nodiscard]] const emulate::HidDescription& description() const override { return description_; }
    std::vector<emulate::Bytes> advance(double now) override {
        if (now < next_ || number_ == reports) return {};
        next_ = now + 0.0009;
        emulate::Bytes report(25);
        report[0] = 1;
        report[1] = static_cast<std::uint8_t>(number_);
        report[2] = static_cast<std::uint8_t>(number_ >> 8U);
        times_.sent[number_++] = steady_seconds();
        return {report};
    }
    void output(std::span<const std::uint8_t> report) override {
        const std::size_t n = report[1] | static_cast<std::size_t>(report[2]) << 8U;
        if (n < reports) times_.received[n] = steady_seconds();
    }
    void set_feature(std::span<const std::uint8_t>) override {}
    emulate::Bytes get_feature(std::uint8_t) override { return {}; }

  private:
    Times& times_;
    emulate::HidDescription description_;
    std::size_t number_ = 0;
    double next_ = 0.0;
};

void print_latency(const std::string& what, std::vector<double>& latencies) {
    std::sort(latencies.begin(), latencies.end());
    const auto at = [&](double share) {
        return latencies[static_cast<std::size_t>(share * static_cast<double>(latencies.size() - 1))] * 1e3;
    };
    MESSAGE(what << ": p50 " << at(0.5) << " ms, p99 " << at(0.99) << " ms, worst " << at(1.0) << " ms of "
                 << latencies.size());
}

}  // namespace

TEST_CASE("Kernel: reports and commands pass within one device period") {
    Times times;
    const auto plug = attach(std::make_unique<Metronome>(times));
    const ListedDevice l = wait_for_device("1209:ffb0");
    auto transport = open_hid(l.path);
    REQUIRE(transport);
    std::vector<double> reads, writes, round_trips;
    std::size_t last = 0;
    while (last + 1 < reports) {
        const auto report = (*transport)->read(0.5);
        REQUIRE(report);
        REQUIRE(!report->empty());
        const double now = steady_seconds();
        last = (*report)[1] | static_cast<std::size_t>((*report)[2]) << 8U;
        reads.push_back(now - times.sent[last]);
        emulate::Bytes command(4);
        command[0] = 5;
        command[1] = (*report)[1];
        command[2] = (*report)[2];
        REQUIRE((*transport)->write(command));
        writes.push_back(steady_seconds() - now);
    }
    CHECK(reads.size() > reports / 2);
    CHECK(holds_within([&] { return times.received[last] > 0.0; }));
    for (std::size_t i = 0; i < reports; ++i)
        if (times.received[i] > 0.0) round_trips.push_back(times.received[i] - times.sent[i]);
    print_latency("from the device to the reader", reads);
    print_latency("a write", writes);
    print_latency("from the device to the reader and back", round_trips);
    CHECK(reads[reads.size() / 2] < 0.001);
    CHECK(reads[reads.size() * 99 / 100] < 0.001);
    CHECK(round_trips.size() > reports / 2);
}
