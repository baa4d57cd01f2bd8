// The mock headset as the active OpenXR runtime of a test. Link mock_openxr_paths.
#pragma once

#include "tests/mock_openxr/mock_openxr.hpp"
#include "tests/support/environment.hpp"

namespace bolt::test {

const mock::Control& mock_control();

// The mock is the active runtime during the test, with its defaults. At the end, every violation of OpenXR's
// rules fails the test.
class MockRuntime {
  public:
    explicit MockRuntime(const mock::Config& config = {});
    MockRuntime(const MockRuntime&) = delete;
    MockRuntime& operator=(const MockRuntime&) = delete;
    ~MockRuntime();

    const mock::Control* operator->() const { return &mock_control(); }

  private:
    EnvironmentVariable active_;
};

}  // namespace bolt::test
