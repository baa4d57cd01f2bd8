// Tests of the golden-image checker: it detects differences, reports them, and never passes without a
// comparison.
#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "engine/base/random.hpp"
#include "tests/golden/golden_studio.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/skip.hpp"
#include "tools/verify/imagediff/flip.hpp"

using namespace bolt;
using test::Folder;

namespace {

render::Picture noise() {
    render::Picture picture{40, 30, {}};
    Random random(7);
    for (std::uint32_t i = 0; i < 4 * picture.width * picture.height; ++i)
        picture.rgba.push_back(static_cast<std::uint8_t>(64 + random.bits() % 128));
    return picture;
}

// A checker with this picture as its only reference.
test::ReferencePictures with_reference(const Folder& folder, const render::Picture& picture) {
    test::ReferencePictures pictures{folder / "references", folder / "failures", "driver A", "driver A",
                                     true};
    REQUIRE(test::compare_with_reference(pictures, "noise", picture).passes);
    pictures.update = false;
    return pictures;
}

}  // namespace

TEST_CASE("Golden: on the pinned driver one pixel that differs by one level fails and is shown") {
    const Folder folder;
    render::Picture picture = noise();
    const test::ReferencePictures pictures = with_reference(folder, picture);
    CHECK(test::compare_with_reference(pictures, "noise", picture).passes);
    CHECK_FALSE(std::filesystem::exists(pictures.failures));
    picture.rgba[4 * 627 + 1] ^= 1U;
    const test::PictureComparison comparison = test::compare_with_reference(pictures, "noise", picture);
    CHECK_FALSE(comparison.passes);
    CHECK(comparison.why.find("largest difference 1 of 255") != std::string::npos);
    const auto actual = imagediff::read_png(pictures.failures / "noise.actual.png");
    const auto difference = imagediff::read_png(pictures.failures / "noise.difference.png");
    REQUIRE(actual.has_value());
    REQUIRE(difference.has_value());
    CHECK(actual->rgb[3 * 627 + 1] == picture.rgba[4 * 627 + 1]);
    CHECK(difference->rgb[3 * 627 + 1] == 255);  // amplified to be visible
    CHECK(std::count(difference->rgb.begin(), difference->rgb.end(), 0) ==
          static_cast<std::ptrdiff_t>(difference->rgb.size()) - 1);
}

TEST_CASE("Golden: on another driver small differences pass; a changed patch and a shifted picture do not") {
    const Folder folder;
    const render::Picture picture = noise();
    test::ReferencePictures pictures = with_reference(folder, picture);
    pictures.driver = "driver B";
    render::Picture rounded = picture;
    for (std::size_t i = 0; i < rounded.rgba.size(); i += 3) rounded.rgba[i] ^= 1U;
    CHECK(test::compare_with_reference(pictures, "noise", rounded).passes);
    render::Picture patched = picture;
    for (std::size_t i = 4 * 400; i < 4 * 440; ++i) patched.rgba[i] = 255;
    CHECK_FALSE(test::compare_with_reference(pictures, "noise", patched).passes);
    render::Picture shifted = picture;
    std::rotate(shifted.rgba.begin(), shifted.rgba.begin() + 4, shifted.rgba.end());
    CHECK_FALSE(test::compare_with_reference(pictures, "noise", shifted).passes);
}

TEST_CASE("Golden: a missing reference fails and is not created; another size fails too") {
    const Folder folder;
    const render::Picture picture = noise();
    const test::ReferencePictures pictures = with_reference(folder, picture);
    const test::PictureComparison missing = test::compare_with_reference(pictures, "unheard-of", picture);
    CHECK_FALSE(missing.passes);
    CHECK(missing.why.find("no reference") != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(pictures.references / "unheard-of.png"));
    CHECK(std::filesystem::exists(pictures.failures / "unheard-of.actual.png"));
    const render::Picture taller{picture.height, picture.width, picture.rgba};
    CHECK_FALSE(test::compare_with_reference(pictures, "noise", taller).passes);
}

TEST_CASE("Golden: a driver has the references of its version, a new version those of the first") {
    const Folder folder;
    const std::string older = "llvmpipe Mesa 22.3.6 (LLVM 15.0.6)",
                      newer = "llvmpipe Mesa 25.0.7 (LLVM 19.1.7)";
    const auto of_older = folder / "llvmpipe-Mesa-22.3.6-LLVM-15.0.6";
    const auto of_newer = folder / "llvmpipe-Mesa-25.0.7-LLVM-19.1.7";
    CHECK(test::references_for(folder / ".", older, true).filename() == of_older.filename());
    std::filesystem::create_directories(of_newer);
    std::filesystem::create_directories(of_older);
    CHECK(test::references_for(folder / ".", older, false).filename() == of_older.filename());
    CHECK(test::references_for(folder / ".", newer, false).filename() == of_newer.filename());
    CHECK(test::references_for(folder / ".", "radv Mesa 26.1.0", false).filename() == of_older.filename());
    CHECK(test::references_for(folder / ".", "radv Mesa 26.1.0", true).filename() == "radv-Mesa-26.1.0");
}

TEST_CASE("Golden: every version of a driver has the same pictures, and the current driver is known") {
    const test::GoldenStudio golden;
    CHECK_FALSE(golden.pictures.driver.empty());
    std::map<std::string, std::set<std::string>> names;  // of pictures, by folder
    const auto pictures = golden.pictures.references.parent_path();
    for (const auto& file : std::filesystem::recursive_directory_iterator(pictures))
        if (file.is_regular_file())
            names[file.path().parent_path().filename()].insert(file.path().filename());
    REQUIRE(names.size() >= 2);
    for (const auto& entry : names) {
        const auto& folder = entry.first;
        const auto& in_folder = entry.second;
        CAPTURE(folder);
        CHECK(in_folder.contains("driver.txt"));
        CHECK(in_folder == names.begin()->second);
    }
    if (golden.pictures.driver != golden.pictures.pinned_driver)
        test::skip_part("pictures are compared within a tolerance, not exactly: this driver is " +
                        golden.pictures.driver + "; expected " + golden.pictures.pinned_driver);
}
