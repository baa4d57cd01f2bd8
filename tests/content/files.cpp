// The .glb files that an assembly names: search paths, and errors for missing or disallowed files.
#include <doctest/doctest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "content/format/assembly.hpp"
#include "content/format/embedded.hpp"
#include "content/format/json_document.hpp"
#include "engine/base/file.hpp"
#include "support.hpp"
#include "tests/support/folder.hpp"

namespace content_files_test {

using namespace bolt;
namespace fs = std::filesystem;

namespace {

// A temporary content folder with an assembly in it and one beside it; $BOLTWRIGHT_CONTENT names it during
// its lifetime.
struct TemporaryContent {
    test::Folder root;
    fs::path inside = root / "content" / "assemblies" / "pump", outside = root / "elsewhere";
    std::string before = content::content_folder().string();

    TemporaryContent() {
        for (const fs::path& folder :
             {inside, outside, root / "content" / "tools", root / "content" / "schema"})
            fs::create_directories(folder);
        touch("content/schema/assembly.schema.json");
        touch("content/tools/wrench_13.glb");
        touch("content/assemblies/pump/pump.glb");
        touch("content/assemblies/shared.glb");
        touch("elsewhere/bracket.glb");
        touch("far.glb");
        ::setenv("BOLTWRIGHT_CONTENT", (root / "content").c_str(), 1);
    }
    TemporaryContent(const TemporaryContent&) = delete;
    TemporaryContent& operator=(const TemporaryContent&) = delete;
    ~TemporaryContent() { ::setenv("BOLTWRIGHT_CONTENT", before.c_str(), 1); }
    void touch(const char* name) const { REQUIRE(write_file(root / name, "x")); }
};

constexpr const char* cover = R"({
  "title": { "en": "Cover" }, "lesson": { "en": "Tighten." },
  "tool": { "kind": "open_end_wrench", "jaw_mm": 13.2, "handle_length_mm": 140 },
  "joint_types": {
    "M8": {
      "size": "M8", "class": "8.8", "bolt_length_mm": 30, "members": [{ "thickness_mm": 19, "material": "steel" }],
      "friction_thread": 0.12, "friction_bearing": 0.12, "spec": { "strategy": "torque", "target_torque_Nm": 20 }
    }
  },
  "joints": [{ "id": "B1", "type": "M8", "position_mm": [0, 0, 0] }],
  "passes": [{ "kind": "run_down" }, { "kind": "tighten", "percent": 100 }, { "kind": "recheck" }]
}
)";

// Loads a small assembly with `members` added to the file and `of_tool` to its tool.
content::LoadedAssembly with(const fs::path& folder, const std::string& members,
                             const std::string& of_tool = {}) {
    std::string text = content_test::edited(cover, "\"title\": {", members + "\"title\": {");
    text = content_test::edited(std::move(text), "\"jaw_mm\"", of_tool + "\"jaw_mm\"");
    REQUIRE(write_file(folder / "assembly.json", text));
    return content::load_assembly(folder);
}

std::string only(const content::LoadedAssembly& loaded) {
    REQUIRE(loaded.errors.size() == 1);
    const std::string message = loaded.errors[0].message();
    return message.substr(message.find("assembly.json") + std::string_view("assembly.json:").size());
}

}  // namespace

TEST_CASE("Model files: paths of an assembly are relative to its folder, those of a tool to content/tools") {
    const TemporaryContent world;
    const auto loaded = with(
        world.inside, R"("model": "pump.glb", "model_far": "../shared.glb", "contact_model": "./pump.glb", )",
        R"("model": "wrench_13.glb", )");
    for (const Error& error : loaded.errors) FAIL_CHECK(error.message());
    CHECK(loaded.assembly.models.model == (world.inside / "pump.glb").string());
    CHECK(fs::equivalent(loaded.assembly.models.far_level, world.inside.parent_path() / "shared.glb"));
    CHECK(loaded.assembly.models.contact == (world.inside / "pump.glb").string());
    CHECK(fs::equivalent(loaded.assembly.wrench.model, world.root / "content" / "tools" / "wrench_13.glb"));
    const auto none = with(world.outside, "");
    CHECK(none.ok());
    CHECK(none.assembly.models.model.empty());
    CHECK(none.assembly.wrench.model.empty());
    CHECK(with(world.outside, R"("model": "bracket.glb", )").ok());
}

TEST_CASE("Model files: a missing file is reported where it is named, with the nearest existing one") {
    const TemporaryContent world;
    CHECK(only(with(world.inside, R"("model": "bump.glb", )")) ==
          R"(2:12: /model: there is no file "bump.glb" in the assembly's folder; did you mean "pump.glb"?)");
    CHECK(
        only(with(world.outside, R"("model_far": "pump.far.glb", )")) ==
        R"(2:16: /model_far: there is no file "pump.far.glb" in the assembly's folder; expected "bracket.glb")");
    CHECK(
        only(with(world.inside, R"("contact_model": "none/pump.glb", )")) ==
        R"(2:20: /contact_model: there is no file "none/pump.glb" in the assembly's folder; expected a file; no .glb is there)");
    CHECK(
        only(with(world.inside, "", R"("model": "wrench_31.glb", )")) ==
        R"(3:49: /tool/model: there is no file "wrench_31.glb" in content/tools; did you mean "wrench_13.glb"?)");
    fs::create_directories(world.inside / "folder.glb");
    CHECK_FALSE(with(world.inside, R"("model": "folder.glb", )").ok());
}

TEST_CASE("Model files: a path outside the allowed folder is an error") {
    const TemporaryContent world;
    CHECK(
        only(with(world.inside, R"("model": "../../../far.glb", )")) ==
        R"(2:12: /model: "../../../far.glb" is outside the content folder; expected a file in the content folder)");
    CHECK(
        only(with(world.outside, R"("model": "../far.glb", )")) ==
        R"(2:12: /model: "../far.glb" is outside the assembly's folder; expected a file in the assembly's folder)");
    CHECK(
        only(with(world.inside, "", R"("model": "../assemblies/shared.glb", )")) ==
        R"(3:49: /tool/model: "../assemblies/shared.glb" is outside content/tools; expected a file in content/tools)");
    fs::create_symlink(world.root / "far.glb", world.inside / "link.glb");
    CHECK(only(with(world.inside, R"("model": "link.glb", )")).find("is outside") != std::string::npos);
    for (const char* name : {"/etc/far.glb", "C:far.glb", "sub\\\\far.glb"}) {
        CAPTURE(name);
        CHECK(only(with(world.inside, "\"model\": \"" + std::string(name) + "\", "))
                  .find("is not a relative path; expected a path from the assembly's folder") !=
              std::string::npos);
    }
    CHECK(
        only(with(world.inside, R"("model": "pump.step", )")) ==
        R"(2:12: /model: "pump.step" is not a .glb file; expected a binary glTF file: bolt-author import-step makes one from STEP)");
}

TEST_CASE("Model files: file names in a parsed text are relative to the given path") {
    const auto loaded = content::parse_assembly(content_test::everything(), "there/f.json");
    REQUIRE(loaded.ok());
    CHECK(loaded.assembly.models.model == "there/bracket.glb");
    CHECK(loaded.assembly.models.far_level == "there/bracket.far.glb");
    CHECK(loaded.assembly.models.contact == "there/bracket.contact.glb");
    CHECK(loaded.assembly.wrench.model == "tools/wrench_18.glb");
}

TEST_CASE("Model files: a new assembly copies the models that exist and names no others") {
    const TemporaryContent world;
    const auto made = [&](const char* name) {
        REQUIRE(content::create_assembly(world.root / "content" / "assemblies" / name, name));
        const auto loaded = content::load_assembly(name);
        for (const Error& error : loaded.errors) FAIL_CHECK(error.message());
        return loaded.assembly;
    };
    const content::Assembly bare = made("bare");
    CHECK(bare.models.model.empty());
    CHECK(bare.models.far_level.empty());
    CHECK(bare.models.contact.empty());
    CHECK(bare.wrench.model.empty());

    std::vector<Error> errors;
    const auto document = content::JsonDocument::parse(content::template_text(), {}, errors);
    const auto& named = document->root();
    fs::create_directories(world.root / "content" / "assemblies" / content::template_name());
    int count = 0;
    for (const char* key : {"model", "model_far", "contact_model"}) {
        if (!named.contains(key)) continue;
        world.touch(("content/assemblies/" + std::string(content::template_name()) + "/" +
                     named[key].get<std::string>())
                        .c_str());
        ++count;
    }
    const content::Assembly full = made("full");
    int copied = 0;
    for (const std::string& file : {full.models.model, full.models.far_level, full.models.contact}) {
        if (file.empty()) continue;
        CHECK(fs::path(file).parent_path() == world.root / "content" / "assemblies" / "full");
        ++copied;
    }
    CHECK(copied == count);
}

TEST_CASE("Model files: jaw dimensions are in millimetres and must leave room for the nut") {
    const TemporaryContent world;
    const auto given =
        with(world.inside, "", R"("head_thickness_mm": 7.6, "jaw_depth_mm": 8, "jaw_tip_mm": 9.5, )");
    REQUIRE(given.ok());
    CHECK(given.assembly.wrench.head_thickness == doctest::Approx(7.6e-3));
    CHECK(given.assembly.wrench.jaw_depth == doctest::Approx(8e-3));
    CHECK(given.assembly.wrench.jaw_tip == doctest::Approx(9.5e-3));
    const auto plain = with(world.inside, "");
    CHECK(plain.assembly.wrench.head_thickness == 0.0);
    CHECK(plain.assembly.wrench.jaw_tip == 0.0);
    // 13/√3 and 13/√12.
    CHECK(
        only(with(world.inside, "", R"("jaw_depth_mm": 7, )")) ==
        R"(3:56: /tool/jaw_depth_mm: a jaw depth of 7 mm is too short for 13 mm across flats; expected at least 7.51 mm)");
    CHECK(
        only(with(world.inside, "", R"("jaw_tip_mm": 3, )")) ==
        R"(3:54: /tool/jaw_tip_mm: a jaw tip of 3 mm is too short for 13 mm across flats; expected at least 3.75 mm)");
}

}  // namespace content_files_test
