#include "tests/gpu/support.hpp"

namespace bolt::test {

Gpu::Gpu() {
    gpu::InstanceOptions options;
    options.validation = true;
    instance_ = std::make_unique<gpu::Instance>(need(gpu::Instance::create(options)));
    device_ = need(gpu::Device::create(*instance_, {}));
}

Gpu::~Gpu() {
    device_.reset();  // validation also reports objects that still exist
    if (expects_messages_) return;
    for (const std::string& message : log().messages) CHECK_MESSAGE(false, message);
}

}  // namespace bolt::test
