// The mock driven by a script, in a process of its own: the test runs this program again, where the same test
// case plays the client.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/support/folder.hpp"
#include "tests/xr/support.hpp"

using namespace bolt;

namespace {

std::string content_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

// Runs the test case in another process, with this script. Returns the report.
std::string run_script(const test::Folder& folder, const std::string& script, const std::string& test_case) {
    std::ofstream(folder / "script") << "0 report " << (folder / "report").string() << "\n" << script;
    const test::EnvironmentVariable runtime("XR_RUNTIME_JSON", BOLT_MOCK_OPENXR_MANIFEST);
    const test::EnvironmentVariable file("MOCK_OPENXR_SCRIPT", (folder / "script").c_str());
    const std::string self = std::filesystem::read_symlink("/proc/self/exe");
    const std::string command =
        fmt::format("'{}' '--test-case={}' >'{}' 2>&1", self, test_case, (folder / "output").string());
    const int status = std::system(command.c_str());
    CHECK_MESSAGE(status == 0, content_of(folder / "output"));
    return content_of(folder / "report");
}

bool is_guest() { return std::getenv("MOCK_OPENXR_SCRIPT") != nullptr; }

}  // namespace

TEST_CASE("Script: drives the headset by the number of the frame") {
    if (!is_guest()) {
        const test::Folder folder;
        const std::string script = fmt::format(
            "# a comment\n"
            "\n"
            "0 config width 40\n"
            "0 config height 20\n"
            "0 config period 0.001\n"
            "0 config with XR_EXT_local_floor\n"
            "20 head 0.25 1.5 0.5 0 0 0 1\n"
            "20 hand right grip 0.1 1.0 -0.3 0 0 0 1\n"
            "20 hand right trigger 0.5\n"
            "20 hand left joints 1\n"
            "30 picture {}\n"
            "40 event stopping\n"
            "45 event ready\n"
            "60 exit\n",
            (folder / "picture.ppm").string());
        const std::string report =
            run_script(folder, script, "Script: drives the headset by the number of the frame");
        CHECK(report.find("violation") == std::string::npos);
        CHECK(report.find("vibrations 1\n") != std::string::npos);
        const std::string picture = content_of(folder / "picture.ppm");
        REQUIRE(picture.size() == std::string("P6\n80 20\n255\n").size() + 3 * 80 * 20);
        CHECK(picture.rfind("P6\n80 20\n255\n", 0) == 0);
        CHECK(static_cast<unsigned char>(picture[13]) == 90);  // left, then right
        CHECK(static_cast<unsigned char>(picture.back()) == 180);
        return;
    }
    test::Program program;
    REQUIRE(program.connect());
    CHECK(program.headset().session().extent().width == 40);
    bool moved = false, paused = false, has_joints = false;
    for (int i = 0; i < 400 && !program.headset().exit_requested(); ++i) {
        const std::optional<xr::HeadsetFrame> frame = program.frame();
        const bool was_running = program.headset().running();
        if (!frame) {
            paused = paused || (moved && !was_running);
            continue;
        }
        const xr::HandInput& right = frame->hands[xr::Side::right];
        if (right.select != 0.5F) continue;
        CHECK(frame->view.head.position == Vec3(0.25, 1.5, 0.5));
        REQUIRE(right.grip.has_value());
        CHECK(right.grip->pose.position.x == doctest::Approx(0.1));
        has_joints = has_joints || frame->hands[xr::Side::left].joints.has_value();
        if (!moved) program.headset().vibrate(xr::Side::right, {1.0F, 0.0F, 0.1});
        moved = true;
    }
    CHECK(moved);
    CHECK(paused);
    CHECK(has_joints);
    CHECK(program.headset().exit_requested());
}

TEST_CASE("Script: loses the runtime and finds it again") {
    if (!is_guest()) {
        const test::Folder folder;
        const std::string report = run_script(
            folder, "0 config period 0.001\n10 fail xrEndFrame -13 1\n10 headset 0\n14 headset 1\n",
            "Script: loses the runtime and finds it again");
        CHECK(report.find("violation") == std::string::npos);
        return;
    }
    test::Program program;
    REQUIRE(program.connect());
    for (int i = 0; i < 100 && program.headset().connected(); ++i) (void)program.frame();
    CHECK_FALSE(program.headset().connected());
    int searches = 0;
    for (; searches < 10 && !program.connect(); ++searches) {
    }
    CHECK(searches > 1);
    REQUIRE(program.headset().connected());
    CHECK(program.focus().focused);
}

TEST_CASE("Script: a line that is not understood is reported") {
    if (!is_guest()) {
        const test::Folder folder;
        const std::string report = run_script(folder,
                                              "jump\n"
                                              "0 config colour 3\n"
                                              "0 head 1 2\n"
                                              "0 hand middle trigger 1\n"
                                              "0 event nothing\n"
                                              "0 hand left menu 1 2\n"
                                              "0 hand left trigger 1x\n",
                                              "Script: a line that is not understood is reported");
        const std::string place = "violation script: " + (folder / "script").string();
        for (const char* expected :
             {":2: does not begin with a frame number\n", ":3: unknown word colour\n",
              ":4: an argument is missing\n", ":5: unknown word middle\n", ":6: unknown word nothing\n",
              ":7: an argument too many\n", ":8: 1x is no number\n"})
            CHECK_MESSAGE(report.find(place + expected) != std::string::npos, expected);
        return;
    }
    xr::Headset headset({});
    CHECK(headset.find(0.0));
}
