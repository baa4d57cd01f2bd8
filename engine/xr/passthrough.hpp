// Shows the picture of the headset's cameras as a composition layer under the rendered one
// (XR_FB_passthrough), for runtimes without the blend mode ALPHA_BLEND, such as those of Quest headsets. The
// layer and its cameras run only while they are wanted.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/xr/runtime.hpp"

namespace bolt::xr {

class PassthroughLayer {
  public:
    PassthroughLayer() = default;  // cannot be shown
    // `runtime` and `session` must outlive the layer. It can be shown if the runtime has the extension.
    PassthroughLayer(const Runtime& runtime, XrSession session);
    PassthroughLayer(PassthroughLayer&& other) noexcept;
    PassthroughLayer& operator=(PassthroughLayer&& other) noexcept;
    PassthroughLayer(const PassthroughLayer&) = delete;
    PassthroughLayer& operator=(const PassthroughLayer&) = delete;
    ~PassthroughLayer() { destroy(); }

    // False if there is no extension, a call was refused, or the runtime has reported an error.
    [[nodiscard]] bool available() const;

    // Starts or pauses the layer; creates it when it is first wanted. If a call is refused, the layer is
    // destroyed and no longer available, and the reason is in take_messages(). Fails only if session or
    // instance are lost.
    Status show(bool wanted);
    [[nodiscard]] bool shown() const { return shown_; }
    // Submit it below the projection layer while shown() is true.
    [[nodiscard]] XrCompositionLayerPassthroughFB composition_layer() const;

    // Updates the layer and the messages after an event of the runtime.
    void handle(const XrEventDataPassthroughStateChangedFB& event);

    // Lines for the user about changes of the layer since the last call.
    std::vector<std::string> take_messages() { return std::exchange(messages_, {}); }

  private:
    Status create();
    Status start();
    Status pause();
    void destroy();

    const Runtime* runtime_ = nullptr;  // null: cannot be shown
    XrSession session_ = XR_NULL_HANDLE;
    XrPassthroughFB passthrough_ = XR_NULL_HANDLE;
    XrPassthroughLayerFB layer_ = XR_NULL_HANDLE;
    bool shown_ = false;
    bool refused_ = false;      // for the rest of the session
    bool interrupted_ = false;  // by an error that the runtime may repair
    std::vector<std::string> messages_;
};

}  // namespace bolt::xr
