// The controllers that the program knows, as OpenXR interaction profiles, for the hands of a lesson
// (input.hpp) and for a controller that tracks the head or measures points (pose_tracker.hpp).
#pragma once

#include <array>
#include <span>
#include <string>

#include "engine/xr/openxr.hpp"

namespace bolt::xr {

inline constexpr std::array<const char*, 2> hand_paths{"/user/hand/left", "/user/hand/right"};  // by Side

// The paths of a controller's inputs, relative to the path of the hand; null: it has no such input.
struct ControllerProfile {
    const char* path;  // its interaction profile
    const char* select;
    const char* grasp;
    const char* stick;
    std::array<const char*, 2> menu, secondary;  // by Side
    bool vibrates = true;
    bool needs_hand_interaction = false;  // for bare hands, with XR_EXT_hand_interaction
};
std::span<const ControllerProfile> controller_profiles();

Result<XrPath> path_of(XrInstance instance, const std::string& text);
Result<std::string> text_of(XrInstance instance, XrPath path);

// Suggests bindings for an interaction profile. Returns false if the runtime does not know the profile or one
// of the paths; other profiles still work.
Result<bool> suggest_bindings_of(const char* profile, std::span<const XrActionSuggestedBinding> bindings,
                                 XrInstance instance);

}  // namespace bolt::xr
