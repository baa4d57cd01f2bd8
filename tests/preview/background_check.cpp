// The check of an assembly on a thread of its own, and the overlay of its result.
#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "engine/base/file.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/folder.hpp"
#include "tools/author/preview/check_overlay.hpp"

using namespace bolt;
using namespace bolt::author;

namespace {

std::unique_ptr<CheckedAssembly> wait_for_result(BackgroundCheck& check) {
    std::unique_ptr<CheckedAssembly> checked;
    REQUIRE(test::eventually([&] { return (checked = check.take_result()) != nullptr; }));
    return checked;
}

}  // namespace

TEST_CASE("Preview: a check on another thread gives the findings of validate and the room of each joint") {
    BackgroundCheck check;
    CHECK_FALSE(check.is_running());
    CHECK(check.take_result() == nullptr);
    check.start("cover-m8", {});
    CHECK(check.is_running());
    const std::unique_ptr<CheckedAssembly> checked = wait_for_result(check);
    CHECK_FALSE(check.is_running());
    CHECK(check.take_result() == nullptr);
    CHECK(problems_of(*checked).empty());
    REQUIRE(checked->rooms);
    CHECK(checked->rooms->joints.size() == 4);
    for (const geometry::DrawnToolRoom& room : checked->rooms->joints) CHECK(room.swing.width() > 4.0);
}

TEST_CASE("Preview: a check that is started again gives only the last result") {
    BackgroundCheck check;
    check.start("zq350", {});
    check.start("dn200-pn16", "by_angle");
    check.start("cover-m8", {});
    CHECK(wait_for_result(check)->assembly.name == "cover-m8");
    CHECK(check.take_result() == nullptr);
}

TEST_CASE("Preview: a stopped check leaves out the remaining joints") {
    const content::LoadedAssembly loaded = content::load_assembly("cover-m8");
    REQUIRE(loaded.ok());
    geometry::CheckProgress progress;
    progress.stop = true;
    std::optional<geometry::DrawnToolRooms> rooms;
    (void)geometry::check_geometry(loaded.assembly, &rooms, &progress);
    REQUIRE(rooms);
    CHECK(rooms->joints.empty());
    progress.stop = false;
    (void)geometry::check_geometry(loaded.assembly, &rooms, &progress);
    CHECK(progress.checked == 4);
    CHECK(progress.joints == 4);
}

TEST_CASE("Preview: each problem names its joint, and shows the room of the tool that does not fit") {
    const test::Folder folder;
    const std::filesystem::path file = folder.path() / "dn200-pn16" / "assembly.json";
    const content::LoadedAssembly shipped = content::load_assembly("dn200-pn16");
    REQUIRE(shipped.ok());
    std::filesystem::copy(std::filesystem::path(shipped.assembly.file).parent_path(), file.parent_path());
    std::string text = shipped.assembly.text;
    const std::string alternatives = ",\n      \"instead\": { \"B6\": \"ring\", \"B7\": \"ring\" }";
    const std::size_t at = text.find(alternatives);
    REQUIRE(at != std::string::npos);
    REQUIRE(write_file(file, text.erase(at, alternatives.size())));
    BackgroundCheck check;
    check.start(file, {});
    std::unique_ptr<CheckedAssembly> checked = wait_for_result(check);

    CheckOverlay overlay;
    overlay.show(std::move(checked));
    REQUIRE(overlay.problems().size() == 2);
    const Problem& problem = overlay.problems().front();
    REQUIRE(problem.joint);
    CHECK(overlay.checked()->assembly.joints[*problem.joint].design.id == "B6");
    CHECK(
        problem_text(*overlay.checked(), problem).starts_with("B6: the tool \"ratchet\" cannot be brought"));
    const geometry::DrawnToolRoom* room = overlay.room_of("B6");
    REQUIRE(room != nullptr);
    const geometry::DrawnToolRooms& rooms = *overlay.checked()->rooms;
    CHECK(overlay.checked()->assembly.tools[room->tool].name == "ratchet");
    REQUIRE(room->obstruction != geometry::no_part);
    CHECK(rooms.scene.parts[room->obstruction].name == "stand_downstream");
    CHECK(overlay.description_of("B6").find("\"stand_downstream\" is in the way") != std::string::npos);
    REQUIRE(overlay.room_of("B1") != nullptr);
    CHECK(overlay.room_of("B1")->tool == 0);
    CHECK(overlay.room_of("B99") == nullptr);
}
