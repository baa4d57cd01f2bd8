#include "haptics/device/hid_devices.hpp"

#include <fmt/format.h>
#include <hidapi.h>

#include <algorithm>
#include <map>

#include "haptics/device/hid_transport.hpp"
#include "haptics/device/pid.hpp"
#include "haptics/device/space_mouse.hpp"
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
            if (c >= 0x20 && c != 0x7f) out += static_cast<char>(c);  // a device's name goes to terminals
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

struct Seen {
    HidIdentity who;
    std::string path;
};

// One entry per node; hidapi lists one per collection of a device.
std::vector<Seen> seen() {
    std::vector<Seen> out;
    const std::lock_guard lock(hidapi_lock());
    hid_device_info* first = hid_enumerate(0, 0);
    for (const hid_device_info* d = first; d != nullptr; d = d->next) {
        if (d->path == nullptr) continue;
        if (std::any_of(out.begin(), out.end(), [&](const Seen& s) { return s.path == d->path; })) continue;
        out.push_back(
            {{d->vendor_id, d->product_id, utf8(d->product_string), utf8(d->serial_number)}, d->path});
    }
    hid_free_enumeration(first);
    // Natural order: hidraw10 after hidraw9.
    std::sort(out.begin(), out.end(), [](const Seen& a, const Seen& b) {
        return std::pair(a.path.size(), a.path) < std::pair(b.path.size(), b.path);
    });
    return out;
}

// Identifies pucks by vendor and product if the descriptor cannot be read: 3Dconnexion, also under Logitech's
// name.
HidKind kind_by_number(const HidIdentity& who) {
    if (who.vendor == board_vendor && who.product == board_product) return HidKind::board;
    const bool logitech = who.vendor == 0x046d && who.product >= 0xc603 && who.product <= 0xc62b;
    return who.vendor == 0x256f || logitech ? HidKind::puck : HidKind::other;
}

Status check_driver_support(HidKind kind, const ReportDescriptor& descriptor) {
    if (kind == HidKind::puck) {
        BOLT_TRY(six_axis_layout(descriptor));
    } else if (kind != HidKind::other) {
        BOLT_TRY(wheel_axis(descriptor));
        BOLT_TRY(pid_layout(descriptor));
    }
    return {};
}

ListedDevice listed(const Seen& one) {
    ListedDevice l;
    l.path = one.path;
    l.id = id_of(one.who);
    l.name = one.who.name.empty() ? l.id : one.who.name;
    const auto bytes = descriptor_of(one.path);
    if (!bytes) {
        l.trouble = bytes.error();
        return l;
    }
    const auto descriptor = parse_report_descriptor(*bytes);
    if (!descriptor) {
        l.kind = kind_by_number(one.who);
        l.trouble = descriptor.error();
        return l;
    }
    l.kind = kind_of(one.who, *descriptor);
    if (l.kind == HidKind::other) return l;
    if (Status known = check_driver_support(l.kind, *descriptor); !known) {
        l.trouble = known.error();
    } else if (Status can = can_open_hid(one.path); !can) {
        l.trouble = can.error();
        if (l.kind == HidKind::wheel && !l.trouble->lost)
            l.trouble->expected += fmt::format("; for this wheel with the line {} in it", udev_rule(one.who));
    }
    return l;
}

}  // namespace

HidKind kind_of(const HidIdentity& who, const ReportDescriptor& descriptor) {
    if (who.vendor == board_vendor && who.product == board_product) return HidKind::board;
    for (const Collection& c : descriptor.collections)
        if (c.usage == multi_axis_controller) return HidKind::puck;
    for (const Field& f : descriptor.fields)
        if (f.usage.page == force_page && f.kind != ReportKind::input) return HidKind::wheel;
    return HidKind::other;
}

std::string id_of(const HidIdentity& who) {
    std::string id = fmt::format("{:04x}:{:04x}", who.vendor, who.product);
    if (!who.serial.empty()) id += ':' + who.serial;
    return id;
}

std::string udev_rule(const HidIdentity& who) {
    return fmt::format(R"(KERNEL=="hidraw*", KERNELS=="*:{:04X}:{:04X}.*", TAG+="uaccess")", who.vendor,
                       who.product);
}

std::vector<ListedDevice> list_devices(bool others) {
    std::vector<ListedDevice> out;
    for (const Seen& one : seen()) out.push_back(listed(one));
    std::erase_if(out, [](const ListedDevice& l) { return l.trouble && l.trouble->lost; });  // gone meanwhile
    // Supported devices first, so that their ids do not depend on `others`: a puck's receiver is also a
    // keyboard.
    const auto is_other = [](const ListedDevice& l) { return l.kind == HidKind::other; };
    std::stable_partition(out.begin(), out.end(), [&](const ListedDevice& l) { return !is_other(l); });
    if (!others) std::erase_if(out, is_other);
    std::map<std::string, int> met;
    for (ListedDevice& l : out)
        if (const int n = ++met[l.id]; n > 1) l.id += fmt::format("#{}", n);
    return out;
}

Result<std::unique_ptr<Device>> open(const ListedDevice& listed, const WheelConfig& config,
                                     const PuckResponse& response) {
    if (listed.trouble) return fail(*listed.trouble);
    BOLT_TRY_ASSIGN(const auto bytes, descriptor_of(listed.path));
    BOLT_TRY_ASSIGN(const auto descriptor, parse_report_descriptor(bytes));
    BOLT_TRY_ASSIGN(auto line, open_hid(listed.path));
    switch (listed.kind) {
        case HidKind::puck:
            return make_space_mouse(std::move(line), descriptor, listed.name, listed.id, response);
        case HidKind::board:
            return make_open_ffboard(std::move(line), descriptor, listed.name, listed.id, config);
        case HidKind::wheel:
            return make_wheel(std::move(line), descriptor, listed.name, listed.id, config);
        case HidKind::other:
            break;
    }
    return fail(ErrorCode::no_device, fmt::format("{} is not a supported device", listed.name),
                "a SpaceMouse, or a wheel with force feedback");
}

DeviceFactory factory_for(std::string id, const WheelConfig& config, const PuckResponse& response) {
    return [id = std::move(id), config, response]() -> Result<std::unique_ptr<Device>> {
        for (const ListedDevice& l : list_devices())
            if (l.id == id) return open(l, config, response);
        Error error;
        error.code = ErrorCode::no_device;
        error.what = fmt::format("there is no device {}", id);
        error.expected = "a device that is plugged in; `boltwright devices` lists them";
        error.lost = true;
        return fail(std::move(error));
    };
}

}  // namespace bolt::device
