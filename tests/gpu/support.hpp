// A GPU for a test, with validation layers. Any validation message fails the test.
#pragma once

#include <doctest/doctest.h>

#include <memory>

#include "engine/gpu/device.hpp"

namespace bolt::test {

class Gpu {
  public:
    Gpu();
    ~Gpu();
    Gpu(const Gpu&) = delete;
    Gpu& operator=(const Gpu&) = delete;

    gpu::Device& device() { return *device_; }
    [[nodiscard]] const gpu::ValidationLog& log() const { return instance_->log(); }
    // For tests of validation itself: messages are expected, and the test counts them.
    void expect_messages() { expects_messages_ = true; }

    template <class T>
    T need(Result<T> result) {
        if (!result) FAIL(result.error().message());
        return std::move(*result);
    }
    void need(const Status& status) {
        if (!status) FAIL(status.error().message());
    }

  private:
    std::unique_ptr<gpu::Instance> instance_;
    std::unique_ptr<gpu::Device> device_;
    bool expects_messages_ = false;
};

}  // namespace bolt::test
