// The cover with four joints, two of which have left-hand threads, as a file of its own.
#pragma once

#include <doctest/doctest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>

#include "content/format/assembly.hpp"
#include "tests/support/folder.hpp"

namespace bolt::test {

inline constexpr std::array<std::size_t, 2> left_threads{0, 2};  // B1 and B3

// Copies the cover into `folder`. `tool`: that turns all joints, "ring" or "ratchet"; empty: the open end.
// `once`: the joints are tightened in one pass, for tests in which a visit of a joint takes long.
inline content::Assembly cover_with_left_threads(const Folder& folder, std::string_view tool = {},
                                                 bool once = false) {
    namespace fs = std::filesystem;
    const fs::path cover = folder / "cover", file = cover / "assembly.json";
    fs::copy(content::content_folder() / "assemblies" / "cover-m8", cover);
    std::string text;
    {
        std::ifstream in(file);
        text.assign(std::istreambuf_iterator<char>(in), {});
    }
    if (once)
        for (const std::string_view pass : {R"({ "kind": "tighten", "percent": 50 },)", R"(,
    { "kind": "recheck" })"}) {
            const std::size_t at = text.find(pass);
            REQUIRE(at != std::string::npos);
            text.erase(at, pass.size());
        }
    const auto insert_after = [&](std::string_view place, std::string_view added) {
        const std::size_t at = text.find(place);
        REQUIRE(at != std::string::npos);
        text.insert(at + place.size(), added);
    };
    for (const char* joint : {R"("id": "B1",)", R"("id": "B3",)"})
        insert_after(joint, R"( "override": { "thread_direction": "left" },)");
    if (!tool.empty()) insert_after(R"("class": "8.8",)", R"( "tool": ")" + std::string(tool) + R"(",)");
    insert_after(R"("more_tools": {)", R"(
    "ring": { "kind": "ring_wrench", "size_mm": 13, "handle_length_mm": 150 },
    "ratchet": { "kind": "ratchet", "size_mm": 13, "teeth": 24, "handle_length_mm": 150 },)");
    std::ofstream(file) << text;
    content::LoadedAssembly loaded = content::load_assembly(cover.string());
    for (const Error& error : loaded.errors) FAIL_CHECK(error.message());
    return std::move(loaded.assembly);
}

}  // namespace bolt::test
