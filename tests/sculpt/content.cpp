// Tests that the committed content files are those that bolt-sculpt generates.
#include "tools/assets/sculpt/generated_content.hpp"

#include <doctest/doctest.h>

#include <cstdlib>

#include "engine/assets/gltf.hpp"
#include "engine/base/file.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/model_difference.hpp"
#include "tests/support/skip.hpp"

namespace sculpt_content_test {

using namespace bolt;

namespace {

std::filesystem::path content() {
    const char* path = std::getenv("BOLTWRIGHT_CONTENT");
    return path == nullptr ? "content" : path;
}

void check_same(const std::filesystem::path& made, const std::filesystem::path& name) {
    CAPTURE(name);
    const Result<std::string> now = read_file(made / name, std::size_t{16} << 20U, ErrorCode::failed);
    const Result<std::string> kept = read_file(content() / name, std::size_t{16} << 20U, ErrorCode::failed);
    REQUIRE(now.has_value());
    REQUIRE(kept.has_value());
    const std::string_view other_libraries = BOLT_OTHER_LIBRARIES;
    const bool same = *now == *kept;
    if (!same && !other_libraries.empty() && name.extension() == ".glb") {
        CHECK(test::model_difference(made / name, content() / name) == "");
        return test::skip_part("equal bytes: " + std::string(other_libraries));
    }
    CHECK_MESSAGE(same, "not what bolt-sculpt makes: run bolt-sculpt all -o content");
    CHECK(now->size() <= (std::size_t{8} << 20U));
}

}  // namespace

TEST_CASE("Sculpt: regenerating hands, workshop and environment reproduces the committed files") {
    const test::Folder kept;
    const std::filesystem::path& folder = kept.path();
    REQUIRE(sculpt::write_hands(folder).has_value());
    REQUIRE(sculpt::write_workshop(folder).has_value());
    REQUIRE(sculpt::write_environment(folder).has_value());
    check_same(folder, "hands/hand_left.glb");
    check_same(folder, "hands/hand_right.glb");
    check_same(folder, "environments/workshop.glb");
    check_same(folder, "environments/workshop.hdr");
}

TEST_CASE("Sculpt: the committed files are valid models") {
    const Result<assets::Model> hand = assets::read_gltf(content() / "hands/hand_right.glb");
    REQUIRE(hand.has_value());
    CHECK(hand->skins.size() == 1);
    CHECK(hand->skins[0].joints.size() == 26);
    const Result<assets::Model> workshop = assets::read_gltf(content() / "environments/workshop.glb");
    REQUIRE(workshop.has_value());
    CHECK(workshop->lights.size() >= 3);
}

}  // namespace sculpt_content_test
