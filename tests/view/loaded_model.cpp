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

TEST_CASE("Loaded model: an assembly gives its model and views; the far level gives the far model") {
    const ModelLoadResult cover = load_model("cover-m8");
    REQUIRE(cover.ok());
    CHECK(cover.model.name == "cover-m8");
    CHECK_FALSE(cover.model.without_assembly);
    CHECK(cover.model.views.size() >= 2);
    CHECK(has(cover.model.files, "assembly.json"));
    CHECK(has(cover.model.files, "cover-m8.glb"));
    const ModelLoadResult far = load_model("cover-m8", DetailLevel::far);
    REQUIRE(far.ok());
    CHECK(has(far.model.files, "cover-m8.far.glb"));
    CHECK_FALSE(has(far.model.files, "cover-m8.glb"));
    const Result<Viewpoint> top = named_view(cover.model, "top");
    REQUIRE(top.has_value());
    CHECK(top->fov > 0.0F);
    const Result<Viewpoint> wrong = named_view(cover.model, "topp");
    REQUIRE_FALSE(wrong.has_value());
    CHECK(wrong.error().code == ErrorCode::usage);
    CHECK(wrong.error().expected == "did you mean \"top\"?");
}

TEST_CASE("Loaded model: a bare model has no views; a missing file is a content error") {
    const char* content = std::getenv("BOLTWRIGHT_CONTENT");
    REQUIRE(content != nullptr);
    const ModelLoadResult wrench = load_model((fs::path(content) / "tools/wrench-13.glb").string());
    REQUIRE(wrench.ok());
    CHECK(wrench.model.without_assembly);
    CHECK(wrench.model.name == "wrench-13.glb");
    CHECK_FALSE(named_view(wrench.model, "top").has_value());
    for (const char* nowhere : {"nowhere.glb", "nowhere"}) {
        const ModelLoadResult none = load_model(nowhere);
        REQUIRE_FALSE(none.ok());
        CHECK(none.errors.front().code == ErrorCode::bad_content);
    }
}

TEST_CASE("Pictures: parse_size accepts WIDTHxHEIGHT up to 8192 only") {
    REQUIRE(parse_size("640x480").has_value());
    CHECK(parse_size("640x480")->width == 640);
    CHECK(parse_size("640x480")->height == 480);
    for (const char* text : {"", "640", "640x", "0x480", "640x480x1", "640X480", "9000x10", "-1x10"})
        CHECK_FALSE(parse_size(text).has_value());
}
