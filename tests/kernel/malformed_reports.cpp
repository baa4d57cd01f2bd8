// Unusable devices and their error messages.
#include <sys/stat.h>

#include "tests/kernel/guest.hpp"
#include "tools/emulate/hid_device.hpp"
#include "tools/emulate/puck.hpp"
#include "tools/emulate/wheel.hpp"

using namespace bolt;
using namespace bolt::device;
using namespace bolt::test;

namespace {

class InertDevice : public emulate::HidDevice {
  public:
    explicit InertDevice(emulate::Bytes descriptor, std::uint16_t vendor = 0x1234,
                         std::uint16_t product = 1) {
        description_ = {vendor, product, "Some device", "", std::move(descriptor)};
    }
    [[nodiscard]] const emulate::HidDescription& description() const override { return description_; }
    std::vector<emulate::Bytes> advance(double) override { return {}; }
    void output(std::span<const std::uint8_t>) override {}
    void set_feature(std::span<const std::uint8_t>) override {}
    emulate::Bytes get_feature(std::uint8_t) override { return {}; }

  private:
    emulate::HidDescription description_;
};

}  // namespace

TEST_CASE("Kernel: missing permission names the udev rule, and with permission the device works") {
    const auto puck = attach(std::make_unique<emulate::EmulatedPuck>());
    const auto wheel =
        attach(std::make_unique<emulate::EmulatedWheel>(emulate::EmulatedWheelOptions{.board = false}));
    const ListedDevice a = wait_for_device("256f:c62e"), b = wait_for_device("1234:5678");
    const auto message = [](const std::string& id) {
        for (const ListedDevice& l : list_devices())
            if (l.id == id) return l.error ? l.error->message() : std::string("usable");
        return std::string("not listed");
    };
    REQUIRE(chmod(a.path.c_str(), 0600) == 0);
    REQUIRE(chmod(b.path.c_str(), 0600) == 0);
    CHECK(message(a.id) == "usable");  // to root
    CHECK(holds_unprivileged([&] {
        return message(a.id).find("Permission denied") != std::string::npos &&
               message(a.id).find("60-boltwright.rules") != std::string::npos &&
               message(b.id).find("KERNELS==\"*:1234:5678.*\"") != std::string::npos;
    }));
    CHECK(holds_unprivileged([&] {
        const auto device = factory_for(a.id)();
        return !device && !device.error().lost &&
               device.error().message().find("60-boltwright.rules") != std::string::npos;
    }));
    REQUIRE(chmod(a.path.c_str(), 0666) == 0);
    CHECK(holds_unprivileged([&] { return message(a.id) == "usable" && factory_for(a.id)().has_value(); }));
    CHECK(!holds_unprivileged([&] { return message(b.id) == "usable"; }));
}

TEST_CASE("Kernel: a keyboard in the same receiver does not change the puck's id") {
    emulate::DescriptorBuilder keys;
    keys.page(1).usage(6).begin(1).page(7).usages(0xe0, 0xe7).range(0, 1).fields(8, 1).input(2).end();
    const auto keyboard = attach(std::make_unique<InertDevice>(keys.out, 0x256f, 0xc62e));
    REQUIRE(holds_within([] { return list_devices(true).size() == 1; }));
    CHECK(list_devices().empty());
    CHECK(list_devices(true).front().kind == DeviceKind::other);
    CHECK(!factory_for("256f:c62e")());
    const auto puck = attach(std::make_unique<emulate::EmulatedPuck>());
    CHECK(wait_for_device("256f:c62e").kind == DeviceKind::puck);
    const auto all = list_devices(true);
    REQUIRE(all.size() == 2);
    CHECK(all[0].kind == DeviceKind::puck);
    CHECK(all[0].id == "256f:c62e");
    CHECK(all[1].id == "256f:c62e#2");
}

TEST_CASE("Kernel: an unusable descriptor of a known device is reported") {
    const auto wide = [] {  // more fields than are supported
        emulate::DescriptorBuilder d;
        d.page(0xff00).usage(1).begin(1).usage(1).range(0, 1).item(0x94, 4104, 2).item(0x74, 1, 1).input(2);
        return d.end().out;
    };
    const auto unknown = attach(std::make_unique<InertDevice>(wide()));
    REQUIRE(holds_within([] { return list_devices(true).size() == 1; }));
    CHECK(list_devices(true).front().error);
    CHECK(list_devices().empty());
    const auto known = attach(std::make_unique<InertDevice>(wide(), 0x256f, 0xc699));
    const ListedDevice l = wait_for_device("256f:c699");
    CHECK(l.kind == DeviceKind::puck);
    REQUIRE(l.error);
    CHECK(l.error->message().find("4104 fields") != std::string::npos);
    CHECK(!factory_for(l.id)());
}

TEST_CASE("Kernel: malformed descriptors are rejected by the kernel or reported") {
    Random random(3);
    for (int i = 0; i < 20; ++i) {
        emulate::Bytes garbage(40 + random.bits() % 200);
        for (auto& byte : garbage) byte = static_cast<std::uint8_t>(random.bits());
        const auto plug = attach(std::make_unique<InertDevice>(garbage));
        static_cast<void>(holds_within([] { return !list_devices(true).empty(); }, 0.02));
        for (const ListedDevice& l : list_devices(true)) CHECK((l.kind == DeviceKind::other || l.error));
    }
    emulate::DescriptorBuilder one_way;
    one_way.page(1).usage(4).begin(1).id(1).usage(0x30).range(-127, 127).fields(1, 8).input(2);
    one_way.page(15).usage(0x73).begin(2).id(5).usage(0x70).range(0, 127).fields(1, 8).output(2).end();
    const auto plug = attach(std::make_unique<InertDevice>(one_way.end().out));
    const ListedDevice l = wait_for_device("1234:0001");
    REQUIRE(l.error);
    CHECK(l.error->message().find("one sign only") != std::string::npos);
    CHECK(!factory_for(l.id)());
}
