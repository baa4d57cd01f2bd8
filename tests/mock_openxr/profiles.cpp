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
    for (const Profile& known : profiles)
        if (known.path == profile) return true;
    return false;
}

bool has_input(const std::string& profile, const std::string& path) {
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
