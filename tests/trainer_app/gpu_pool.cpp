#include "tests/trainer_app/gpu_pool.hpp"

#include <doctest/doctest.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <vector>

#include "tests/support/need.hpp"

namespace bolt::test {

namespace {

std::vector<std::unique_ptr<PooledGpu>>& free_gpus() {
    static std::vector<std::unique_ptr<PooledGpu>> gpus;
    return gpus;
}

view::GpuContext make_context(const gpu::Instance& instance) {
    render::RendererOptions options;
    options.level_error_px = 0.7F;  // as in the window
    options.shadow_size = 256;      // enough for such small pictures
    return need(view::make_gpu_context(instance, {}, options));
}

// Destroys the GPUs before the program's static objects, among which are those of the driver. The validation
// layers then report Vulkan objects that a test case did not destroy.
class PoolListener final : public doctest::IReporter {
  public:
    explicit PoolListener(const doctest::ContextOptions& /*options*/) {}

    void test_run_end(const doctest::TestRunStats& /*stats*/) override {
        for (std::unique_ptr<PooledGpu>& gpu : free_gpus()) {
            gpu->context.renderer.reset();
            gpu->context.frames.reset();
            gpu->context.device.reset();
            for (const std::string& message : gpu->instance.log().messages)
                (void)std::fprintf(stderr, "after all test cases: %s\n", message.c_str());
            if (!gpu->instance.log().messages.empty()) std::_Exit(EXIT_FAILURE);
        }
        free_gpus().clear();
    }

    void report_query(const doctest::QueryData& /*data*/) override {}
    void test_run_start() override {}
    void test_case_start(const doctest::TestCaseData& /*data*/) override {}
    void test_case_reenter(const doctest::TestCaseData& /*data*/) override {}
    void test_case_end(const doctest::CurrentTestCaseStats& /*stats*/) override {}
    void test_case_exception(const doctest::TestCaseException& /*exception*/) override {}
    void subcase_start(const doctest::SubcaseSignature& /*subcase*/) override {}
    void subcase_end() override {}
    void log_assert(const doctest::AssertData& /*data*/) override {}
    void log_message(const doctest::MessageData& /*data*/) override {}
    void test_case_skipped(const doctest::TestCaseData& /*data*/) override {}
};

}  // namespace

REGISTER_LISTENER("gpu_pool", 1, PoolListener);

BorrowedGpu::BorrowedGpu() {
    if (!free_gpus().empty()) {
        gpu_ = std::move(free_gpus().back());
        free_gpus().pop_back();
        return;
    }
    gpu::InstanceOptions validated;
    validated.validation = true;
    gpu::Instance instance = need(gpu::Instance::create(validated));
    view::GpuContext context = make_context(instance);
    gpu_ = std::make_unique<PooledGpu>(PooledGpu{std::move(instance), std::move(context)});
}

BorrowedGpu::~BorrowedGpu() {
    if (std::uncaught_exceptions() == 0 && gpu_->instance.log().messages.empty())
        free_gpus().push_back(std::move(gpu_));
}

void BorrowedGpu::lose() {
    (void)gpu_->context.device->idle();
    gpu_->context.renderer.reset();
    gpu_->context.frames.reset();
    gpu_->context.device.reset();
    gpu_->context = make_context(gpu_->instance);
}

}  // namespace bolt::test
