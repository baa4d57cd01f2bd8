#include "tools/emulate/hid_device.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/input.h>
#include <linux/uhid.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <thread>

#include "haptics/device/hid_transport.hpp"

namespace bolt::emulate {

std::vector<Bytes> with_faults(std::vector<Bytes> reports, const HidFaults& faults, Random& random) {
    for (Bytes& report : reports) {
        if (report.size() > 1 && random.chance(faults.truncated))
            report.resize(1 + random.bits() % (report.size() - 1));
        if (random.chance(faults.unknown_id)) report[0] = 0x77;
        if (report.size() > 1 && random.chance(faults.changed))
            report[1 + random.bits() % (report.size() - 1)] = static_cast<std::uint8_t>(random.bits());
    }
    return reports;
}

namespace {

constexpr double mechanics_step = 0.00025;  // s
constexpr std::size_t queue_limit = 64;  // reports that the kernel queues for a reader; later ones are lost

tl::unexpected<Error> unplugged_error() {
    Error error;
    error.code = ErrorCode::no_device;
    error.what = "the emulated device was unplugged";
    error.expected = "a connected one";
    error.lost = true;
    return fail(std::move(error));
}

}  // namespace

Result<std::span<const std::uint8_t>> EmulatedTransport::read(double timeout) {
    const double until = link_.time + timeout;
    while (true) {
        if (link_.unplugged) return unplugged_error();
        for (Bytes& report : link_.device->advance(link_.time))
            if (queue_.size() < queue_limit) queue_.push_back(std::move(report));
        if (!queue_.empty() || link_.time >= until) break;
        link_.time = std::min(link_.time + mechanics_step, until);
    }
    if (queue_.empty()) return std::span<const std::uint8_t>();
    read_ = std::move(queue_.front());
    queue_.pop_front();
    return std::span<const std::uint8_t>(read_);
}

Status EmulatedTransport::write(std::span<const std::uint8_t> report) {
    link_.time += link_.write_duration;
    if (link_.unplugged) return unplugged_error();
    link_.device->output(report);
    return {};
}

Status EmulatedTransport::send_feature(std::span<const std::uint8_t> report) {
    if (link_.unplugged) return unplugged_error();
    link_.device->set_feature(report);
    return {};
}

Result<std::span<const std::uint8_t>> EmulatedTransport::get_feature(std::span<std::uint8_t> report) {
    if (link_.unplugged) return unplugged_error();
    const Bytes answer = link_.device->get_feature(report[0]);
    if (answer.empty())
        return fail(ErrorCode::no_device, "the emulated device refuses the feature report",
                    "a report that it knows");
    const std::size_t n = std::min(answer.size(), report.size());
    std::copy_n(answer.begin(), n, report.begin());
    return std::span<const std::uint8_t>(report.data(), n);
}

namespace {

void copy_text(std::span<std::uint8_t> to, const std::string& from) {
    const std::size_t n = std::min(to.size() - 1, from.size());
    std::copy_n(from.begin(), n, to.begin());
}

}  // namespace

struct Uhid::Shared {
    std::unique_ptr<HidDevice> device;
    int file = -1;
    std::mutex mutex;
    std::atomic<bool> stop{false};
    std::thread thread;

    ~Shared() {
        stop = true;
        if (thread.joinable()) thread.join();
        if (file >= 0) close(file);  // the kernel then removes the device
    }

    [[nodiscard]] bool send(const uhid_event& event) const {
        return ::write(file, &event, sizeof event) == static_cast<ssize_t>(sizeof event);
    }

    void play() {
        while (!stop) {
            pollfd wait{file, POLLIN, 0};
            poll(&wait, 1, 1);
            const std::lock_guard lock(mutex);
            uhid_event event{};
            while (::read(file, &event, sizeof event) > 0) {
                handle(event);
                event = {};
            }
            for (const Bytes& report : device->advance(steady_seconds())) {
                uhid_event in{};
                in.type = UHID_INPUT2;
                in.u.input2.size = static_cast<std::uint16_t>(report.size());
                std::copy(report.begin(), report.end(), in.u.input2.data);
                if (!send(in)) return;
            }
        }
    }

    void handle(const uhid_event& event) const {
        const auto acknowledge = [&](std::uint32_t id) {
            uhid_event reply{};
            reply.type = UHID_SET_REPORT_REPLY;
            reply.u.set_report_reply.id = id;
            static_cast<void>(send(reply));
        };
        if (event.type == UHID_OUTPUT) {
            const auto& o = event.u.output;
            const std::span report(o.data, std::min<std::size_t>(o.size, UHID_DATA_MAX));
            o.rtype == UHID_FEATURE_REPORT ? device->set_feature(report) : device->output(report);
        } else if (event.type == UHID_SET_REPORT) {
            const auto& s = event.u.set_report;
            const std::span report(s.data, std::min<std::size_t>(s.size, UHID_DATA_MAX));
            s.rtype == UHID_FEATURE_REPORT ? device->set_feature(report) : device->output(report);
            acknowledge(s.id);
        } else if (event.type == UHID_GET_REPORT) {
            const Bytes answer = event.u.get_report.rtype == UHID_FEATURE_REPORT
                                     ? device->get_feature(event.u.get_report.rnum)
                                     : Bytes{};
            uhid_event reply{};
            reply.type = UHID_GET_REPORT_REPLY;
            auto& r = reply.u.get_report_reply;
            r.id = event.u.get_report.id;
            r.err = answer.empty() ? EIO : 0;
            r.size = static_cast<std::uint16_t>(answer.size());
            std::copy(answer.begin(), answer.end(), r.data);
            static_cast<void>(send(reply));
        }
    }
};

Uhid::Uhid(std::unique_ptr<Shared> shared) : shared_(std::move(shared)) {}
Uhid::Uhid(Uhid&&) noexcept = default;
Uhid& Uhid::operator=(Uhid&&) noexcept = default;
Uhid::~Uhid() = default;

void Uhid::with(const std::function<void(HidDevice&)>& access) const {
    const std::lock_guard lock(shared_->mutex);
    access(*shared_->device);
}

Result<Uhid> Uhid::plug_in(std::unique_ptr<HidDevice> device) {
    auto shared = std::make_unique<Shared>();
    shared->device = std::move(device);
    shared->file = ::open("/dev/uhid", O_RDWR | O_CLOEXEC | O_NONBLOCK);
    if (shared->file < 0)
        return fail(ErrorCode::no_device, fmt::format("/dev/uhid: cannot open: {}", std::strerror(errno)),
                    "root rights and the kernel's module uhid");
    const HidDescription& description = shared->device->description();
    uhid_event create{};
    create.type = UHID_CREATE2;
    auto& c = create.u.create2;
    copy_text(c.name, description.name);
    copy_text(c.uniq, description.serial);
    if (description.descriptor.size() > HID_MAX_DESCRIPTOR_SIZE)
        return fail(ErrorCode::failed, "the report descriptor is too long",
                    fmt::format("at most {} bytes", HID_MAX_DESCRIPTOR_SIZE));
    c.rd_size = static_cast<std::uint16_t>(description.descriptor.size());
    std::copy(description.descriptor.begin(), description.descriptor.end(), c.rd_data);
    c.bus = BUS_USB;
    c.vendor = description.vendor;
    c.product = description.product;
    if (!shared->send(create))
        return fail(ErrorCode::failed,
                    fmt::format("/dev/uhid: cannot create the device: {}", std::strerror(errno)),
                    "the permission to write to it, and a free device");
    shared->thread = std::thread([s = shared.get()] { s->play(); });
    return Uhid(std::move(shared));
}

}  // namespace bolt::emulate
