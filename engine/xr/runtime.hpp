// The OpenXR runtime of this computer and the headset that it serves.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/gpu/device.hpp"
#include "engine/xr/openxr.hpp"

namespace bolt::xr {

// Optional extensions that the runtime has.
struct Extensions {
    bool depth = false;             // XR_KHR_composition_layer_depth
    bool visibility_mask = false;   // XR_KHR_visibility_mask
    bool hand_tracking = false;     // XR_EXT_hand_tracking, and the headset tracks hands
    bool local_floor = false;       // XR_EXT_local_floor
    bool hand_interaction = false;  // XR_EXT_hand_interaction: pinch and grasp as actions
    bool user_presence = false;     // XR_EXT_user_presence, and the headset senses whether it is worn
    bool vive_trackers = false;     // XR_HTCX_vive_tracker_interaction
    bool passthrough = false;       // XR_FB_passthrough, and the headset has cameras for it
};

// The functions of extensions, which the loader does not export. Null if the runtime lacks the extension.
struct ExtensionFunctions {
    PFN_xrGetVulkanGraphicsRequirements2KHR graphics_requirements = nullptr;
    PFN_xrCreateVulkanInstanceKHR create_vulkan_instance = nullptr;
    PFN_xrGetVulkanGraphicsDevice2KHR graphics_device = nullptr;
    PFN_xrCreateVulkanDeviceKHR create_vulkan_device = nullptr;
    PFN_xrGetVisibilityMaskKHR visibility_mask = nullptr;
    PFN_xrCreateHandTrackerEXT create_hand_tracker = nullptr;
    PFN_xrDestroyHandTrackerEXT destroy_hand_tracker = nullptr;
    PFN_xrLocateHandJointsEXT locate_hand_joints = nullptr;
    PFN_xrEnumerateViveTrackerPathsHTCX enumerate_vive_trackers = nullptr;
    PFN_xrCreatePassthroughFB create_passthrough = nullptr;
    PFN_xrDestroyPassthroughFB destroy_passthrough = nullptr;
    PFN_xrPassthroughStartFB start_passthrough = nullptr;
    PFN_xrPassthroughPauseFB pause_passthrough = nullptr;
    PFN_xrCreatePassthroughLayerFB create_passthrough_layer = nullptr;
    PFN_xrDestroyPassthroughLayerFB destroy_passthrough_layer = nullptr;
    PFN_xrPassthroughLayerPauseFB pause_passthrough_layer = nullptr;
    PFN_xrPassthroughLayerResumeFB resume_passthrough_layer = nullptr;
};

// An OpenXR instance with its headset. Creates the Vulkan instance and device for this headset.
class Runtime final : public gpu::VulkanCreator {
  public:
    // Fails with ErrorCode::no_device if there is no runtime, the runtime lacks Vulkan, or no headset is
    // connected; trying again later may then succeed.
    static Result<std::unique_ptr<Runtime>> open();
    // open() in two steps: start() creates the instance, and find_headset() searches for a headset. Repeat
    // only find_headset(): it is cheap, while the runtime may start a service for each new instance. Call
    // quiet_loader() before start(), while no other thread reads the environment.
    static Result<std::unique_ptr<Runtime>> start();
    Status find_headset();

    Result<VkInstance> create_instance(const VkInstanceCreateInfo& info) override;
    Result<VkPhysicalDevice> choose_gpu(VkInstance instance) override;
    Result<VkDevice> create_device(VkPhysicalDevice gpu, const VkDeviceCreateInfo& info) override;

    // After a failed find_headset(): true if only the headset is missing. find_headset() may then be called
    // again.
    [[nodiscard]] bool lacks_headset() const { return lacks_headset_; }

    [[nodiscard]] XrInstance instance() const { return instance_.get(); }
    [[nodiscard]] XrSystemId system() const { return system_; }
    [[nodiscard]] const Extensions& extensions() const { return extensions_; }
    [[nodiscard]] const ExtensionFunctions& functions() const { return functions_; }
    [[nodiscard]] const std::string& name() const { return name_; }        // of the runtime, with version
    [[nodiscard]] const std::string& headset() const { return headset_; }  // as the runtime calls it
    [[nodiscard]] const XrSystemProperties& properties() const { return properties_; }
    // The blend mode that shows the real room behind what is drawn; none: the headset cannot show it, or only
    // as a layer (Extensions::passthrough).
    [[nodiscard]] std::optional<XrEnvironmentBlendMode> passthrough() const { return passthrough_; }
    // The blend mode that hides the real room; the one that the headset prefers if none does.
    [[nodiscard]] XrEnvironmentBlendMode opaque() const { return opaque_; }
    [[nodiscard]] XrViewConfigurationType view_configuration() const { return view_configuration_; }
    // One entry per eye: one for a mono display, else two.
    [[nodiscard]] const std::vector<XrViewConfigurationView>& views() const { return views_; }

    // Leaves the instance to the operating system. Call it if a thread of ours may never return from the
    // runtime: destroying the instance would then crash or block.
    void abandon() { (void)new InstanceHandle(std::move(instance_)); }

  private:
    Status create_xr_instance();
    Status query_system();
    Status load_functions();
    Status load_passthrough();
    Status choose_views();

    InstanceHandle instance_;
    XrSystemId system_ = XR_NULL_SYSTEM_ID;
    bool lacks_headset_ = false;
    Extensions extensions_;
    ExtensionFunctions functions_;
    std::string name_, headset_;
    XrSystemProperties properties_{XR_TYPE_SYSTEM_PROPERTIES};
    XrViewConfigurationType view_configuration_ = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
    std::vector<XrViewConfigurationView> views_;
    XrEnvironmentBlendMode opaque_ = XR_ENVIRONMENT_BLEND_MODE_OPAQUE;
    std::optional<XrEnvironmentBlendMode> passthrough_;
};

}  // namespace bolt::xr
