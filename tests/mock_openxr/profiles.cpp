// Interaction profiles of the OpenXR specification, section 6.4, and of XR_EXT_hand_interaction.
#include <string_view>

#include "tests/mock_openxr/state.hpp"

namespace bolt::mock {

namespace {

struct Profile {
    std::string_view path;
    // Inputs and outputs below the hand's path, separated by spaces: of both hands, the left one, the right
    // one.
    std::string_view both, left, right;
};

constexpr Profile profiles[] = {
    {"/interaction_profiles/khr/simple_controller",
     "input/select/click input/menu/click input/grip/pose input/aim/pose output/haptic", "", ""},
    {"/interaction_profiles/oculus/touch_controller",
     "input/squeeze/value input/trigger/value input/trigger/touch input/thumbstick/x input/thumbstick/y "
     "input/thumbstick/click input/thumbstick/touch input/thumbrest/touch input/grip/pose input/aim/pose "
     "output/haptic",
     "input/x/click input/x/touch input/y/click input/y/touch input/menu/click",
     "input/a/click input/a/touch input/b/click input/b/touch input/system/click"},
    {"/interaction_profiles/valve/index_controller",
     "input/system/click input/system/touch input/a/click input/a/touch input/b/click input/b/touch "
     "input/squeeze/value input/squeeze/force input/trigger/click input/trigger/value input/trigger/touch "
     "input/thumbstick/x input/thumbstick/y input/thumbstick/click input/thumbstick/touch input/trackpad/x "
     "input/trackpad/y input/trackpad/force input/trackpad/touch input/grip/pose input/aim/pose "
     "output/haptic",
     "", ""},
    {"/interaction_profiles/htc/vive_controller",
     "input/system/click input/squeeze/click input/menu/click input/trigger/click input/trigger/value "
     "input/trackpad/x input/trackpad/y input/trackpad/click input/trackpad/touch input/grip/pose "
     "input/aim/pose output/haptic",
     "", ""},
    {"/interaction_profiles/microsoft/motion_controller",
     "input/menu/click input/squeeze/click input/trigger/value input/thumbstick/x input/thumbstick/y "
     "input/thumbstick/click input/trackpad/x input/trackpad/y input/trackpad/click input/trackpad/touch "
     "input/grip/pose input/aim/pose output/haptic",
     "", ""},
    {"/interaction_profiles/ext/hand_interaction_ext",
     "input/pinch_ext/value input/pinch_ext/ready_ext input/pinch_ext/pose input/aim_activate_ext/value "
     "input/aim_activate_ext/ready_ext input/grasp_ext/value input/grasp_ext/ready_ext input/poke_ext/pose "
     "input/grip/pose input/aim/pose",
     "", ""},
};

// XR_HTCX_vive_tracker_interaction, of each role.
constexpr std::string_view tracker_profile = "/interaction_profiles/htc/vive_tracker_htcx";
constexpr std::string_view tracker_inputs =
    "input/system/click input/menu/click input/trigger/click input/trigger/value input/squeeze/click "
    "input/trackpad/x input/trackpad/y input/trackpad/click input/trackpad/touch input/grip/pose "
    "output/haptic";
constexpr std::string_view roles =
    "handheld_object left_foot right_foot left_shoulder right_shoulder left_elbow right_elbow left_knee "
    "right_knee waist chest camera keyboard left_wrist right_wrist left_ankle right_ankle";

// The list names the input, or a component of it: "input/thumbstick" stands for "input/thumbstick/x" and y.
bool lists(std::string_view list, std::string_view input) {
    for (std::size_t at = list.find(input); at != std::string_view::npos; at = list.find(input, at + 1)) {
        const std::size_t end = at + input.size();
        const bool begins = at == 0 || list[at - 1] == ' ';
        if (begins && (end == list.size() || list[end] == ' ' || list[end] == '/')) return true;
    }
    return false;
}

}  // namespace

bool is_known_profile(const std::string& profile) {
    if (profile == tracker_profile) return true;
    for (const Profile& known : profiles)
        if (known.path == profile) return true;
    return false;
}

bool has_input(const std::string& profile, const std::string& path) {
    if (profile == tracker_profile) {
        if (path.rfind(role_folder, 0) != 0) return false;
        const std::string_view rest = std::string_view(path).substr(role_folder.size());
        const std::size_t slash = rest.find('/');
        return slash != std::string_view::npos && lists(roles, rest.substr(0, slash)) &&
               lists(tracker_inputs, rest.substr(slash + 1));
    }
    constexpr std::string_view left = "/user/hand/left/", right = "/user/hand/right/";
    const bool is_left = path.rfind(left, 0) == 0, is_right = path.rfind(right, 0) == 0;
    if (!is_left && !is_right) return false;
    const std::string_view input = std::string_view(path).substr(is_left ? left.size() : right.size());
    if (input.empty() || input == "input") return false;
    for (const Profile& known : profiles)
        if (known.path == profile)
            return lists(known.both, input) || lists(is_left ? known.left : known.right, input);
    return false;
}

}  // namespace bolt::mock
