// A headset on the mock runtime, with its GPU. Any violation that the mock reports and any validation message
// fails the test.
#pragma once

#include <dlfcn.h>
#include <doctest/doctest.h>

#include <cstdlib>

#include "engine/gpu/frames.hpp"
#include "engine/xr/headset.hpp"
#include "tests/mock_openxr/mock_openxr.hpp"
#include "tests/support/need.hpp"

namespace bolt::test {

namespace mock = mock_openxr;

inline mock::Control& control() {
    static mock::Control* one = [] {
        // The loader opens the same library.
        (void)setenv("XR_RUNTIME_JSON", BOLT_MOCK_MANIFEST, 1);
        void* library = dlopen(BOLT_MOCK_OPENXR, RTLD_NOW | RTLD_LOCAL);
        if (library == nullptr) FAIL(dlerror());
        return reinterpret_cast<mock::Control* (*)()>(dlsym(library, "mock_openxr_control"))();
    }();
    return *one;
}

class HeadsetCase {
  public:
    explicit HeadsetCase(const mock::Config& config = {}, xr::SessionOptions session = {}) {
        control().configure(config);
        (void)setenv("XR_RUNTIME_JSON", BOLT_MOCK_MANIFEST, 1);
        xr::HeadsetOptions options;
        options.session = session;
        options.log = [this](const std::string& line) { log.push_back(line); };
        headset = std::make_unique<xr::Headset>(std::move(options));
    }
    HeadsetCase(const HeadsetCase&) = delete;
    HeadsetCase& operator=(const HeadsetCase&) = delete;
    ~HeadsetCase() {
        headset->end();
        images.clear();
        frames.reset();
        device.reset();
        if (instance && !expects_messages)
            for (const std::string& message : instance->log().messages) FAIL_CHECK(message);
        if (!expects_violations)
            for (const std::string& violation : control().violations()) FAIL_CHECK(violation);
    }

    // Finds the headset and starts its session with Vulkan objects that the runtime makes. Returns false if
    // there is none.
    bool connect() {
        if (!headset->find(now += 100.0)) {
            return false;
        }
        images.clear();
        frames.reset();
        device.reset();
        gpu::InstanceOptions instance_options;
        instance_options.validation = true;
        instance_options.creator = headset->creator();
        if (instance) instance_options.log = instance->shared_log();
        instance.reset();
        instance.emplace(need(gpu::Instance::create(instance_options)));
        gpu::DeviceOptions device_options;
        device_options.creator = headset->creator();
        device = need(gpu::Device::create(*instance, device_options));
        frames = need(gpu::Frames::create(*device));
        headset->begin(*device);
        return headset->connected();
    }

    // A frame; true if one was begun. With `draws` the pictures of the eyes are `images`.
    bool frame(bool draws = false) {
        std::optional<xr::HeadsetFrame> begun = headset->begin_frame(0.5);
        if (!begun) return false;
        events.insert(events.end(), begun->events.begin(), begun->events.end());
        headset->locate(*begun);
        const bool drawn = draws && begun->timing.should_render && !begun->view.eyes.empty();
        if (drawn) {
            gpu::FrameContext* recorded = need(frames->begin());
            headset->record(recorded->commands(), images);
            need(frames->submit(*recorded));
        }
        last = *begun;
        headset->end_frame(*begun, drawn, {0.05F, 100.0F});
        return true;
    }
    // Frames until the session has this state.
    bool reach(XrSessionState state) {
        for (int i = 0; i < 20; ++i) {
            if (headset->connected() && headset->session().state() == state) return true;
            (void)frame();
        }
        return false;
    }

    std::vector<std::string> log;
    std::vector<xr::SessionEvent> events;
    std::unique_ptr<xr::Headset> headset;
    std::optional<gpu::Instance> instance;
    std::unique_ptr<gpu::Device> device;
    std::unique_ptr<gpu::Frames> frames;
    std::vector<xr::EyePicture> images;
    xr::HeadsetFrame last;
    double now = 0.0;
    bool expects_violations = false, expects_messages = false;
};

}  // namespace bolt::test
