#include "engine/xr/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace bolt::xr {

namespace {

// Newer than the headers of Debian 12: XR_REFERENCE_SPACE_TYPE_LOCAL_FLOOR.
constexpr auto local_floor = static_cast<XrReferenceSpaceType>(1000426000);
// s until a runtime that does not answer is given up.
constexpr double waiter_timeout = 2.0;
// ns; the runtime normally has the image free at once.
constexpr XrDuration image_timeout = 100'000'000;

const XrPosef identity{{0, 0, 0, 1}, {0, 0, 0}};

}  // namespace

// Calls xrWaitFrame on its own thread, once for every request. The thread shares the ownership of this
// object, so it may outlive the session if the runtime never returns.
class FrameWaiter {
  public:
    static std::shared_ptr<FrameWaiter> start(XrSession session) {
        auto waiter = std::make_shared<FrameWaiter>();
        std::thread([waiter, session] { waiter->run(session); }).detach();
        return waiter;
    }

    void request() {
        const std::lock_guard lock(mutex_);
        phase_ = Phase::waiting;
        changed_.notify_all();
    }

    struct Answer {
        XrResult result = XR_SUCCESS;
        XrFrameState state{XR_TYPE_FRAME_STATE};
    };
    // The answer to the request, taken once; none after `timeout` s, or without a request.
    std::optional<Answer> take(double timeout) {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, std::chrono::duration<double>(timeout),
                          [&] { return phase_ != Phase::waiting; });
        if (phase_ != Phase::answered) return std::nullopt;
        phase_ = Phase::idle;
        return answer_;
    }
    [[nodiscard]] bool waiting() {
        const std::lock_guard lock(mutex_);
        return phase_ == Phase::waiting;
    }

    // Ends the thread. Returns false if it is still in the runtime after the timeout.
    bool stop(double timeout) {
        std::unique_lock lock(mutex_);
        stopping_ = true;
        changed_.notify_all();
        return changed_.wait_for(lock, std::chrono::duration<double>(timeout), [&] { return finished_; });
    }

  private:
    enum class Phase : std::uint8_t { idle, waiting, answered };

    void run(XrSession session) {
        std::unique_lock lock(mutex_);
        for (;;) {
            changed_.wait(lock, [&] { return stopping_ || phase_ == Phase::waiting; });
            if (stopping_) break;
            lock.unlock();
            Answer answer;
            const XrFrameWaitInfo info{XR_TYPE_FRAME_WAIT_INFO, nullptr};
            answer.result = xrWaitFrame(session, &info, &answer.state);
            lock.lock();
            answer_ = answer;
            phase_ = Phase::answered;
            changed_.notify_all();
        }
        finished_ = true;
        changed_.notify_all();
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    Phase phase_ = Phase::idle;
    Answer answer_;
    bool stopping_ = false, finished_ = false;
};

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
    session->waiter_ = FrameWaiter::start(session->session_.get());
    return session;
}

Session::~Session() {
    // Submitted commands may still copy into the headset's images.
    if (stop()) (void)device_->idle();
}

bool Session::stop() {
    if (!waiter_) return !abandoned_;
    const bool finished = waiter_->stop(waiter_timeout);
    waiter_.reset();
    if (finished) return true;
    // A thread of ours is still inside the runtime. All that it may use stays, and nothing else is asked of
    // that runtime, because a call may never return either.
    abandoned_ = true;
    runtime_->abandon();
    (void)new auto(std::move(color_));
    (void)new auto(std::move(depth_));
    (void)new std::array{std::move(head_), std::move(space_)};
    (void)new SessionHandle(std::move(session_));
    return false;
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
    BOLT_TRY(check(xrCreateSession(runtime_->instance(), &info, &raw), "creating the headset's session"));
    session_ = SessionHandle(raw);
    return {};
}

Status Session::create_spaces() {
    std::vector<XrReferenceSpaceType> types;
    BOLT_TRY(check(enumerate(types, XR_REFERENCE_SPACE_TYPE_LOCAL,
                             [&](std::uint32_t capacity, std::uint32_t* count, XrReferenceSpaceType* values) {
                                 return xrEnumerateReferenceSpaces(session_.get(), capacity, count, values);
                             }),
                   "listing the headset's spaces"));
    const auto has = [&](XrReferenceSpaceType type) {
        return std::find(types.begin(), types.end(), type) != types.end();
    };
    const auto create = [&](XrReferenceSpaceType type) -> Result<SpaceHandle> {
        XrReferenceSpaceCreateInfo info{XR_TYPE_REFERENCE_SPACE_CREATE_INFO};
        info.referenceSpaceType = type;
        info.poseInReferenceSpace = identity;
        XrSpace raw = XR_NULL_HANDLE;
        BOLT_TRY(
            check(xrCreateReferenceSpace(session_.get(), &info, &raw), "creating a space of the headset"));
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
    BOLT_TRY(check(xrCreateSwapchain(session_.get(), &info, &raw), "creating the headset's images"));
    Swapchain swapchain;
    swapchain.handle = SwapchainHandle(raw);
    swapchain.extent = extent_;
    swapchain.format = format;
    std::vector<XrSwapchainImageVulkan2KHR> images;
    const XrResult listed = enumerate(
        images, XrSwapchainImageVulkan2KHR{XR_TYPE_SWAPCHAIN_IMAGE_VULKAN2_KHR, nullptr, VK_NULL_HANDLE},
        [&](std::uint32_t capacity, std::uint32_t* count, XrSwapchainImageVulkan2KHR* values) {
            return xrEnumerateSwapchainImages(raw, capacity, count,
                                              reinterpret_cast<XrSwapchainImageBaseHeader*>(values));
        });
    BOLT_TRY(check(listed, "listing the headset's images"));
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
                   "listing the headset's image formats"));
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

Status Session::follow(const XrEventDataSessionStateChanged& event) {
    state_ = event.state;
    if (event.state == XR_SESSION_STATE_READY) {
        XrSessionBeginInfo info{XR_TYPE_SESSION_BEGIN_INFO};
        info.primaryViewConfigurationType = runtime_->view_configuration();
        BOLT_TRY(check(xrBeginSession(session_.get(), &info), "beginning the headset's session"));
        running_ = true;
        waiter_->request();
    } else if (event.state == XR_SESSION_STATE_STOPPING) {
        running_ = false;
        (void)waiter_->take(waiter_timeout);  // the runtime releases a waiting thread
        return check(xrEndSession(session_.get()), "ending the headset's session");
    } else if (event.state == XR_SESSION_STATE_EXITING) {
        ended_ = true;
    } else if (event.state == XR_SESSION_STATE_LOSS_PENDING) {
        running_ = false;
        return check(XR_ERROR_SESSION_LOST, "the headset's session ends");
    }
    return {};
}

Status Session::poll(std::vector<SessionEvent>& events) {
    for (;;) {
        XrEventDataBuffer buffer{XR_TYPE_EVENT_DATA_BUFFER};
        const XrResult polled = xrPollEvent(runtime_->instance(), &buffer);
        if (polled == XR_EVENT_UNAVAILABLE) return {};
        BOLT_TRY(check(polled, "polling the headset's events"));
        // The event's type determines the structure, which begins with the members of the buffer.
        switch (buffer.type) {
            case XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING:
                return check(XR_ERROR_INSTANCE_LOST, "the OpenXR runtime ends");
            case XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED: {
                const auto& changed = reinterpret_cast<const XrEventDataSessionStateChanged&>(buffer);
                if (changed.session != session_.get()) break;
                events.emplace_back(StateChanged{changed.state});
                BOLT_TRY(follow(changed));
                break;
            }
            case XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING: {
                const auto& change = reinterpret_cast<const XrEventDataReferenceSpaceChangePending&>(buffer);
                const XrReferenceSpaceType ours = base_ == BaseSpace::stage   ? XR_REFERENCE_SPACE_TYPE_STAGE
                                                  : base_ == BaseSpace::floor ? local_floor
                                                                              : XR_REFERENCE_SPACE_TYPE_LOCAL;
                if (change.session != session_.get() || change.referenceSpaceType != ours) break;
                Recentred recentred{change.changeTime, std::nullopt};
                if (change.poseValid == XR_TRUE) recentred.shift = to_pose(change.poseInPreviousSpace);
                events.emplace_back(recentred);
                break;
            }
            case XR_TYPE_EVENT_DATA_INTERACTION_PROFILE_CHANGED:
                events.emplace_back(BindingsChanged{});
                break;
            case XR_TYPE_EVENT_DATA_VISIBILITY_MASK_CHANGED_KHR:
                events.emplace_back(VisibilityMaskChanged{});
                break;
            case XR_TYPE_EVENT_DATA_EVENTS_LOST:
                events.emplace_back(EventsLost{});
                break;
            default:
                break;  // of an extension that is not enabled
        }
    }
}

Result<std::optional<FrameTiming>> Session::begin_frame(double timeout) {
    if (!running_) return std::nullopt;
    const std::optional<FrameWaiter::Answer> answer = waiter_->take(timeout);
    if (!answer) return std::nullopt;
    BOLT_TRY(check(answer->result, "waiting for the headset's frame"));
    const XrFrameBeginInfo info{XR_TYPE_FRAME_BEGIN_INFO, nullptr};
    BOLT_TRY(check(xrBeginFrame(session_.get(), &info), "beginning the headset's frame"));
    waiter_->request();  // for the next frame, while this one is drawn
    FrameTiming timing;
    timing.display_time = answer->state.predictedDisplayTime;
    timing.period = 1e-9 * static_cast<double>(answer->state.predictedDisplayPeriod);
    timing.should_render = answer->state.shouldRender == XR_TRUE;
    return timing;
}

Result<HeadView> Session::locate(const FrameTiming& frame) {
    XrViewLocateInfo info{XR_TYPE_VIEW_LOCATE_INFO};
    info.viewConfigurationType = runtime_->view_configuration();
    info.displayTime = frame.display_time;
    info.space = space_.get();
    XrViewState state{XR_TYPE_VIEW_STATE};
    std::array<XrView, 2> views{XrView{XR_TYPE_VIEW}, XrView{XR_TYPE_VIEW}};
    const auto eyes = static_cast<std::uint32_t>(runtime_->views().size());
    std::uint32_t count = 0;
    BOLT_TRY(
        check(xrLocateViews(session_.get(), &info, &state, eyes, &count, views.data()), "locating the eyes"));
    XrSpaceLocation location{XR_TYPE_SPACE_LOCATION};
    BOLT_TRY(
        check(xrLocateSpace(head_.get(), space_.get(), frame.display_time, &location), "locating the head"));
    constexpr XrSpaceLocationFlags valid =
        XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_POSITION_VALID_BIT;
    constexpr XrViewStateFlags views_valid =
        XR_VIEW_STATE_ORIENTATION_VALID_BIT | XR_VIEW_STATE_POSITION_VALID_BIT;
    HeadView result;
    if ((location.locationFlags & valid) != valid || (state.viewStateFlags & views_valid) != views_valid)
        return result;  // no eyes: nothing can be drawn
    constexpr XrSpaceLocationFlags tracked =
        XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT | XR_SPACE_LOCATION_POSITION_TRACKED_BIT;
    result.tracked = (location.locationFlags & tracked) == tracked;
    result.head = to_pose(location.pose);
    for (std::uint32_t eye = 0; eye < count; ++eye) {
        const XrFovf& fov = views[eye].fov;
        result.eyes.push_back({to_pose(views[eye].pose),
                               {static_cast<double>(fov.angleLeft), static_cast<double>(fov.angleRight),
                                static_cast<double>(fov.angleUp), static_cast<double>(fov.angleDown)}});
    }
    return result;
}

template <class Visit>
Status Session::each_swapchain(const Visit& visit) {
    for (std::vector<Swapchain>* swapchains : {&color_, &depth_})
        for (Swapchain& swapchain : *swapchains) BOLT_TRY(visit(swapchain));
    return {};
}

Status Session::acquire(Swapchain& swapchain) {
    if (!swapchain.acquired) {
        const XrSwapchainImageAcquireInfo info{XR_TYPE_SWAPCHAIN_IMAGE_ACQUIRE_INFO, nullptr};
        std::uint32_t index = 0;
        BOLT_TRY(check(xrAcquireSwapchainImage(swapchain.handle.get(), &info, &index),
                       "acquiring an image of the headset"));
        swapchain.acquired = index;
        swapchain.ready = false;
    }
    if (swapchain.ready) return {};
    XrSwapchainImageWaitInfo wait{XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO};
    wait.timeout = image_timeout;
    const XrResult waited = xrWaitSwapchainImage(swapchain.handle.get(), &wait);
    BOLT_TRY(check(waited, "waiting for an image of the headset"));
    swapchain.ready = waited != XR_TIMEOUT_EXPIRED;
    return {};
}

Status Session::release(Swapchain& swapchain) {
    if (!swapchain.acquired || !swapchain.ready) return {};
    const XrSwapchainImageReleaseInfo info{XR_TYPE_SWAPCHAIN_IMAGE_RELEASE_INFO, nullptr};
    BOLT_TRY(
        check(xrReleaseSwapchainImage(swapchain.handle.get(), &info), "releasing an image of the headset"));
    swapchain.acquired.reset();
    return {};
}

namespace {

// Copies a layer; converts the format if it must.
void copy_picture(VkCommandBuffer commands, const gpu::Image& from, std::uint32_t from_layer, VkImage to,
                  std::uint32_t to_layer, VkFormat to_format, VkExtent2D extent) {
    const bool is_depth = to_format == VK_FORMAT_D32_SFLOAT;
    const auto use = is_depth ? gpu::ResourceUse::depth_target : gpu::ResourceUse::color_target;
    gpu::ImageRange range;
    range.aspect = is_depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
    range.first_layer = to_layer;
    range.layers = 1;
    gpu::image_barrier_discarding(commands, to, use, gpu::ResourceUse::transfer_to, range);
    const VkImageSubresourceLayers source{range.aspect, 0, from_layer, 1},
        target{range.aspect, 0, to_layer, 1};
    if (from.info().format == to_format) {
        VkImageCopy region{};
        region.srcSubresource = source;
        region.dstSubresource = target;
        region.extent = {extent.width, extent.height, 1};
        vkCmdCopyImage(commands, from.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to,
                       VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
    } else {
        VkImageBlit region{};
        region.srcSubresource = source;
        region.dstSubresource = target;
        region.srcOffsets[1] = region.dstOffsets[1] = {static_cast<std::int32_t>(extent.width),
                                                       static_cast<std::int32_t>(extent.height), 1};
        vkCmdBlitImage(commands, from.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to,
                       VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, VK_FILTER_NEAREST);
    }
    gpu::image_barrier(commands, to, gpu::ResourceUse::transfer_to, use, range);
}

}  // namespace

Status Session::record(VkCommandBuffer commands, std::span<const EyePicture> pictures) {
    drawn_.clear();
    depth_drawn_ = false;
    bool ready = true;
    BOLT_TRY(each_swapchain([&](Swapchain& swapchain) -> Status {
        BOLT_TRY(acquire(swapchain));
        ready = ready && swapchain.ready;
        return {};
    }));
    if (!ready) return {};  // the runtime still reads an image; this frame shows nothing
    depth_drawn_ = !depth_.empty() && std::all_of(pictures.begin(), pictures.end(),
                                                  [](const EyePicture& p) { return p.depth != nullptr; });
    for (std::size_t eye = 0; eye < pictures.size(); ++eye) {
        const EyePicture& picture = pictures[eye];
        const VkExtent2D extent{std::min(picture.extent.width, extent_.width),
                                std::min(picture.extent.height, extent_.height)};
        const auto copy_to = [&](const std::vector<Swapchain>& swapchains, const gpu::Image& from,
                                 std::uint32_t layer) {
            const bool shared = swapchains.size() == 1;
            const Swapchain& to = swapchains[shared ? 0 : eye];
            copy_picture(commands, from, layer, to.images[*to.acquired],
                         shared ? static_cast<std::uint32_t>(eye) : 0, to.format, extent);
        };
        copy_to(color_, *picture.picture, picture.layer);
        if (depth_drawn_) copy_to(depth_, *picture.depth, picture.depth_layer);
        drawn_.push_back(extent);
    }
    return {};
}

XrSwapchainSubImage Session::sub_image(const std::vector<Swapchain>& swapchains, std::size_t eye) const {
    const bool shared = swapchains.size() == 1;
    XrSwapchainSubImage image{};
    image.swapchain = swapchains[shared ? 0 : eye].handle.get();
    image.imageRect.extent = {static_cast<std::int32_t>(drawn_[eye].width),
                              static_cast<std::int32_t>(drawn_[eye].height)};
    image.imageArrayIndex = shared ? static_cast<std::uint32_t>(eye) : 0;
    return image;
}

Status Session::end_frame(const FrameTiming& frame, const Drawn& drawn) {
    BOLT_TRY(each_swapchain([&](Swapchain& swapchain) { return release(swapchain); }));
    std::array<XrCompositionLayerProjectionView, 2> views{};
    std::array<XrCompositionLayerDepthInfoKHR, 2> depths{};
    const std::size_t eyes = drawn.view == nullptr ? 0 : std::min(drawn_.size(), drawn.view->eyes.size());
    for (std::size_t eye = 0; eye < eyes; ++eye) {
        const EyeView& view = drawn.view->eyes[eye];
        const auto f = [](double x) { return static_cast<float>(x); };
        views[eye] = {XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW};
        views[eye].pose = to_xr(view.pose);
        views[eye].fov = {f(view.fov.left), f(view.fov.right), f(view.fov.up), f(view.fov.down)};
        views[eye].subImage = sub_image(color_, eye);
        if (!depth_drawn_) continue;
        depths[eye] = {XR_TYPE_COMPOSITION_LAYER_DEPTH_INFO_KHR};
        depths[eye].subImage = sub_image(depth_, eye);
        depths[eye].minDepth = 0.0F;
        depths[eye].maxDepth = 1.0F;
        // Depth is reversed: 0 is far.
        depths[eye].nearZ = drawn.depth.far;
        depths[eye].farZ = drawn.depth.near;
        views[eye].next = &depths[eye];
    }
    const bool blends = options_.passthrough && runtime_->passthrough().has_value();
    XrCompositionLayerProjection projection{XR_TYPE_COMPOSITION_LAYER_PROJECTION};
    projection.layerFlags = blends ? XR_COMPOSITION_LAYER_BLEND_TEXTURE_SOURCE_ALPHA_BIT : 0;
    projection.space = space_.get();
    projection.viewCount = static_cast<std::uint32_t>(eyes);
    projection.views = views.data();
    const XrCompositionLayerBaseHeader* layers[] = {
        reinterpret_cast<const XrCompositionLayerBaseHeader*>(&projection)};
    XrFrameEndInfo info{XR_TYPE_FRAME_END_INFO};
    info.displayTime = frame.display_time;
    info.environmentBlendMode = blends ? *runtime_->passthrough() : runtime_->opaque();
    info.layerCount = eyes > 0 && eyes == runtime_->views().size() ? 1 : 0;
    info.layers = layers;
    drawn_.clear();
    return check(xrEndFrame(session_.get(), &info), "ending the headset's frame");
}

Status Session::request_exit() {
    return check(xrRequestExitSession(session_.get()), "requesting the end of the headset's session");
}

}  // namespace bolt::xr
