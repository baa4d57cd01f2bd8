#include "haptics/device/connected_devices.hpp"

#include <fmt/format.h>
#include <hidapi.h>

#include <algorithm>
#include <map>

#include "haptics/device/arms.hpp"
#include "haptics/device/hid_transport.hpp"
#include "haptics/device/plugin_arms.hpp"
#include "haptics/device/space_mouse.hpp"
#include "haptics/device/usb_force_feedback.hpp"
#include "haptics/device/wheel.hpp"

namespace bolt::device {

namespace {

constexpr Usage multi_axis_controller{0x01, 0x08};
constexpr std::uint16_t force_page = 0x0f;
constexpr std::uint16_t board_vendor = 0x1209, board_product = 0xffb0;  // pid.codes, OpenFFBoard

std::string utf8(const wchar_t* wide) {
    std::string out;
    for (; wide != nullptr && *wide != 0; ++wide) {
        const auto c = static_cast<std::uint32_t>(*wide);
        if (c < 0x80) {
            // No control characters, because names are printed on terminals.
            if (c >= 0x20 && c != 0x7f) out += static_cast<char>(c);
        } else if (c < 0x800) {
            out += static_cast<char>(0xc0 | c >> 6U);
            out += static_cast<char>(0x80 | (c & 0x3fU));
        } else if (c < 0x10000) {
            out += static_cast<char>(0xe0 | c >> 12U);
            out += static_cast<char>(0x80 | (c >> 6U & 0x3fU));
            out += static_cast<char>(0x80 | (c & 0x3fU));
        }
    }
    return out;
}

struct HidNode {
    HidIdentity identity;
    std::string path;
};

// One entry per node; hidapi lists one per collection of a device.
std::vector<HidNode> enumerate_nodes() {
    std::vector<HidNode> out;
    const std::lock_guard lock(hidapi_lock());
    hid_device_info* first = hid_enumerate(0, 0);
    for (const hid_device_info* d = first; d != nullptr; d = d->next) {
        if (d->path == nullptr) continue;
        if (std::any_of(out.begin(), out.end(), [&](const HidNode& s) { return s.path == d->path; }))
            continue;
        out.push_back(
            {{d->vendor_id, d->product_id, utf8(d->product_string), utf8(d->serial_number)}, d->path});
    }
    hid_free_enumeration(first);
    // Natural order: hidraw10 after hidraw9.
    std::sort(out.begin(), out.end(), [](const HidNode& a, const HidNode& b) {
        return std::pair(a.path.size(), a.path) < std::pair(b.path.size(), b.path);
    });
    return out;
}

// Identifies pucks by vendor and product if the descriptor cannot be read: 3Dconnexion, also under Logitech's
// name.
DeviceKind kind_by_number(const HidIdentity& identity) {
    if (identity.vendor == board_vendor && identity.product == board_product) return DeviceKind::open_ffboard;
    const bool logitech =
        identity.vendor == 0x046d && identity.product >= 0xc603 && identity.product <= 0xc62b;
    return identity.vendor == 0x256f || logitech ? DeviceKind::puck : DeviceKind::other;
}

Status check_driver_support(DeviceKind kind, const ReportDescriptor& descriptor) {
    if (kind == DeviceKind::puck) {
        BOLT_TRY(six_axis_layout(descriptor));
    } else if (kind == DeviceKind::open_ffboard || kind == DeviceKind::wheel) {
        BOLT_TRY(wheel_axis(descriptor));
        BOLT_TRY(force_feedback_layout(descriptor));
    }
    return {};
}

ListedDevice listed(const HidNode& one) {
    ListedDevice device;
    device.path = one.path;
    device.id = id_of(one.identity);
    device.name = one.identity.name.empty() ? device.id : one.identity.name;
    const auto bytes = descriptor_of(one.path);
    if (!bytes) {
        device.error = bytes.error();
        return device;
    }
    const auto descriptor = parse_report_descriptor(*bytes);
    if (!descriptor) {
        device.kind = kind_by_number(one.identity);
        device.error = descriptor.error();
        return device;
    }
    device.kind = kind_of(one.identity, *descriptor);
    if (device.kind == DeviceKind::other) return device;
    if (Status support = check_driver_support(device.kind, *descriptor); !support) {
        device.error = support.error();
    } else if (Status access = can_open_hid(one.path); !access) {
        device.error = access.error();
        if (device.kind == DeviceKind::wheel && !device.error->lost)
            device.error->expected +=
                fmt::format(", with the additional line {} for this wheel", udev_rule(one.identity));
    }
    return device;
}

std::vector<ListedDevice> list_arms() {
    std::vector<ListedDevice> arms;
    for (const ArmBackend& backend : arm_backends())
        for (ListedDevice& arm : backend.list()) arms.push_back(std::move(arm));
    return arms;
}

Result<std::unique_ptr<DeviceDriver>> open_arm(const ListedDevice& listed, const OpenOptions& options) {
    // Also true for NaN.
    if (!(options.effector_mass >= 0.0 && options.effector_mass <= max_effector_mass))
        return fail(
            ErrorCode::usage,
            fmt::format("the mass that is mounted on {} is {:g} kg", listed.id, options.effector_mass),
            fmt::format("0 to {:g} kg", max_effector_mass));
    for (const ArmBackend& backend : arm_backends())
        if (listed.id.starts_with(std::string(backend.name) + ':')) return backend.open(listed, options);
    return fail(ErrorCode::no_device, fmt::format("{} is not an arm that can be opened", listed.id),
                "one that `boltwright devices` lists");
}

}  // namespace

DeviceKind kind_of(const HidIdentity& identity, const ReportDescriptor& descriptor) {
    if (identity.vendor == board_vendor && identity.product == board_product) return DeviceKind::open_ffboard;
    for (const Collection& c : descriptor.collections)
        if (c.usage == multi_axis_controller) return DeviceKind::puck;
    for (const ReportField& f : descriptor.fields)
        if (f.usage.page == force_page && f.kind != ReportKind::input) return DeviceKind::wheel;
    return DeviceKind::other;
}

std::string id_of(const HidIdentity& identity) {
    std::string id = fmt::format("{:04x}:{:04x}", identity.vendor, identity.product);
    if (!identity.serial.empty()) id += ':' + identity.serial;
    return id;
}

std::string udev_rule(const HidIdentity& identity) {
    return fmt::format(R"(KERNEL=="hidraw*", KERNELS=="*:{:04X}:{:04X}.*", TAG+="uaccess")", identity.vendor,
                       identity.product);
}

std::vector<ListedDevice> list_devices(bool others) {
    std::vector<ListedDevice> out = list_arms();
    for (const HidNode& one : enumerate_nodes()) out.push_back(listed(one));
    // Omits devices that were disconnected in the meantime.
    std::erase_if(out, [](const ListedDevice& device) { return device.error && device.error->lost; });
    // Supported devices first, so that their ids do not depend on `others`: a puck's receiver is also a
    // keyboard.
    const auto is_other = [](const ListedDevice& device) { return device.kind == DeviceKind::other; };
    std::stable_partition(out.begin(), out.end(),
                          [&](const ListedDevice& device) { return !is_other(device); });
    if (!others) std::erase_if(out, is_other);
    std::map<std::string, int> id_counts;
    for (ListedDevice& device : out)
        if (const int n = ++id_counts[device.id]; n > 1) device.id += fmt::format("#{}", n);
    return out;
}

Result<std::unique_ptr<DeviceDriver>> open(const ListedDevice& listed, const OpenOptions& options) {
    if (listed.error) return fail(*listed.error);
    if (listed.kind == DeviceKind::arm) return open_arm(listed, options);
    BOLT_TRY_ASSIGN(const auto bytes, descriptor_of(listed.path));
    BOLT_TRY_ASSIGN(const auto descriptor, parse_report_descriptor(bytes));
    BOLT_TRY_ASSIGN(auto transport, open_hid(listed.path));
    switch (listed.kind) {
        case DeviceKind::puck:
            return make_space_mouse(std::move(transport), descriptor, listed.name, listed.id, options.puck);
        case DeviceKind::open_ffboard:
            return make_open_ffboard(std::move(transport), descriptor, listed.name, listed.id, options.wheel);
        case DeviceKind::wheel:
            return make_wheel(std::move(transport), descriptor, listed.name, listed.id, options.wheel);
        case DeviceKind::arm:
        case DeviceKind::other:
            break;
    }
    return fail(ErrorCode::no_device, fmt::format("{} is not a supported device", listed.name),
                "a SpaceMouse or a wheel with force feedback");
}

namespace {

Result<std::unique_ptr<DeviceDriver>> open_listed(const std::string& id, const OpenOptions& options) {
    for (const ListedDevice& device : list_devices())
        if (device.id == id) return open(device, options);
    return fail(lost_device_error(fmt::format("there is no device {}", id),
                                  "a connected device; `boltwright devices` lists them"));
}

}  // namespace

DeviceFactory factory_for(std::string id, const OpenOptions& given) {
    OpenOptions kept = given;
    if (!kept.unfinished_calibrations) kept.unfinished_calibrations = make_unfinished_calibrations();
    return [id = std::move(id), options = std::move(kept)]() -> Result<std::unique_ptr<DeviceDriver>> {
        if (!options.permission || !options.permission->acquire()) return open_listed(id, options);
        OpenOptions permitted = options;
        permitted.arm_may_move = true;
        Result<std::unique_ptr<DeviceDriver>> opened = open_listed(id, permitted);
        options.permission->end();
        return opened;
    };
}

}  // namespace bolt::device
