// The frame loop of the mock runtime: it paces frames, and checks and records what is submitted.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

#include "tests/mock_openxr/state.hpp"

namespace bolt::mock {

namespace {

// Leaves the lock while the thread waits. Returns false if the session was lost or ended meanwhile.
template <class Ready>
bool wait_until(State& s, std::unique_lock<std::mutex>& lock, std::uint64_t id, const Ready& ready) {
    const std::uint64_t generation = s.generation;
    const auto gone = [&] {
        return s.generation != generation || !s.instance || s.instance->lost || !s.instance->session ||
               s.instance->session->id != id || s.instance->session->lost;
    };
    s.changed.wait(lock, [&] { return gone() || ready(*s.instance->session); });
    return !gone();
}

// Leaves the lock until the frame's time has come.
void sleep_until(std::unique_lock<std::mutex>& lock, const State& s, XrTime time) {
    const XrTime left = time - now(s);
    if (left <= 0) return;
    lock.unlock();
    std::this_thread::sleep_for(std::chrono::nanoseconds(left));
    lock.lock();
}

XrResult wait_next(State& s, std::unique_lock<std::mutex>& lock, XrFrameState& out) {
    const std::uint64_t id = s.instance->session->id;
    const auto lost = [&] {
        s.notified_of_loss.insert(std::this_thread::get_id());
        return s.instance && s.instance->lost ? XR_ERROR_INSTANCE_LOST : XR_ERROR_SESSION_LOST;
    };
    // A stopped session releases its waiting thread.
    const auto ready = [&](const Session& session) {
        const bool stopped = !session.running || session.state == XR_SESSION_STATE_STOPPING;
        return !s.blocked && (stopped || !session.waited);
    };
    if (!wait_until(s, lock, id, ready)) return lost();
    const std::int64_t period = s.instance->config.period;
    if (s.instance->config.real_time) {
        const XrTime passed = now(s) - s.instance->session->last_display;
        if (passed > period) s.instance->session->last_display += passed / period * period;
        sleep_until(lock, s, s.instance->session->last_display);
        if (!wait_until(s, lock, id, [](const Session&) { return true; })) return lost();
    }
    Session& session = *s.instance->session;
    count_frame(s);
    session.last_display += (1 + std::exchange(s.delayed_periods, 0)) * period;
    session.waited = session.last_display;
    for (std::string& file : s.script.requested) s.script.pictures.emplace(*session.waited, std::move(file));
    s.script.requested.clear();
    const bool visible =
        session.state == XR_SESSION_STATE_VISIBLE || session.state == XR_SESSION_STATE_FOCUSED;
    session.waited_render = visible && s.should_render;
    out.predictedDisplayTime = session.last_display;
    out.predictedDisplayPeriod = s.reported_periods * period;
    out.shouldRender = session.waited_render ? XR_TRUE : XR_FALSE;
    return XR_SUCCESS;
}

XrResult XRAPI_CALL wait_frame(XrSession, const XrFrameWaitInfo*, XrFrameState* out) {
    constexpr const char* name = "xrWaitFrame";
    return call(name, Level::session, [&](State& s, std::unique_lock<std::mutex>& lock) {
        Session& session = *s.instance->session;
        if (!session.running)
            return refuse(s, name, XR_ERROR_SESSION_NOT_RUNNING, "is called while the session does not run");
        if (session.waiting) violate(s, name, "is called by two threads at once");
        session.waiting = true;
        const std::uint64_t id = session.id;
        const XrResult result = wait_next(s, lock, *out);
        if (s.instance && s.instance->session && s.instance->session->id == id)
            s.instance->session->waiting = false;
        return result;
    });
}

XrResult XRAPI_CALL begin_frame(XrSession, const XrFrameBeginInfo*) {
    constexpr const char* name = "xrBeginFrame";
    return call(name, Level::session, [&](State& s, auto&) {
        Session& session = *s.instance->session;
        if (!session.running)
            return refuse(s, name, XR_ERROR_SESSION_NOT_RUNNING, "is called while the session does not run");
        if (!session.waited)
            return refuse(s, name, XR_ERROR_CALL_ORDER_INVALID, "is called without xrWaitFrame");
        const bool discarded = session.begun.has_value();
        session.begun = session.waited;
        session.begun_render = session.waited_render;
        session.waited.reset();
        s.changed.notify_all();
        return discarded ? XR_FRAME_DISCARDED : XR_SUCCESS;
    });
}

constexpr const char* end_name = "xrEndFrame";

XrResult refuse_end(State& s, XrResult result, std::string_view what) {
    return refuse(s, end_name, result, what);
}

// The swapchain of a part of a layer; null, with the reason recorded, if it cannot be shown.
const Swapchain* check_image(State& s, const XrSwapchainSubImage& image, bool depth) {
    const Swapchain* swapchain = find(s, end_name, s.instance->swapchains, image.swapchain);
    const auto bad = [&](const char* what) -> const Swapchain* {
        violate(s, end_name, what);
        return nullptr;
    };
    if (swapchain == nullptr) return nullptr;
    if (!swapchain->released) return bad("shows a swapchain of which no image was released");
    const XrRect2Di& rect = image.imageRect;
    if (rect.offset.x < 0 || rect.offset.y < 0 || rect.extent.width <= 0 || rect.extent.height <= 0 ||
        rect.offset.x + rect.extent.width > static_cast<std::int32_t>(swapchain->info.width) ||
        rect.offset.y + rect.extent.height > static_cast<std::int32_t>(swapchain->info.height))
        return bad("shows a rectangle outside the image");
    if (image.imageArrayIndex >= swapchain->info.arraySize)
        return bad("shows a layer beyond the image's last");
    if (is_depth(static_cast<VkFormat>(swapchain->info.format)) != depth)
        return bad(depth ? "shows depth from an image of colours" : "shows an image of depth as a picture");
    return swapchain;
}

void capture(State& s, const Swapchain& swapchain, const SubmittedView& view, Picture& picture) {
    std::vector<std::uint8_t> bytes;
    const auto format = static_cast<VkFormat>(swapchain.info.format);
    const VkImage image = swapchain.images[*swapchain.released].image;
    if (read_image(s.instance->session->vulkan, swapchain.info, image, view.layer, view.rect, bytes) !=
        VK_SUCCESS)
        return violate(s, end_name, "submits a picture that cannot be read");
    picture.width = static_cast<std::uint32_t>(view.rect.extent.width);
    picture.height = static_cast<std::uint32_t>(view.rect.extent.height);
    if (is_depth(format)) {
        picture.depth.resize(bytes.size() / sizeof(float));
        std::memcpy(picture.depth.data(), bytes.data(), bytes.size());
    } else {
        picture.rgba = to_rgba8(format, bytes);
    }
}

bool wants_pictures(const State& s) {
    const std::multimap<XrTime, std::string>& files = s.script.pictures;
    return s.capture || (!files.empty() && files.begin()->first <= *s.instance->session->begun);
}

const XrCompositionLayerDepthInfoKHR* depth_info(const XrCompositionLayerProjectionView& view) {
    const auto* next = static_cast<const XrBaseInStructure*>(view.next);
    while (next != nullptr && next->type != XR_TYPE_COMPOSITION_LAYER_DEPTH_INFO_KHR) next = next->next;
    return reinterpret_cast<const XrCompositionLayerDepthInfoKHR*>(next);
}

XrResult check_depth(State& s, const XrCompositionLayerDepthInfoKHR& depth, SubmittedView& view) {
    if (s.instance->extensions.count(XR_KHR_COMPOSITION_LAYER_DEPTH_EXTENSION_NAME) == 0)
        return refuse_end(s, XR_ERROR_VALIDATION_FAILURE,
                          "submits depth without having enabled its extension");
    if (!(depth.minDepth >= 0.0F && depth.minDepth < depth.maxDepth && depth.maxDepth <= 1.0F))
        return refuse_end(s, XR_ERROR_VALIDATION_FAILURE,
                          "submits a range of depth that is empty or outside 0 to 1");
    if (!(depth.nearZ >= 0.0F && depth.farZ >= 0.0F) || depth.nearZ == depth.farZ)
        return refuse_end(s, XR_ERROR_VALIDATION_FAILURE,
                          "submits distances of depth that are equal or negative");
    const Swapchain* swapchain = check_image(s, depth.subImage, true);
    if (swapchain == nullptr) return XR_ERROR_LAYER_INVALID;
    view.has_depth = true;
    view.min_depth = depth.minDepth;
    view.max_depth = depth.maxDepth;
    view.near_z = depth.nearZ;
    view.far_z = depth.farZ;
    SubmittedView source;
    source.rect = depth.subImage.imageRect;
    source.layer = depth.subImage.imageArrayIndex;
    if (wants_pictures(s)) capture(s, *swapchain, source, view.picture);
    return XR_SUCCESS;
}

XrResult check_view(State& s, const XrCompositionLayerProjectionView& view, Frame& frame) {
    if (!is_unit(view.pose.orientation))
        return refuse_end(s, XR_ERROR_POSE_INVALID, "submits an orientation that is not a unit quaternion");
    constexpr float right_angle = 1.5708F;
    const XrFovf& fov = view.fov;
    if (!(fov.angleLeft < fov.angleRight && fov.angleDown < fov.angleUp && fov.angleLeft > -right_angle &&
          fov.angleRight < right_angle && fov.angleDown > -right_angle && fov.angleUp < right_angle))
        return refuse_end(s, XR_ERROR_VALIDATION_FAILURE, "submits angles of view that are no frustum");
    const Swapchain* swapchain = check_image(s, view.subImage, false);
    if (swapchain == nullptr) return XR_ERROR_LAYER_INVALID;
    SubmittedView submitted;
    submitted.pose = view.pose;
    submitted.fov = fov;
    submitted.rect = view.subImage.imageRect;
    submitted.layer = view.subImage.imageArrayIndex;
    if (wants_pictures(s)) capture(s, *swapchain, submitted, submitted.picture);
    if (const auto* depth = depth_info(view))
        if (const XrResult checked = check_depth(s, *depth, submitted); XR_FAILED(checked)) return checked;
    frame.views.push_back(std::move(submitted));
    return XR_SUCCESS;
}

XrResult check_layer(State& s, const XrCompositionLayerBaseHeader* layer, Frame& frame) {
    if (layer != nullptr) frame.layers.push_back(layer->type);
    if (layer != nullptr && layer->type == XR_TYPE_COMPOSITION_LAYER_PASSTHROUGH_FB)
        return check_passthrough(s, *reinterpret_cast<const XrCompositionLayerPassthroughFB*>(layer), frame);
    if (layer == nullptr || layer->type != XR_TYPE_COMPOSITION_LAYER_PROJECTION)
        return refuse_end(s, XR_ERROR_LAYER_INVALID, "submits a layer of a type that is not offered");
    const auto& projection = *reinterpret_cast<const XrCompositionLayerProjection*>(layer);
    if (find(s, end_name, s.instance->spaces, projection.space) == nullptr) return XR_ERROR_LAYER_INVALID;
    if (projection.viewCount != s.instance->config.eyes)
        return refuse_end(s, XR_ERROR_VALIDATION_FAILURE, "submits a view too few or too many");
    frame.has_layer = true;
    frame.flags = projection.layerFlags;
    for (std::uint32_t eye = 0; eye < projection.viewCount; ++eye)
        if (const XrResult checked = check_view(s, projection.views[eye], frame); XR_FAILED(checked))
            return checked;
    return XR_SUCCESS;
}

XrResult check_frame(State& s, const XrFrameEndInfo& info, Frame& frame) {
    const std::vector<XrEnvironmentBlendMode>& modes = s.instance->config.blend_modes;
    if (std::find(modes.begin(), modes.end(), info.environmentBlendMode) == modes.end())
        return refuse_end(s, XR_ERROR_ENVIRONMENT_BLEND_MODE_UNSUPPORTED,
                          "submits a blend mode that is not offered");
    frame.blend_mode = info.environmentBlendMode;
    for (std::uint32_t i = 0; i < info.layerCount; ++i)
        if (const XrResult checked = check_layer(s, info.layers[i], frame); XR_FAILED(checked))
            return checked;
    return XR_SUCCESS;
}

XrResult XRAPI_CALL end_frame(XrSession, const XrFrameEndInfo* info) {
    return call(end_name, Level::session, [&](State& s, auto&) {
        Session& session = *s.instance->session;
        if (!session.running)
            return refuse_end(s, XR_ERROR_SESSION_NOT_RUNNING, "is called while the session does not run");
        if (!session.begun)
            return refuse_end(s, XR_ERROR_CALL_ORDER_INVALID, "is called without xrBeginFrame");
        if (info->displayTime != *session.begun)
            return refuse_end(s, XR_ERROR_TIME_INVALID, "submits another display time than xrWaitFrame gave");
        Frame frame;
        frame.time = *session.begun;
        frame.should_render = session.begun_render;
        if (const XrResult checked = check_frame(s, *info, frame); XR_FAILED(checked)) return checked;
        if (const auto located = session.located.find(frame.time); located != session.located.end())
            frame.located = located->second;
        session.begun.reset();
        session.begun_once = true;
        if (frame.has_layer) write_pictures(s, frame);
        if (!s.capture)
            for (SubmittedView& view : frame.views) view.picture = {};
        s.frames.push_back(std::move(frame));
        advance_session(s);
        return XR_SUCCESS;
    });
}

}  // namespace

void add_frame_functions(FunctionTable& table) {
    add(table, "xrWaitFrame", &wait_frame);
    add(table, "xrBeginFrame", &begin_frame);
    add(table, "xrEndFrame", &end_frame);
}

}  // namespace bolt::mock
