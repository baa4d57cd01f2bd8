#include "tests/mock_openxr/mock_runtime.hpp"

#include <dlfcn.h>
#include <doctest/doctest.h>

namespace bolt::test {

const mock::Control& mock_control() {
    static const mock::Control& control = [&]() -> const mock::Control& {
        void* library = dlopen(BOLT_MOCK_OPENXR, RTLD_NOW | RTLD_LOCAL);
        if (library == nullptr) FAIL(dlerror());
        void* function = dlsym(library, "mock_openxr_control");
        REQUIRE(function != nullptr);
        return *reinterpret_cast<mock::ControlFunction>(function)();
    }();
    return control;
}

MockRuntime::MockRuntime(const mock::Config& config) : active_("XR_RUNTIME_JSON", BOLT_MOCK_OPENXR_MANIFEST) {
    mock_control().reset();
    mock_control().configure(config);
}

MockRuntime::~MockRuntime() {
    for (const std::string& violation : mock_control().take_violations()) CHECK_MESSAGE(false, violation);
    mock_control().reset();
    // The loader keeps a runtime, with the extensions that it had, until an instance is destroyed.
    XrInstanceCreateInfo info{XR_TYPE_INSTANCE_CREATE_INFO};
    info.applicationInfo.applicationName[0] = 't';
    info.applicationInfo.apiVersion = XR_MAKE_VERSION(1, 0, 0);
    XrInstance instance = XR_NULL_HANDLE;
    if (XR_SUCCEEDED(xrCreateInstance(&info, &instance))) (void)xrDestroyInstance(instance);
    mock_control().reset();
}

}  // namespace bolt::test
