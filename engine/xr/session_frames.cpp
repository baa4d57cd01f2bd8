// The frames of a session: when they begin, where the eyes are, and the pictures that are shown.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <utility>

#include "engine/xr/frame_waiter.hpp"
#include "engine/xr/session.hpp"

namespace bolt::xr {

namespace {

constexpr XrDuration image_timeout = 20'000'000;  // ns; normally the image is free at once

}  // namespace

std::string describe(const FrameCounts& counts) {
    const double rate = counts.seconds > 0.0 ? static_cast<double>(counts.begun) / counts.seconds : 0.0;
    return fmt::format("{} frames in {:.1f} s ({:.1f} a second, {} drawn), {} missed, {:.1f} s of waiting",
                       counts.begun, counts.seconds, rate, counts.drawn, counts.missed, counts.waited);
}

XrDuration display_period(XrDuration known, XrDuration reported) {
    constexpr double tolerance = 0.02;  // of rounding and of prediction, as a share of the period
    if (known <= 0 || reported <= 0) return std::max(known, reported);
    const double ratio = static_cast<double>(reported) / static_cast<double>(known);
    const double multiple = std::round(ratio);
    return multiple >= 1.0 && std::abs(ratio - multiple) < tolerance ? known : reported;
}

void Session::count(XrTime display_time) {
    ++counts_.begun;
    if (last_display_time_) {
        const XrDuration passed = display_time - *last_display_time_;
        counts_.seconds += 1e-9 * static_cast<double>(passed);
        // Display times are multiples of the period, but for rounding errors.
        if (period_ > 0)
            counts_.missed += std::max<std::int64_t>(
                std::llround(static_cast<double>(passed) / static_cast<double>(period_)) - 1, 0);
    }
    last_display_time_ = display_time;
}

Result<std::optional<FrameTiming>> Session::begin_frame(double timeout) {
    if (!running_) return std::nullopt;
    const auto begin = std::chrono::steady_clock::now();
    const std::optional<FrameWaiter::Answer> answer = waiter_->take(timeout);
    counts_.waited += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (!answer) return std::nullopt;
    BOLT_TRY(check(answer->result, "xrWaitFrame"));
    const XrFrameBeginInfo info{XR_TYPE_FRAME_BEGIN_INFO, nullptr};
    BOLT_TRY(check(xrBeginFrame(session_.get(), &info), "xrBeginFrame"));
    waiter_->request();  // for the next frame, while this one is drawn
    period_ = display_period(period_, answer->state.predictedDisplayPeriod);
    count(answer->state.predictedDisplayTime);
    FrameTiming timing;
    timing.display_time = answer->state.predictedDisplayTime;
    timing.period = 1e-9 * static_cast<double>(period_);
    timing.should_render = answer->state.shouldRender == XR_TRUE;
    return timing;
}

namespace {

constexpr std::uint32_t max_mask_size = 65536;  // vertices and indices

// Null: the runtime has no mask for this eye, or one that is not made of triangles.
std::shared_ptr<const HiddenArea> hidden_area(const Runtime& runtime, XrSession session, std::uint32_t eye) {
    const auto query = [&](XrVisibilityMaskKHR& mask) {
        return runtime.functions().visibility_mask(session, runtime.view_configuration(), eye,
                                                   XR_VISIBILITY_MASK_TYPE_HIDDEN_TRIANGLE_MESH_KHR, &mask);
    };
    XrVisibilityMaskKHR mask{XR_TYPE_VISIBILITY_MASK_KHR};
    if (query(mask) != XR_SUCCESS || mask.indexCountOutput == 0) return nullptr;
    if (mask.vertexCountOutput > max_mask_size || mask.indexCountOutput > max_mask_size) return nullptr;
    std::vector<XrVector2f> vertices(mask.vertexCountOutput);
    std::vector<std::uint32_t> indices(mask.indexCountOutput);
    mask.vertexCapacityInput = mask.vertexCountOutput;
    mask.vertices = vertices.data();
    mask.indexCapacityInput = mask.indexCountOutput;
    mask.indices = indices.data();
    if (query(mask) != XR_SUCCESS || mask.indexCountOutput != indices.size() || indices.size() % 3 != 0)
        return nullptr;
    HiddenArea corners;
    for (const std::uint32_t index : indices) {
        if (index >= vertices.size()) return nullptr;
        corners.emplace_back(vertices[index].x, vertices[index].y);
    }
    return std::make_shared<const HiddenArea>(std::move(corners));
}

}  // namespace

// A runtime without the extension, or whose mask is invalid, shows the whole pictures.
void Session::find_hidden_areas() {
    if (std::exchange(hidden_known_, true) || runtime_->functions().visibility_mask == nullptr) return;
    for (std::uint32_t eye = 0; eye < runtime_->views().size(); ++eye)
        hidden_[eye] = hidden_area(*runtime_, session_.get(), eye);
}

Result<HeadView> Session::locate(const FrameTiming& frame) {
    find_hidden_areas();
    XrViewLocateInfo info{XR_TYPE_VIEW_LOCATE_INFO};
    info.viewConfigurationType = runtime_->view_configuration();
    info.displayTime = frame.display_time;
    info.space = space_.get();
    XrViewState state{XR_TYPE_VIEW_STATE};
    std::array<XrView, 2> views{XrView{XR_TYPE_VIEW}, XrView{XR_TYPE_VIEW}};
    const auto eyes = static_cast<std::uint32_t>(runtime_->views().size());
    std::uint32_t count = 0;
    BOLT_TRY(
        check(xrLocateViews(session_.get(), &info, &state, eyes, &count, views.data()), "xrLocateViews"));
    XrSpaceLocation location{XR_TYPE_SPACE_LOCATION};
    BOLT_TRY(check(xrLocateSpace(head_.get(), space_.get(), frame.display_time, &location), "xrLocateSpace"));
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
                                static_cast<double>(fov.angleUp), static_cast<double>(fov.angleDown)},
                               hidden_[eye]});
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
        BOLT_TRY(
            check(xrAcquireSwapchainImage(swapchain.handle.get(), &info, &index), "xrAcquireSwapchainImage"));
        swapchain.acquired = index;
        swapchain.ready = false;
    }
    if (swapchain.ready) return {};
    XrSwapchainImageWaitInfo wait{XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO};
    wait.timeout = image_timeout;
    const XrResult waited = xrWaitSwapchainImage(swapchain.handle.get(), &wait);
    BOLT_TRY(check(waited, "xrWaitSwapchainImage"));
    swapchain.ready = waited != XR_TIMEOUT_EXPIRED;
    return {};
}

Status Session::release(Swapchain& swapchain) {
    if (!swapchain.acquired || !swapchain.ready) return {};
    const XrSwapchainImageReleaseInfo info{XR_TYPE_SWAPCHAIN_IMAGE_RELEASE_INFO, nullptr};
    BOLT_TRY(check(xrReleaseSwapchainImage(swapchain.handle.get(), &info), "xrReleaseSwapchainImage"));
    swapchain.acquired.reset();
    return {};
}

namespace {

// A layer of a picture, and a layer of a swapchain's image.
struct SourceLayer {
    const gpu::Image& image;
    std::uint32_t layer = 0;
};
struct TargetLayer {
    VkImage image = VK_NULL_HANDLE;
    VkFormat format = VK_FORMAT_UNDEFINED;
    std::uint32_t layer = 0;
};

// Copies the part of this size; converts the format if it must.
void copy_layer(VkCommandBuffer commands, const SourceLayer& from, const TargetLayer& to, VkExtent2D extent) {
    const bool is_depth = to.format == VK_FORMAT_D32_SFLOAT;
    const auto use = is_depth ? gpu::ResourceUse::depth_target : gpu::ResourceUse::color_target;
    gpu::ImageRange range;
    range.aspect = is_depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
    range.first_layer = to.layer;
    range.layers = 1;
    gpu::image_barrier_discarding(commands, to.image, use, gpu::ResourceUse::transfer_to, range);
    const VkImageSubresourceLayers source{range.aspect, 0, from.layer, 1},
        target{range.aspect, 0, to.layer, 1};
    if (from.image.info().format == to.format) {
        VkImageCopy region{};
        region.srcSubresource = source;
        region.dstSubresource = target;
        region.extent = {extent.width, extent.height, 1};
        vkCmdCopyImage(commands, from.image.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to.image,
                       VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
    } else {
        VkImageBlit region{};
        region.srcSubresource = source;
        region.dstSubresource = target;
        region.srcOffsets[1] = region.dstOffsets[1] = {static_cast<std::int32_t>(extent.width),
                                                       static_cast<std::int32_t>(extent.height), 1};
        vkCmdBlitImage(commands, from.image.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to.image,
                       VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, VK_FILTER_NEAREST);
    }
    gpu::image_barrier(commands, to.image, gpu::ResourceUse::transfer_to, use, range);
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
            const std::uint32_t to_layer = shared ? static_cast<std::uint32_t>(eye) : 0;
            copy_layer(commands, {from, layer}, {to.images[*to.acquired], to.format, to_layer}, extent);
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
    const bool blends = drawn.passthrough && runtime_->passthrough().has_value();
    const bool draws = eyes > 0 && eyes == runtime_->views().size();
    if (draws) BOLT_TRY(passthrough_.show(drawn.passthrough && !blends));
    const bool transparent = blends || passthrough_.shown();
    const XrCompositionLayerPassthroughFB room = passthrough_.composition_layer();
    XrCompositionLayerProjection projection{XR_TYPE_COMPOSITION_LAYER_PROJECTION};
    projection.layerFlags = transparent ? XR_COMPOSITION_LAYER_BLEND_TEXTURE_SOURCE_ALPHA_BIT : 0;
    projection.space = space_.get();
    projection.viewCount = static_cast<std::uint32_t>(eyes);
    projection.views = views.data();
    // From the bottom to the top.
    std::array<const XrCompositionLayerBaseHeader*, 2> layers{};
    std::uint32_t count = 0;
    if (draws && passthrough_.shown())
        layers[count++] = reinterpret_cast<const XrCompositionLayerBaseHeader*>(&room);
    if (draws) layers[count++] = reinterpret_cast<const XrCompositionLayerBaseHeader*>(&projection);
    XrFrameEndInfo info{XR_TYPE_FRAME_END_INFO};
    info.displayTime = frame.display_time;
    info.environmentBlendMode = blends ? *runtime_->passthrough() : runtime_->opaque();
    info.layerCount = count;
    info.layers = layers.data();
    counts_.drawn += draws ? 1 : 0;
    drawn_.clear();
    return check(xrEndFrame(session_.get(), &info), "xrEndFrame");
}

}  // namespace bolt::xr
