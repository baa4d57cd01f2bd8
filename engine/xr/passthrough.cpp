#include "engine/xr/passthrough.hpp"

#include <fmt/format.h>

#include <utility>

namespace bolt::xr {

PassthroughLayer::PassthroughLayer(const Runtime& runtime, XrSession session)
    : runtime_(runtime.extensions().passthrough ? &runtime : nullptr), session_(session) {}

PassthroughLayer::PassthroughLayer(PassthroughLayer&& other) noexcept { *this = std::move(other); }

PassthroughLayer& PassthroughLayer::operator=(PassthroughLayer&& other) noexcept {
    std::swap(runtime_, other.runtime_);
    std::swap(session_, other.session_);
    std::swap(passthrough_, other.passthrough_);
    std::swap(layer_, other.layer_);
    std::swap(shown_, other.shown_);
    std::swap(refused_, other.refused_);
    std::swap(interrupted_, other.interrupted_);
    std::swap(messages_, other.messages_);
    return *this;
}

bool PassthroughLayer::available() const { return runtime_ != nullptr && !refused_ && !interrupted_; }

Status PassthroughLayer::create() {
    const ExtensionFunctions& f = runtime_->functions();
    if (passthrough_ == XR_NULL_HANDLE) {
        const XrPassthroughCreateInfoFB info{XR_TYPE_PASSTHROUGH_CREATE_INFO_FB, nullptr, 0};
        BOLT_TRY(check(f.create_passthrough(session_, &info, &passthrough_), "xrCreatePassthroughFB"));
    }
    if (layer_ == XR_NULL_HANDLE) {
        const XrPassthroughLayerCreateInfoFB info{XR_TYPE_PASSTHROUGH_LAYER_CREATE_INFO_FB, nullptr,
                                                  passthrough_, 0,
                                                  XR_PASSTHROUGH_LAYER_PURPOSE_RECONSTRUCTION_FB};
        BOLT_TRY(check(f.create_passthrough_layer(session_, &info, &layer_), "xrCreatePassthroughLayerFB"));
    }
    return {};
}

Status PassthroughLayer::start() {
    const ExtensionFunctions& f = runtime_->functions();
    BOLT_TRY(create());
    BOLT_TRY(check(f.start_passthrough(passthrough_), "xrPassthroughStartFB"));
    return check(f.resume_passthrough_layer(layer_), "xrPassthroughLayerResumeFB");
}

Status PassthroughLayer::pause() {
    const ExtensionFunctions& f = runtime_->functions();
    BOLT_TRY(check(f.pause_passthrough_layer(layer_), "xrPassthroughLayerPauseFB"));
    return check(f.pause_passthrough(passthrough_), "xrPassthroughPauseFB");
}

void PassthroughLayer::destroy() {
    shown_ = false;
    if (layer_ != XR_NULL_HANDLE)
        (void)runtime_->functions().destroy_passthrough_layer(std::exchange(layer_, XR_NULL_HANDLE));
    if (passthrough_ != XR_NULL_HANDLE)
        (void)runtime_->functions().destroy_passthrough(std::exchange(passthrough_, XR_NULL_HANDLE));
}

Status PassthroughLayer::show(bool wanted) {
    const bool shows = wanted && available();
    if (shows == shown_) return {};
    const Status done = shows ? start() : pause();
    if (done) {
        shown_ = shows;
        return {};
    }
    if (done.error().lost) return done;
    refused_ = true;
    destroy();
    messages_.push_back(fmt::format("the headset {} the real room: {}",
                                    shows ? "does not show" : "can no longer show", done.error().message()));
    return {};
}

XrCompositionLayerPassthroughFB PassthroughLayer::composition_layer() const {
    return {XR_TYPE_COMPOSITION_LAYER_PASSTHROUGH_FB, nullptr,
            XR_COMPOSITION_LAYER_BLEND_TEXTURE_SOURCE_ALPHA_BIT, XR_NULL_HANDLE, layer_};
}

void PassthroughLayer::handle(const XrEventDataPassthroughStateChangedFB& event) {
    const auto has = [&](XrPassthroughStateChangedFlagsFB flag) { return (event.flags & flag) != 0; };
    if (has(XR_PASSTHROUGH_STATE_CHANGED_NON_RECOVERABLE_ERROR_BIT_FB)) {
        refused_ = true;
        destroy();
        messages_.emplace_back(
            "the headset does not show the real room: its cameras have failed; expected a "
            "restart of the headset");
    } else if (has(XR_PASSTHROUGH_STATE_CHANGED_REINIT_REQUIRED_BIT_FB)) {
        destroy();  // the next show() creates it again
    }
    if (has(XR_PASSTHROUGH_STATE_CHANGED_RECOVERABLE_ERROR_BIT_FB) && !std::exchange(interrupted_, true))
        messages_.emplace_back("the headset does not show the real room for now");
    if (has(XR_PASSTHROUGH_STATE_CHANGED_RESTORED_ERROR_BIT_FB) && std::exchange(interrupted_, false))
        messages_.emplace_back("the headset can show the real room again");
}

}  // namespace bolt::xr
