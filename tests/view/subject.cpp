#include "game/view/loaded_model.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>

#include "game/view/pictures.hpp"

using namespace bolt;
using namespace bolt::view;
namespace fs = std::filesystem;

namespace {

bool has(const std::vector<fs::path>& files, const std::string& name) {
    return std::any_of(files.begin(), files.end(),
                       [&](const fs::path& file) { return file.filename() == name; });
}

}  // namespace

TEST_CASE("an assembly is its model with the views of its file; the far level is the other model") {
    const LoadedSubject cover = load_subject("cover-m8");
    REQUIRE(cover.ok());
    CHECK(cover.subject.name == "cover-m8");
    CHECK_FALSE(cover.subject.bare);
    CHECK(cover.subject.views.size() >= 2);
    CHECK(has(cover.subject.files, "assembly.json"));
    CHECK(has(cover.subject.files, "cover-m8.glb"));
    const LoadedSubject far = load_subject("cover-m8", Level::far);
    REQUIRE(far.ok());
    CHECK(has(far.subject.files, "cover-m8.far.glb"));
    CHECK_FALSE(has(far.subject.files, "cover-m8.glb"));
    const Result<Viewpoint> top = named_view(cover.subject, "top");
    REQUIRE(top.has_value());
    CHECK(top->fov > 0.0F);
    const Result<Viewpoint> wrong = named_view(cover.subject, "topp");
    REQUIRE_FALSE(wrong.has_value());
    CHECK(wrong.error().code == ErrorCode::usage);
    CHECK(wrong.error().expected == "\"top\"");
}

TEST_CASE("a bare model has no views; what is not there is an error of the content") {
    const char* content = std::getenv("BOLTWRIGHT_CONTENT");
    REQUIRE(content != nullptr);
    const LoadedSubject wrench = load_subject((fs::path(content) / "tools/wrench-13.glb").string());
    REQUIRE(wrench.ok());
    CHECK(wrench.subject.bare);
    CHECK(wrench.subject.name == "wrench-13.glb");
    CHECK_FALSE(named_view(wrench.subject, "top").has_value());
    for (const char* nowhere : {"nowhere.glb", "nowhere"}) {
        const LoadedSubject none = load_subject(nowhere);
        REQUIRE_FALSE(none.ok());
        CHECK(none.errors.front().code == ErrorCode::bad_content);
    }
}

TEST_CASE("sizes") {
    REQUIRE(parse_size("640x480").has_value());
    CHECK(parse_size("640x480")->width == 640);
    CHECK(parse_size("640x480")->height == 480);
    for (const char* text : {"", "640", "640x", "0x480", "640x480x1", "640X480", "9000x10", "-1x10"})
        CHECK_FALSE(parse_size(text).has_value());
}
