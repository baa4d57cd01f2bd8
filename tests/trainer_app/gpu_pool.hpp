// The GPUs of the trainers without a window. The test cases of a program use one GPU one after another, as
// the lessons of the trainer do, because creating all pipelines again takes a second of CPU time on lavapipe.
#pragma once

#include <memory>
#include <utility>

#include "engine/gpu/device.hpp"
#include "game/view/gpu_context.hpp"

namespace bolt::test {

// A GPU under the validation layers.
struct PooledGpu {
    gpu::Instance instance;
    view::GpuContext context;
};

// Borrows a GPU from the pool, or creates one if all are in use; its destructor puts the GPU into the pool. A
// GPU with messages of the validation layers is not used again, so that each test case fails for its own
// messages only.
class BorrowedGpu {
  public:
    BorrowedGpu();
    BorrowedGpu(const BorrowedGpu&) = delete;
    BorrowedGpu& operator=(const BorrowedGpu&) = delete;
    ~BorrowedGpu();

    [[nodiscard]] const gpu::Instance& instance() const { return gpu_->instance; }
    [[nodiscard]] view::GpuContext& context() { return gpu_->context; }
    // Destroys the device and what was created from it, and creates new ones, as the window does after a
    // loss.
    void lose();

  private:
    std::unique_ptr<PooledGpu> gpu_;
};

}  // namespace bolt::test
