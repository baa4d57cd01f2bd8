#include <doctest/doctest.h>

#include "tests/support/eventually.hpp"
#include "tests/xr/support.hpp"

using namespace bolt;

namespace {

// The program finds no headset, goes on, and says why in a line that contains `reason`.
void check_absent(test::Program& program, const std::string& reason) {
    CHECK_FALSE(program.connect());
    REQUIRE(program.headset().absence().has_value());
    const Error& error = *program.headset().absence();
    CHECK(error.code == ErrorCode::no_device);
    CHECK_MESSAGE(error.message().find(reason) != std::string::npos, error.message());
    CHECK_FALSE(program.headset().exit_requested());
    CHECK_FALSE(program.headset().connected());
    CHECK(program.headset().creator() == nullptr);
    CHECK_FALSE(program.frame().has_value());
    REQUIRE(program.lines().size() == 1);
    CHECK(program.lines()[0] == error.message());
}

}  // namespace

TEST_CASE("Headset: without a runtime there is none, and the program goes on") {
    const test::EnvironmentVariable active("XR_RUNTIME_JSON", "/nowhere/openxr.json");
    test::Program program;
    check_absent(program, "no OpenXR runtime");
    CHECK(program.headset().absence()->message().find("expected an active runtime") != std::string::npos);
    // The same reason is not repeated.
    CHECK_FALSE(program.connect());
    CHECK(program.lines().size() == 1);
}

TEST_CASE("Headset: one that is connected later is found") {
    const test::MockRuntime mock;
    mock->connect(false);
    test::Program program;
    check_absent(program, "no headset is connected to Mock runtime 1.2.3");
    mock->connect(true);
    REQUIRE(program.connect());
    CHECK_FALSE(program.headset().absence().has_value());
    CHECK(program.focus().focused);
}

TEST_CASE("Headset: a search is made at most once a second") {
    const test::MockRuntime mock;
    mock->connect(false);
    xr::Headset headset({});
    CHECK_FALSE(headset.find(10.0));
    mock->connect(true);
    CHECK_FALSE(headset.find(10.9));
    CHECK(mock->calls("xrGetSystem") == 1);
    CHECK(headset.find(11.1));
    CHECK(mock->calls("xrGetSystem") == 2);
    CHECK_FALSE(headset.find(20.0));  // it is there already
}

TEST_CASE("Headset: the search queries one instance, and makes a new one after a loss and each half minute") {
    const test::MockRuntime mock;
    mock->connect(false);
    xr::Headset headset({});
    for (const double now : {10.0, 12.0, 14.0, 38.0}) CHECK_FALSE(headset.find(now));
    CHECK(mock->calls("xrGetSystem") == 4);
    CHECK(mock->calls("xrCreateInstance") == 1);
    CHECK_FALSE(headset.find(41.0));  // the user may have chosen another runtime
    CHECK(mock->calls("xrCreateInstance") == 2);
    mock->fail_next("xrGetSystem", XR_ERROR_INSTANCE_LOST, 1);
    CHECK_FALSE(headset.find(43.0));
    CHECK(mock->instance() == XR_NULL_HANDLE);
    CHECK_FALSE(headset.find(45.0));
    CHECK(mock->calls("xrCreateInstance") == 3);
    mock->connect(true);
    CHECK(headset.find(47.0));
    CHECK(mock->calls("xrCreateInstance") == 3);
}

TEST_CASE("Headset: a search in the background does not wait for a runtime that hangs") {
    const test::MockRuntime mock;
    mock->block_call("xrGetSystem");
    xr::Headset headset({});
    for (int i = 0; i < 5; ++i) CHECK_FALSE(headset.find_in_background(10.0 + i));
    CHECK(mock->calls("xrGetSystem") == 0);  // the call of the search is inside the runtime
    CHECK_FALSE(headset.absence().has_value());
    mock->block_call("");
    CHECK(test::eventually([&] { return headset.find_in_background(20.0); }));
    CHECK(headset.creator() != nullptr);
    CHECK(mock->calls("xrGetSystem") == 1);
    CHECK(mock->calls("xrCreateInstance") == 1);
}

TEST_CASE("Headset: after each session that does not start, the next search waits longer, at most a minute") {
    const test::MockRuntime mock;
    test::Program program;
    REQUIRE(program.connect());
    gpu::Device& device = program.device();
    xr::Headset headset({});
    program.headset().end();
    double now = 0.0;
    std::vector<double> waits;
    for (int i = 0; i < 9; ++i) {
        double wait = 0.5;
        while (!headset.find(now + wait)) wait += 0.5;
        now += wait;
        waits.push_back(wait);
        mock->fail_next("xrCreateSession", XR_ERROR_RUNTIME_FAILURE, 1);
        headset.begin(device);
        REQUIRE_FALSE(headset.connected());
    }
    const std::vector<double> expected{0.5, 2.0, 4.0, 8.0, 16.0, 32.0, 60.0, 60.0, 60.0};
    CHECK(waits == expected);
}

TEST_CASE("Headset: a runtime without Vulkan is not used") {
    mock::Config config;
    config.extensions = {"XR_KHR_composition_layer_depth"};
    const test::MockRuntime mock(config);
    test::Program program;
    check_absent(program, "does not support Vulkan");
}

TEST_CASE("Headset: one that needs a newer Vulkan than the program is not used") {
    mock::Config config;
    config.min_vulkan = XR_MAKE_VERSION(1, 4, 0);
    const test::MockRuntime mock(config);
    xr::Headset headset({});
    REQUIRE_MESSAGE(headset.find(0.0), headset.absence()->message());
    gpu::InstanceOptions options;
    options.creator = headset.creator();
    const Result<gpu::Instance> instance = gpu::Instance::create(options);
    REQUIRE_FALSE(instance.has_value());
    CHECK(instance.error().message() ==
          "Mock runtime 1.2.3 needs Vulkan 1.4; expected a runtime that supports Vulkan 1.3");
}

TEST_CASE("Headset: an image format that the program cannot use is an error, not a crash") {
    mock::Config config;
    config.formats = {91};  // R16G16B16A16_UNORM
    const test::MockRuntime mock(config);
    test::Program program;
    CHECK_FALSE(program.connect());
    REQUIRE(program.headset().absence().has_value());
    CHECK(program.headset().absence()->message().find("no usable image format") != std::string::npos);
    CHECK(mock->instance() == XR_NULL_HANDLE);
}
