// The lesson of one nut, with a bolt head that only a second wrench holds, as a file of its own.
#pragma once

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "content/format/assembly.hpp"
#include "tests/support/folder.hpp"

namespace bolt::test {

// Copies the lesson into `folder` and returns the path of its assembly. `friction`: of thread and bearing.
inline std::filesystem::path lesson_with_second_wrench(const Folder& folder, double friction = 0.12) {
    namespace fs = std::filesystem;
    const fs::path assemblies = content::content_folder() / "assemblies";
    const fs::path lesson = folder / "first-nut", file = lesson / "assembly.json";
    fs::copy(assemblies / "first-nut", lesson);
    std::string text;
    {
        std::ifstream in(file);
        text.assign(std::istreambuf_iterator<char>(in), {});
    }
    const auto replace = [&](const std::string& old, const std::string& now) {
        const std::size_t at = text.find(old);
        REQUIRE(at != std::string::npos);
        text.replace(at, old.size(), now);
    };
    replace(R"("class": "8.8",)", R"("class": "8.8", "counter_hold": "second_wrench",)");
    for (const char* key : {"friction_thread", "friction_bearing"})
        replace('"' + std::string(key) + "\": 0.12",
                '"' + std::string(key) + "\": " + std::to_string(friction));
    for (const char* model : {"cover-m8.glb", "cover-m8.far.glb", "cover-m8.contact.glb"}) {
        fs::copy(assemblies / "cover-m8" / model, lesson);
        replace("../cover-m8/" + std::string(model), model);
    }
    std::ofstream(file) << text;
    return file;
}

}  // namespace bolt::test
