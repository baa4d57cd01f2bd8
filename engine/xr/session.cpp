#include "engine/xr/session.hpp"

#include <algorithm>
#include <array>

#include "engine/xr/frame_waiter.hpp"

namespace bolt::xr {

namespace {

// Newer than the headers of Debian 12: XR_REFERENCE_SPACE_TYPE_LOCAL_FLOOR.
constexpr auto local_floor = static_cast<XrReferenceSpaceType>(1000426000);
constexpr double waiter_timeout = 2.0;  // s, for a runtime that does not answer
constexpr double short_wait = 0.03;     // s, about a frame: a runtime that works has answered by then
const XrPosef identity{{0, 0, 0, 1}, {0, 0, 0}};

Status lost(std::string what) {
    Error error;
    error.code = ErrorCode::no_device;
    error.what = std::move(what);
    error.expected = "a headset that stays connected";
    error.lost = true;
    return fail(std::move(error));
}

}  // namespace

std::optional<VkFormat> choose_color_format(std::span<const std::int64_t> offered) {
    // A floating-point format holds linear values; the copy converts them.
    for (const VkFormat wanted :
         {VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_B8G8R8A8_SRGB, VK_FORMAT_R16G16B16A16_SFLOAT})
        if (std::find(offered.begin(), offered.end(), static_cast<std::int64_t>(wanted)) != offered.end())
            return wanted;
    return std::nullopt;
}

std::optional<VkFormat> choose_depth_format(std::span<const std::int64_t> offered) {
    // Depth is copied, and copies do not convert it.
    const auto wanted = static_cast<std::int64_t>(VK_FORMAT_D32_SFLOAT);
    if (std::find(offered.begin(), offered.end(), wanted) == offered.end()) return std::nullopt;
    return VK_FORMAT_D32_SFLOAT;
}

Result<std::unique_ptr<Session>> Session::create(Runtime& runtime, gpu::Device& device,
                                                 const SessionOptions& options) {
    std::unique_ptr<Session> session(new Session());
    session->runtime_ = &runtime;
    session->device_ = &device;
    session->options_ = options;
    BOLT_TRY(session->create_session());
    BOLT_TRY(session->create_spaces());
    BOLT_TRY(session->create_swapchains());
    session->passthrough_ = PassthroughLayer(runtime, session->session_.get());
    session->waiter_ = FrameWaiter::start(session->session_.get());
    return session;
}

Session::~Session() {
    // Submitted commands may still copy into the headset's images.
    if (!abandoned_ && !stop(waiter_timeout)) abandon();
    if (!abandoned_) (void)device_->idle();
}

bool Session::stop(double timeout) {
    if (waiter_ && waiter_->stop(timeout)) waiter_.reset();
    return waiter_ == nullptr;
}

// The waiting thread is still inside the runtime. Everything that it may use stays, and no further function
// of this runtime is called, because that call might not return.
void Session::abandon() {
    waiter_.reset();
    abandoned_ = true;
    runtime_->abandon();
    (void)new auto(std::move(color_));
    (void)new auto(std::move(depth_));
    (void)new std::array{std::move(head_), std::move(space_)};
    (void)new PassthroughLayer(std::move(passthrough_));
    (void)new SessionHandle(std::move(session_));
}

Status Session::create_session() {
    XrGraphicsBindingVulkan2KHR binding{XR_TYPE_GRAPHICS_BINDING_VULKAN2_KHR};
    binding.instance = device_->instance();
    binding.physicalDevice = device_->physical();
    binding.device = device_->get();
    binding.queueFamilyIndex = device_->queue_family();
    binding.queueIndex = 0;
    XrSessionCreateInfo info{XR_TYPE_SESSION_CREATE_INFO};
    info.next = &binding;
    info.systemId = runtime_->system();
    XrSession raw = XR_NULL_HANDLE;
    BOLT_TRY(check(xrCreateSession(runtime_->instance(), &info, &raw), "xrCreateSession"));
    session_ = SessionHandle(raw);
    return {};
}

Status Session::create_spaces() {
    std::vector<XrReferenceSpaceType> types;
    BOLT_TRY(check(enumerate(types, XR_REFERENCE_SPACE_TYPE_LOCAL,
                             [&](std::uint32_t capacity, std::uint32_t* count, XrReferenceSpaceType* values) {
                                 return xrEnumerateReferenceSpaces(session_.get(), capacity, count, values);
                             }),
                   "xrEnumerateReferenceSpaces"));
    const auto has = [&](XrReferenceSpaceType type) {
        return std::find(types.begin(), types.end(), type) != types.end();
    };
    const auto create = [&](XrReferenceSpaceType type) -> Result<SpaceHandle> {
        XrReferenceSpaceCreateInfo info{XR_TYPE_REFERENCE_SPACE_CREATE_INFO};
        info.referenceSpaceType = type;
        info.poseInReferenceSpace = identity;
        XrSpace raw = XR_NULL_HANDLE;
        BOLT_TRY(check(xrCreateReferenceSpace(session_.get(), &info, &raw), "xrCreateReferenceSpace"));
        return SpaceHandle(raw);
    };
    XrReferenceSpaceType type = XR_REFERENCE_SPACE_TYPE_LOCAL;
    base_ = BaseSpace::seated;
    if (!options_.seated && has(XR_REFERENCE_SPACE_TYPE_STAGE)) {
        type = XR_REFERENCE_SPACE_TYPE_STAGE;
        base_ = BaseSpace::stage;
    } else if (!options_.seated && runtime_->extensions().local_floor && has(local_floor)) {
        type = local_floor;
        base_ = BaseSpace::floor;
    }
    BOLT_TRY_ASSIGN(space_, create(type));
    BOLT_TRY_ASSIGN(head_, create(XR_REFERENCE_SPACE_TYPE_VIEW));
    return {};
}

Result<Session::Swapchain> Session::make_swapchain(VkFormat format, std::uint32_t layers,
                                                   XrSwapchainUsageFlags usage) {
    XrSwapchainCreateInfo info{XR_TYPE_SWAPCHAIN_CREATE_INFO};
    info.usageFlags = usage | XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT;
    info.format = format;
    info.sampleCount = 1;
    info.width = extent_.width;
    info.height = extent_.height;
    info.faceCount = info.mipCount = 1;
    info.arraySize = layers;
    XrSwapchain raw = XR_NULL_HANDLE;
    BOLT_TRY(check(xrCreateSwapchain(session_.get(), &info, &raw), "xrCreateSwapchain"));
    Swapchain swapchain;
    swapchain.handle = XrSwapchainHandle(raw);
    swapchain.extent = extent_;
    swapchain.format = format;
    std::vector<XrSwapchainImageVulkan2KHR> images;
    const XrResult listed = enumerate(
        images, XrSwapchainImageVulkan2KHR{XR_TYPE_SWAPCHAIN_IMAGE_VULKAN2_KHR, nullptr, VK_NULL_HANDLE},
        [&](std::uint32_t capacity, std::uint32_t* count, XrSwapchainImageVulkan2KHR* values) {
            return xrEnumerateSwapchainImages(raw, capacity, count,
                                              reinterpret_cast<XrSwapchainImageBaseHeader*>(values));
        });
    BOLT_TRY(check(listed, "xrEnumerateSwapchainImages"));
    for (const XrSwapchainImageVulkan2KHR& image : images) swapchain.images.push_back(image.image);
    return swapchain;
}

Status Session::create_swapchains() {
    const std::vector<XrViewConfigurationView>& views = runtime_->views();
    for (const XrViewConfigurationView& view : views) {
        extent_.width =
            std::max(extent_.width, std::min(view.recommendedImageRectWidth, view.maxImageRectWidth));
        extent_.height =
            std::max(extent_.height, std::min(view.recommendedImageRectHeight, view.maxImageRectHeight));
    }
    std::vector<std::int64_t> formats;
    BOLT_TRY(check(enumerate(formats, std::int64_t{0},
                             [&](std::uint32_t capacity, std::uint32_t* count, std::int64_t* values) {
                                 return xrEnumerateSwapchainFormats(session_.get(), capacity, count, values);
                             }),
                   "xrEnumerateSwapchainFormats"));
    const std::optional<VkFormat> color = choose_color_format(formats), depth = choose_depth_format(formats);
    if (!color)
        return fail(ErrorCode::no_device, "the headset has no usable image format",
                    "8-bit sRGB or 16-bit floating point with four channels");
    const auto make = [&](std::vector<Swapchain>& swapchains, VkFormat format,
                          XrSwapchainUsageFlags usage) -> Status {
        const auto eyes = static_cast<std::uint32_t>(views.size());
        if (!options_.separate_eyes && runtime_->properties().graphicsProperties.maxLayerCount > 0) {
            // Some runtimes offer array images and then fail to create them.
            if (Result<Swapchain> both = make_swapchain(format, eyes, usage)) {
                swapchains.push_back(std::move(*both));
                return {};
            } else if (both.error().lost) {
                return fail(both.error());
            }
        }
        for (std::uint32_t eye = 0; eye < eyes; ++eye) {
            BOLT_TRY_ASSIGN(auto one, make_swapchain(format, 1, usage));
            swapchains.push_back(std::move(one));
        }
        return {};
    };
    BOLT_TRY(make(color_, *color, XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT));
    if (!options_.submit_depth || !runtime_->extensions().depth || !depth) return {};
    return make(depth_, *depth, XR_SWAPCHAIN_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
}

Status Session::handle_state_change(const XrEventDataSessionStateChanged& event) {
    state_ = event.state;
    if (event.state == XR_SESSION_STATE_READY) {
        XrSessionBeginInfo info{XR_TYPE_SESSION_BEGIN_INFO};
        info.primaryViewConfigurationType = runtime_->view_configuration();
        BOLT_TRY(check(xrBeginSession(session_.get(), &info), "xrBeginSession"));
        running_ = true;
        last_display_time_.reset();
        waiter_->request();
    } else if (event.state == XR_SESSION_STATE_STOPPING) {
        running_ = false;
        stopping_ = true;
        return end_if_stopping(short_wait);
    } else if (event.state == XR_SESSION_STATE_EXITING) {
        ended_ = true;
    } else if (event.state == XR_SESSION_STATE_LOSS_PENDING) {
        running_ = false;
        return lost("the headset's session has ended");
    }
    return {};
}

// Ends the session once the waiting thread has returned from the runtime, which soon releases it.
Status Session::end_if_stopping(double timeout) {
    if (!stopping_ || !waiter_->discard_answer(timeout)) return {};
    stopping_ = false;
    return check(xrEndSession(session_.get()), "xrEndSession");
}

Status Session::poll(std::vector<SessionEvent>& events) {
    BOLT_TRY(end_if_stopping(0.0));
    for (;;) {
        XrEventDataBuffer buffer{XR_TYPE_EVENT_DATA_BUFFER};
        const XrResult polled = xrPollEvent(runtime_->instance(), &buffer);
        if (polled == XR_EVENT_UNAVAILABLE) return {};
        BOLT_TRY(check(polled, "xrPollEvent"));
        // The event's type determines the structure, which begins with the members of the buffer.
        switch (static_cast<int>(buffer.type)) {  // also types that the headers lack
            case XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING:
                return lost("the OpenXR runtime has ended");
            case XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED: {
                const auto& changed = reinterpret_cast<const XrEventDataSessionStateChanged&>(buffer);
                if (changed.session != session_.get()) break;
                events.emplace_back(StateChanged{changed.state});
                BOLT_TRY(handle_state_change(changed));
                break;
            }
            case XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING: {
                const auto& change = reinterpret_cast<const XrEventDataReferenceSpaceChangePending&>(buffer);
                const XrReferenceSpaceType moved = change.referenceSpaceType;
                const XrReferenceSpaceType ours = base_ == BaseSpace::stage   ? XR_REFERENCE_SPACE_TYPE_STAGE
                                                  : base_ == BaseSpace::floor ? local_floor
                                                                              : XR_REFERENCE_SPACE_TYPE_LOCAL;
                const bool recentres = moved == XR_REFERENCE_SPACE_TYPE_STAGE || moved == local_floor ||
                                       moved == XR_REFERENCE_SPACE_TYPE_LOCAL;
                if (change.session != session_.get() || !recentres) break;
                Recentred recentred{change.changeTime, moved == ours, std::nullopt};
                if (recentred.base && change.poseValid == XR_TRUE)
                    recentred.shift = to_pose(change.poseInPreviousSpace);
                events.emplace_back(recentred);
                break;
            }
            case user_presence_changed: {
                const auto& changed = reinterpret_cast<const UserPresenceChanged&>(buffer);
                if (changed.session != session_.get()) break;
                worn_ = changed.present == XR_TRUE;
                events.emplace_back(UserPresence{worn_});
                break;
            }
            case XR_TYPE_EVENT_DATA_INTERACTION_PROFILE_CHANGED:
                events.emplace_back(BindingsChanged{});
                break;
            case XR_TYPE_EVENT_DATA_PASSTHROUGH_STATE_CHANGED_FB:
                passthrough_.handle(reinterpret_cast<const XrEventDataPassthroughStateChangedFB&>(buffer));
                break;
            case XR_TYPE_EVENT_DATA_VIVE_TRACKER_CONNECTED_HTCX:
                events.emplace_back(TrackersChanged{});
                break;
            case XR_TYPE_EVENT_DATA_VISIBILITY_MASK_CHANGED_KHR:
                hidden_known_ = false;
                events.emplace_back(VisibilityMaskChanged{});
                break;
            case XR_TYPE_EVENT_DATA_EVENTS_LOST:
                hidden_known_ = false;
                events.emplace_back(EventsLost{});
                break;
            default:
                break;  // of an extension that is not enabled
        }
    }
}

Status Session::request_exit() { return check(xrRequestExitSession(session_.get()), "xrRequestExitSession"); }

}  // namespace bolt::xr
