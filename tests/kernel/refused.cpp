// Devices that cannot be used, and what is said about it.
#include <sys/stat.h>

#include "tests/kernel/guest.hpp"
#include "tools/emulate/hid_items.hpp"
#include "tools/emulate/puck.hpp"
#include "tools/emulate/wheel.hpp"

using namespace bolt;
using namespace bolt::device;
using namespace bolt::test;

namespace {

class Plain : public emulate::HidDevice {
  public:
    explicit Plain(emulate::Bytes descriptor, std::uint16_t vendor = 0x1234, std::uint16_t product = 1) {
        design_ = {vendor, product, "Some device", "", std::move(descriptor)};
    }
    [[nodiscard]] const emulate::HidDesign& design() const override { return design_; }
    std::vector<emulate::Bytes> go_on(double) override { return {}; }
    void output(std::span<const std::uint8_t>) override {}
    void set_feature(std::span<const std::uint8_t>) override {}
    emulate::Bytes get_feature(std::uint8_t) override { return {}; }

  private:
    emulate::HidDesign design_;
};

}  // namespace

TEST_CASE("without permission the rule that gives it is named, and with it the device is usable") {
    const auto puck = plugged(std::make_unique<emulate::Puck>());
    const auto wheel = plugged(std::make_unique<emulate::Wheel>(emulate::WheelDesign{.board = false}));
    const Listed a = listed("256f:c62e"), b = listed("1234:5678");
    const auto message = [](const std::string& id) {
        for (const Listed& l : list())
            if (l.id == id) return l.trouble ? l.trouble->message() : std::string("usable");
        return std::string("not listed");
    };
    REQUIRE(chmod(a.path.c_str(), 0600) == 0);
    REQUIRE(chmod(b.path.c_str(), 0600) == 0);
    CHECK(message(a.id) == "usable");  // to root
    CHECK(holds_for_nobody([&] {
        return message(a.id).find("Permission denied") != std::string::npos &&
               message(a.id).find("60-boltwright.rules") != std::string::npos &&
               message(b.id).find("KERNELS==\"*:1234:5678.*\"") != std::string::npos;
    }));
    CHECK(holds_for_nobody([&] {
        const auto device = opener(a.id)();
        return !device && !device.error().lost &&
               device.error().message().find("60-boltwright.rules") != std::string::npos;
    }));
    REQUIRE(chmod(a.path.c_str(), 0666) == 0);
    CHECK(holds_for_nobody([&] { return message(a.id) == "usable" && opener(a.id)().has_value(); }));
    CHECK(!holds_for_nobody([&] { return message(b.id) == "usable"; }));
}

TEST_CASE("a keyboard that came with a puck does not change the puck's name") {
    emulate::Items keys;
    keys.page(1).usage(6).begin(1).page(7).usages(0xe0, 0xe7).range(0, 1).fields(8, 1).input(2).end();
    const auto keyboard = plugged(std::make_unique<Plain>(keys.out, 0x256f, 0xc62e));
    REQUIRE(becomes([] { return list(true).size() == 1; }));
    CHECK(list().empty());
    CHECK(list(true).front().kind == HidKind::other);
    CHECK(!opener("256f:c62e")());
    const auto puck = plugged(std::make_unique<emulate::Puck>());
    CHECK(listed("256f:c62e").kind == HidKind::puck);
    const auto all = list(true);
    REQUIRE(all.size() == 2);
    CHECK(all[0].kind == HidKind::puck);
    CHECK(all[0].id == "256f:c62e");
    CHECK(all[1].id == "256f:c62e#2");
}

TEST_CASE("what the kernel understands and we do not is told of devices that are known by their numbers") {
    const auto wide = [] {  // more fields than we read
        emulate::Items d;
        d.page(0xff00).usage(1).begin(1).usage(1).range(0, 1).item(0x94, 4104, 2).item(0x74, 1, 1).input(2);
        return d.end().out;
    };
    const auto unknown = plugged(std::make_unique<Plain>(wide()));
    REQUIRE(becomes([] { return list(true).size() == 1; }));
    CHECK(list(true).front().trouble);
    CHECK(list().empty());
    const auto known = plugged(std::make_unique<Plain>(wide(), 0x256f, 0xc699));
    const Listed l = listed("256f:c699");
    CHECK(l.kind == HidKind::puck);
    REQUIRE(l.trouble);
    CHECK(l.trouble->message().find("4104 fields") != std::string::npos);
    CHECK(!opener(l.id)());
}

TEST_CASE("descriptors that make no sense get no further than the kernel, or are told") {
    Random random(3);
    for (int i = 0; i < 20; ++i) {
        emulate::Bytes garbage(40 + random.bits() % 200);
        for (auto& byte : garbage) byte = static_cast<std::uint8_t>(random.bits());
        const auto plug = plugged(std::make_unique<Plain>(garbage));
        static_cast<void>(becomes([] { return !list(true).empty(); }, 0.02));
        for (const Listed& l : list(true)) CHECK((l.kind == HidKind::other || l.trouble));
    }
    emulate::Items one_way;
    one_way.page(1).usage(4).begin(1).id(1).usage(0x30).range(-127, 127).fields(1, 8).input(2);
    one_way.page(15).usage(0x73).begin(2).id(5).usage(0x70).range(0, 127).fields(1, 8).output(2).end();
    const auto plug = plugged(std::make_unique<Plain>(one_way.end().out));
    const Listed l = listed("1234:0001");
    REQUIRE(l.trouble);
    CHECK(l.trouble->message().find("one way only") != std::string::npos);
    CHECK(!opener(l.id)());
}
