#include "engine/xr/controller_profiles.hpp"

#include <fmt/format.h>

namespace bolt::xr {

namespace {

constexpr ControllerProfile profiles[] = {
    // Select and grasp share one button. The target under the hand determines which of them applies.
    {"/interaction_profiles/khr/simple_controller",
     "input/select/click",
     "input/select/click",
     nullptr,
     {"input/menu/click", "input/menu/click"},
     {nullptr, nullptr}},
    {"/interaction_profiles/oculus/touch_controller",
     "input/trigger/value",
     "input/squeeze/value",
     "input/thumbstick",
     {"input/menu/click", "input/b/click"},
     {"input/x/click", "input/a/click"}},
    {"/interaction_profiles/valve/index_controller",
     "input/trigger/value",
     "input/squeeze/value",
     "input/thumbstick",
     {"input/b/click", "input/b/click"},
     {"input/a/click", "input/a/click"}},
    {"/interaction_profiles/htc/vive_controller",
     "input/trigger/value",
     "input/squeeze/click",
     "input/trackpad",
     {"input/menu/click", "input/menu/click"},
     {"input/trackpad/click", "input/trackpad/click"}},
    {"/interaction_profiles/microsoft/motion_controller",
     "input/trigger/value",
     "input/squeeze/click",
     "input/thumbstick",
     {"input/menu/click", "input/menu/click"},
     {"input/thumbstick/click", "input/thumbstick/click"}},
    {"/interaction_profiles/ext/hand_interaction_ext",
     "input/pinch_ext/value",
     "input/grasp_ext/value",
     nullptr,
     {nullptr, nullptr},
     {nullptr, nullptr},
     false,
     true},
};

}  // namespace

std::span<const ControllerProfile> controller_profiles() { return profiles; }

Result<XrPath> path_of(XrInstance instance, const std::string& text) {
    XrPath path = XR_NULL_PATH;
    BOLT_TRY(
        check(xrStringToPath(instance, text.c_str(), &path), fmt::format("xrStringToPath(\"{}\")", text)));
    return path;
}

Result<std::string> text_of(XrInstance instance, XrPath path) {
    std::array<char, XR_MAX_PATH_LENGTH> text{};
    std::uint32_t length = 0;
    BOLT_TRY(
        check(xrPathToString(instance, path, static_cast<std::uint32_t>(text.size()), &length, text.data()),
              "xrPathToString"));
    return std::string(text.data());
}

Result<bool> suggest_bindings_of(const char* profile, std::span<const XrActionSuggestedBinding> bindings,
                                 XrInstance instance) {
    BOLT_TRY_ASSIGN(const auto path, path_of(instance, profile));
    XrInteractionProfileSuggestedBinding suggested{XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING};
    suggested.interactionProfile = path;
    suggested.countSuggestedBindings = static_cast<std::uint32_t>(bindings.size());
    suggested.suggestedBindings = bindings.data();
    const XrResult result = xrSuggestInteractionProfileBindings(instance, &suggested);
    if (result == XR_ERROR_PATH_UNSUPPORTED) return false;
    BOLT_TRY(check(result, fmt::format("xrSuggestInteractionProfileBindings(\"{}\")", profile)));
    // Any other success, such as XR_SESSION_LOSS_PENDING, does not mean that the controller can be used.
    return result == XR_SUCCESS;
}

}  // namespace bolt::xr
