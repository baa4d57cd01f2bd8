// OpenXR's headers, its results as errors, and its poses. Call the functions of this folder from one thread,
// in programs with pictures from the thread that draws, unless a comment says otherwise.
//
// Source of the rules in this folder: The OpenXR Specification 1.0, Khronos, and XR_KHR_vulkan_enable2.
#pragma once

#include "engine/gpu/vk.hpp"
// The order matters: openxr_platform.h needs the types of Vulkan and of the clock.
#include <ctime>
#define XR_USE_GRAPHICS_API_VULKAN
#define XR_USE_TIMESPEC
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/math.hpp"
#include "engine/base/result.hpp"

namespace bolt::xr {

// Returns the name in the specification: "XR_ERROR_SESSION_LOST".
std::string_view name(XrResult result);

// Returns an Error for every negative result. `function`: the name of the function, such as "xrBeginFrame".
// For a missing or lost runtime or headset the code is no_device; Error::lost is set if the instance or the
// session was lost, after which only destroying it succeeds.
Status check(XrResult result, std::string_view function);

// Keeps the loader from printing messages of its own to stderr; callers get the same failures as errors. Sets
// an environment variable, so no other thread may read the environment meanwhile.
void quiet_loader();

// Return the extensions that the runtime offers (fails with ErrorCode::no_device if there is no runtime), and
// the description of this program, without extensions.
Result<std::vector<std::string>> offered_extensions();
XrInstanceCreateInfo instance_info();
// The loader keeps a runtime loaded until an instance of it is destroyed, even if the user meanwhile chooses
// another runtime. Call this if no instance is created after offered_extensions().
void unload_runtime();

// A pose in metres. The orientation is normalised, because runtimes send it with rounding errors.
inline Pose to_pose(const XrPosef& pose) {
    const glm::quat q(pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z);
    return {Vec3(glm::vec3(pose.position.x, pose.position.y, pose.position.z)), glm::normalize(Quat(q))};
}
inline XrPosef to_xr(const Pose& pose) {
    const auto f = [](double x) { return static_cast<float>(x); };
    return {{f(pose.orientation.x), f(pose.orientation.y), f(pose.orientation.z), f(pose.orientation.w)},
            {f(pose.position.x), f(pose.position.y), f(pose.position.z)}};
}

// A move-only owner of an OpenXR object.
template <class T, XrResult (*destroy)(T)>
class UniqueHandle {
  public:
    UniqueHandle() = default;
    explicit UniqueHandle(T object) : object_(object) {}
    UniqueHandle(UniqueHandle&& other) noexcept
        : object_(std::exchange(other.object_, static_cast<T>(XR_NULL_HANDLE))) {}
    UniqueHandle& operator=(UniqueHandle&& other) noexcept {
        std::swap(object_, other.object_);
        return *this;
    }
    UniqueHandle(const UniqueHandle&) = delete;
    UniqueHandle& operator=(const UniqueHandle&) = delete;
    ~UniqueHandle() {
        if (object_ != static_cast<T>(XR_NULL_HANDLE)) (void)destroy(object_);
    }
    [[nodiscard]] T get() const { return object_; }
    explicit operator bool() const { return object_ != static_cast<T>(XR_NULL_HANDLE); }

  private:
    T object_ = static_cast<T>(XR_NULL_HANDLE);
};

using InstanceHandle = UniqueHandle<XrInstance, &xrDestroyInstance>;
using SessionHandle = UniqueHandle<XrSession, &xrDestroySession>;
using SpaceHandle = UniqueHandle<XrSpace, &xrDestroySpace>;
using XrSwapchainHandle = UniqueHandle<XrSwapchain, &xrDestroySwapchain>;
using ActionSetHandle = UniqueHandle<XrActionSet, &xrDestroyActionSet>;

// XR_EXT_user_presence, which is newer than the headers of Debian 12.
inline constexpr const char* user_presence_extension = "XR_EXT_user_presence";
inline constexpr auto user_presence_changed = static_cast<XrStructureType>(1000470000),
                      user_presence_properties = static_cast<XrStructureType>(1000470001);
struct UserPresenceChanged {
    XrStructureType type = user_presence_changed;
    const void* next = nullptr;
    XrSession session = XR_NULL_HANDLE;
    XrBool32 present = XR_FALSE;
};
struct UserPresenceProperties {
    XrStructureType type = user_presence_properties;
    void* next = nullptr;
    XrBool32 supported = XR_FALSE;
};

// Fills `values` by an OpenXR function that is called twice: first for the count, then for the values.
// `empty`: an element with its type set. `query`: XrResult(std::uint32_t capacity, std::uint32_t* count, T*).
template <class T, class Query>
XrResult enumerate(std::vector<T>& values, const T& empty, const Query& query) {
    XrResult result = XR_ERROR_SIZE_INSUFFICIENT;
    while (result == XR_ERROR_SIZE_INSUFFICIENT) {  // the list may have grown between the calls
        std::uint32_t count = 0;
        result = query(0, &count, nullptr);
        values.assign(count, empty);
        if (XR_SUCCEEDED(result) && count > 0) result = query(count, &count, values.data());
        if (XR_SUCCEEDED(result)) values.resize(count);
    }
    return result;
}

}  // namespace bolt::xr
