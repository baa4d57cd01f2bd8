#include "game/station/station_setup.hpp"

#include <doctest/doctest.h>

using namespace bolt;
using namespace bolt::station_setup;
using device::HidKind;
using device::ListedDevice;

namespace {

ListedDevice one(const std::string& id, HidKind kind, const char* trouble = nullptr) {
    ListedDevice l{"/dev/hidraw0", id, "a " + id, kind, std::nullopt};
    if (trouble != nullptr) {
        l.trouble.emplace();
        l.trouble->code = ErrorCode::no_device;
        l.trouble->what = trouble;
    }
    return l;
}

const std::vector<ListedDevice> shelf{one("256f:c62e", HidKind::puck, "may not be opened"),
                                      one("046d:c626", HidKind::puck), one("1234:5678", HidKind::wheel),
                                      one("1209:ffb0", HidKind::board), one("0000:0001", HidKind::other)};

Result<Choice> chosen(const std::vector<std::string>& ids) { return choose(shelf, ids); }

std::string wrong(const std::vector<std::string>& ids) {
    const Result<Choice> choice = chosen(ids);
    return choice ? "" : choice.error().message();
}

}  // namespace

TEST_CASE("Selection: a puck is the mover and a wheel or board the wheel, in any order") {
    CHECK(!chosen({})->mover);
    for (const auto& ids : {std::vector<std::string>{"046d:c626", "1209:ffb0"}, {"1209:ffb0", "046d:c626"}}) {
        const Result<Choice> both = chosen(ids);
        REQUIRE(both);
        CHECK(both->mover->id == "046d:c626");
        CHECK(both->wheel->id == "1209:ffb0");
        CHECK(ids_of(*both) == std::vector<std::string>{"046d:c626", "1209:ffb0"});
    }
    CHECK(chosen({"1234:5678"})->wheel->id == "1234:5678");
    CHECK(!chosen({"1234:5678"})->mover);
}

TEST_CASE("Selection: missing, unusable and duplicate devices are errors that name the remedy") {
    CHECK(wrong({"1209:ffb1"}).find("did you mean 1209:ffb0?") != std::string::npos);
    CHECK(wrong({"dead:beef"}).find("boltwright devices") != std::string::npos);
    CHECK(chosen({"dead:beef"}).error().code == ErrorCode::no_device);
    CHECK(wrong({"256f:c62e"}) == "may not be opened");
    CHECK(wrong({"0000:0001"}).find("nothing to train with") != std::string::npos);
    CHECK(wrong({"1234:5678", "1209:ffb0"}).find("one of them") != std::string::npos);
    CHECK(chosen({"1209:ffb0", "1209:ffb0"}).error().code == ErrorCode::usage);
}

TEST_CASE("Selection: without ids the first usable device of each role is taken") {
    CHECK(ids_of(choose_any(shelf)) == std::vector<std::string>{"046d:c626", "1234:5678"});
    CHECK(ids_of(choose_any({})).empty());
    CHECK(ids_of(choose_any(std::span(shelf).first(1))).empty());
}
