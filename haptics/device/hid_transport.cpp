#include "haptics/device/hid_transport.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <hidapi.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>

namespace bolt::device {

namespace {

constexpr std::size_t max_report_size = 4096;

constexpr const char* permission_remedy =
    "the udev rule: sudo cp tools/udev/60-boltwright.rules /etc/udev/rules.d/ && "
    "sudo udevadm control --reload, then plug it in again";

struct HidClose {
    void operator()(hid_device* device) const { hid_close(device); }
};

std::string hidapi_error(hid_device* device) {
    const wchar_t* wide = hid_error(device);
    std::string narrow;
    for (; wide != nullptr && *wide != 0; ++wide) narrow += *wide < 128 ? static_cast<char>(*wide) : '?';
    return narrow;
}

class HidapiTransport : public HidTransport {
  public:
    HidapiTransport(hid_device* device, std::string path) : device_(device), path_(std::move(path)) {}

    Result<std::span<const std::uint8_t>> read(double timeout) override {
        const int ms = static_cast<int>(std::ceil(std::clamp(timeout, 0.0, 1e6) * 1e3));
        errno = 0;
        const int n = hid_read_timeout(device_.get(), read_.data(), read_.size(), ms);
        if (n < 0 && errno == EINTR)
            return std::span<const std::uint8_t>();  // interrupted by a signal; the device is not lost
        if (n < 0) return device_lost("read from");
        return std::span<const std::uint8_t>(read_.data(), static_cast<std::size_t>(n));
    }

    Status write(std::span<const std::uint8_t> report) override {
        if (hid_write(device_.get(), report.data(), report.size()) < 0) return device_lost("write to");
        return {};
    }

    Status send_feature(std::span<const std::uint8_t> report) override {
        if (hid_send_feature_report(device_.get(), report.data(), report.size()) < 0)
            return device_lost("send a feature report to");
        return {};
    }

    Result<std::span<const std::uint8_t>> get_feature(std::span<std::uint8_t> report) override {
        const int n = hid_get_feature_report(device_.get(), report.data(), report.size());
        if (n < 0) return device_lost("get a feature report from");
        return std::span<const std::uint8_t>(report.data(),
                                             std::min(report.size(), static_cast<std::size_t>(n)));
    }

  private:
    [[nodiscard]] tl::unexpected<Error> device_lost(const char* what) const {
        Error error;
        error.code = ErrorCode::no_device;
        error.what = fmt::format("cannot {} {}: {}", what, path_, hidapi_error(device_.get()));
        error.expected = "a device that stays connected";
        error.lost = true;
        return fail(std::move(error));
    }

    std::unique_ptr<hid_device, HidClose> device_;
    std::string path_;
    std::array<std::uint8_t, max_report_size> read_{};
};

}  // namespace

std::mutex& hidapi_lock() {
    static std::mutex lock;
    return lock;
}

Status can_open_hid(const std::filesystem::path& node) {
    const int file = ::open(node.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (file >= 0) {
        ::close(file);
        return {};
    }
    const int why = errno;
    Error error;
    error.code = ErrorCode::no_device;
    error.what = fmt::format("cannot open {}: {}", node.string(), std::strerror(why));
    error.expected = "a device that can be opened";
    if (why == EACCES || why == EPERM)
        error.expected = permission_remedy;
    else if (why == ENOENT || why == ENODEV || why == ENXIO) {
        error.expected = "a connected device";
        error.lost = true;
    } else if (why == EBUSY)
        error.expected = "a device that no other program has opened exclusively";
    return fail(std::move(error));
}

Result<std::unique_ptr<HidTransport>> open_hid(const std::filesystem::path& node) {
    BOLT_TRY(can_open_hid(node));
    const std::lock_guard lock(hidapi_lock());
    hid_device* device = hid_open_path(node.c_str());
    if (device == nullptr)
        return fail(ErrorCode::no_device,
                    fmt::format("cannot open {}: {}", node.string(), hidapi_error(nullptr)),
                    "a connected device");
    return std::make_unique<HidapiTransport>(device, node.string());
}

Result<std::vector<std::uint8_t>> descriptor_of(const std::filesystem::path& node) {
    const auto path =
        std::filesystem::path("/sys/class/hidraw") / node.filename() / "device/report_descriptor";
    std::ifstream file(path, std::ios::binary);
    std::vector<std::uint8_t> bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    if (bytes.empty()) {
        Error error;
        error.code = ErrorCode::no_device;
        error.what = fmt::format("{} has no report descriptor", node.string());
        error.expected = "a connected device";
        error.lost = true;
        return fail(std::move(error));
    }
    return bytes;
}

}  // namespace bolt::device
