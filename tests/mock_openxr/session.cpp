// The mock's session: its states, its frames and its spaces, and the script.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

#include "tests/mock_openxr/state.hpp"

namespace bolt::mock_openxr {

namespace {

constexpr double ipd = 0.063;  // m
constexpr float half_fov = 0.8F;

template <class T>
XrEventDataBuffer event_of(const T& event) {
    XrEventDataBuffer buffer{XR_TYPE_EVENT_DATA_BUFFER};
    static_assert(sizeof event <= sizeof buffer);
    std::memcpy(&buffer, &event, sizeof event);
    return buffer;
}

Pose eye_of(const State& s, int eye) {
    const double side = s.config.eyes == 2 ? (eye == 0 ? -0.5 : 0.5) * ipd : 0.0;
    return s.head.pose * Pose{{side, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}};
}

void recentre(State& s, XrReferenceSpaceType type) {
    const Pose shift{{0.1, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}};
    Pose& origin = type == XR_REFERENCE_SPACE_TYPE_STAGE ? s.stage_origin : s.local_origin;
    origin = origin * shift;
    XrEventDataReferenceSpaceChangePending event{XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING};
    event.session = reinterpret_cast<XrSession>(&s.session);
    event.referenceSpaceType = type;
    event.changeTime = s.now;
    event.poseValid = XR_TRUE;
    event.poseInPreviousSpace = xr::to_xr(shift);
    s.events.push_back(event_of(event));
}

}  // namespace

void State::enter(XrSessionState next) {
    state = next;
    XrEventDataSessionStateChanged event{XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED};
    event.session = reinterpret_cast<XrSession>(&session);
    event.state = next;
    event.time = now;
    events.push_back(event_of(event));
}

void apply_event(State& s, Event event) {
    switch (event) {
        case Event::take_off:
            for (const XrSessionState next :
                 {XR_SESSION_STATE_VISIBLE, XR_SESSION_STATE_SYNCHRONIZED, XR_SESSION_STATE_STOPPING})
                s.enter(next);
            return;
        case Event::put_on:
            return s.enter(XR_SESSION_STATE_READY);
        case Event::lose_focus:
            s.gains_focus = false;
            return s.enter(XR_SESSION_STATE_VISIBLE);
        case Event::regain_focus:
            return s.enter(XR_SESSION_STATE_FOCUSED);
        case Event::user_exit:
            s.exit_requested = true;
            return apply_event(s, Event::take_off);
        case Event::lose_session:
            s.session_lost = true;
            return s.enter(XR_SESSION_STATE_LOSS_PENDING);
        case Event::lose_instance:
            s.instance_lost = true;
            s.changed.notify_all();
            return;
        case Event::recentre:
            return recentre(s, XR_REFERENCE_SPACE_TYPE_STAGE);
        case Event::recentre_local:
            return recentre(s, XR_REFERENCE_SPACE_TYPE_LOCAL);
        case Event::profile_changed: {
            XrEventDataInteractionProfileChanged changed{XR_TYPE_EVENT_DATA_INTERACTION_PROFILE_CHANGED};
            s.events.push_back(event_of(changed));
            return;
        }
        case Event::mask_changed: {
            XrEventDataVisibilityMaskChangedKHR changed{XR_TYPE_EVENT_DATA_VISIBILITY_MASK_CHANGED_KHR};
            s.events.push_back(event_of(changed));
            return;
        }
        case Event::events_lost: {
            XrEventDataEventsLost lost{XR_TYPE_EVENT_DATA_EVENTS_LOST};
            s.events.push_back(event_of(lost));
            return;
        }
    }
}

Pose pose_of(const State& s, const Space& space) {
    switch (space.kind) {
        case SpaceKind::stage:
            return s.stage_origin * space.offset;
        case SpaceKind::local:
            return s.local_origin * Pose{{0.0, 1.65, 0.0}, {1.0, 0.0, 0.0, 0.0}} * space.offset;
        case SpaceKind::local_floor:
            return s.local_origin * space.offset;
        case SpaceKind::view:
            return s.head.pose * space.offset;
        case SpaceKind::grip:
            return s.hands.at(static_cast<std::size_t>(space.side)).grip * space.offset;
        default:
            return s.hands.at(static_cast<std::size_t>(space.side)).aim * space.offset;
    }
}

bool space_valid(const State& s, const Space& space) {
    if (space.kind == SpaceKind::view) return s.head.valid;
    if (space.kind != SpaceKind::grip && space.kind != SpaceKind::aim) return true;
    const Hand& hand = s.hands.at(static_cast<std::size_t>(space.side));
    return hand.active && hand.valid && s.state == XR_SESSION_STATE_FOCUSED;
}

bool space_tracked(const State& s, const Space& space) {
    if (space.kind == SpaceKind::view) return s.head.tracked;
    if (space.kind != SpaceKind::grip && space.kind != SpaceKind::aim) return true;
    return s.hands.at(static_cast<std::size_t>(space.side)).tracked;
}

namespace {

XrResult create_session(XrInstance, const XrSessionCreateInfo* info, XrSession* session) {
    MOCK_ENTER("xrCreateSession");
    if (s.session) return XR_ERROR_LIMIT_REACHED;
    const auto* binding = static_cast<const XrGraphicsBindingVulkan2KHR*>(info->next);
    if (binding == nullptr || binding->type != XR_TYPE_GRAPHICS_BINDING_VULKAN2_KHR)
        return XR_ERROR_GRAPHICS_DEVICE_INVALID;
    if (!s.requirements_queried) return XR_ERROR_GRAPHICS_REQUIREMENTS_CALL_MISSING;
    if (binding->instance != s.vulkan.instance || binding->device != s.vulkan.device ||
        binding->physicalDevice != s.vulkan.gpu) {
        s.violation("xrCreateSession with a Vulkan instance or device that the runtime did not make");
        return XR_ERROR_GRAPHICS_DEVICE_INVALID;
    }
    s.vulkan.family = binding->queueFamilyIndex;
    s.vulkan.of_device<PFN_vkGetDeviceQueue>("vkGetDeviceQueue")(s.vulkan.device, binding->queueFamilyIndex,
                                                                 binding->queueIndex, &s.vulkan.queue);
    s.session = true;
    s.running = s.attached = s.exit_requested = false;
    s.waited = s.begun = s.ended = 0;
    s.enter(XR_SESSION_STATE_IDLE);
    s.enter(XR_SESSION_STATE_READY);
    *session = reinterpret_cast<XrSession>(&s.session);
    return XR_SUCCESS;
}

XrResult destroy_session(XrSession) {
    MOCK_ENTER("xrDestroySession");
    if (!s.session) s.violation("xrDestroySession without a session");
    s.session = s.running = false;
    s.spaces.clear();
    s.hand_trackers = 0;
    for (const auto& swapchain : s.swapchains) destroy_images(s.vulkan, *swapchain);
    s.swapchains.clear();
    s.changed.notify_all();
    return XR_SUCCESS;
}

XrResult begin_session(XrSession, const XrSessionBeginInfo*) {
    MOCK_ENTER("xrBeginSession");
    if (s.running) return XR_ERROR_SESSION_RUNNING;
    if (s.state != XR_SESSION_STATE_READY) {
        s.violation("xrBeginSession in another state than READY");
        return XR_ERROR_SESSION_NOT_READY;
    }
    s.running = s.gains_focus = true;
    return XR_SUCCESS;
}

XrResult end_session(XrSession) {
    MOCK_ENTER("xrEndSession");
    if (!s.running) return XR_ERROR_SESSION_NOT_RUNNING;
    if (s.state != XR_SESSION_STATE_STOPPING) {
        s.violation("xrEndSession in another state than STOPPING");
        return XR_ERROR_SESSION_NOT_STOPPING;
    }
    s.running = false;
    s.begun = s.ended = s.waited;
    s.enter(XR_SESSION_STATE_IDLE);
    if (s.exit_requested) s.enter(XR_SESSION_STATE_EXITING);
    s.changed.notify_all();
    return XR_SUCCESS;
}

XrResult request_exit(XrSession) {
    MOCK_ENTER("xrRequestExitSession");
    if (!s.running) return XR_ERROR_SESSION_NOT_RUNNING;
    apply_event(s, Event::user_exit);
    return XR_SUCCESS;
}

XrResult wait_frame(XrSession, const XrFrameWaitInfo*, XrFrameState* frame) {
    MOCK_ENTER("xrWaitFrame");
    if (!s.running) return XR_ERROR_SESSION_NOT_RUNNING;
    if (++s.waiting_threads > 1) s.violation("xrWaitFrame on two threads at once");
    // Until the previous frame has begun.
    s.changed.wait(lock,
                   [&] { return (s.waited == s.begun && !s.blocked) || !s.running || s.instance_lost; });
    --s.waiting_threads;
    if (s.instance_lost) return XR_ERROR_INSTANCE_LOST;
    if (!s.session) return XR_ERROR_SESSION_LOST;
    const auto period = static_cast<XrDuration>(1e9 * s.config.period);
    s.now += period;
    ++s.waited;
    s.waited_time = s.now + period;
    frame->predictedDisplayTime = s.waited_time;
    frame->predictedDisplayPeriod = period;
    frame->shouldRender =
        s.should_render && (s.state == XR_SESSION_STATE_VISIBLE || s.state == XR_SESSION_STATE_FOCUSED)
            ? XR_TRUE
            : XR_FALSE;
    if (s.config.real_time) {
        static auto next = std::chrono::steady_clock::now();
        next = std::max(next + std::chrono::nanoseconds(period), std::chrono::steady_clock::now());
        const auto until = next;
        lock.unlock();
        std::this_thread::sleep_until(until);
    }
    return XR_SUCCESS;
}

XrResult begin_frame(XrSession, const XrFrameBeginInfo*) {
    MOCK_ENTER("xrBeginFrame");
    if (!s.running) return XR_ERROR_SESSION_NOT_RUNNING;
    if (s.begun == s.waited) {
        s.violation("xrBeginFrame without xrWaitFrame");
        return XR_ERROR_CALL_ORDER_INVALID;
    }
    const bool discards = s.begun > s.ended;
    s.ended = std::max(s.ended, s.begun);
    ++s.begun;
    s.begun_time = s.waited_time;
    s.changed.notify_all();
    run_script(s);
    return discards ? XR_FRAME_DISCARDED : XR_SUCCESS;
}

// Checks one eye's sub-image; null if it cannot be shown.
Swapchain* checked(State& s, const XrSwapchainSubImage& image, const char* what) {
    Swapchain* swapchain = find(s.swapchains, image.swapchain);
    if (swapchain == nullptr) {
        s.violation(std::string(what) + " of an unknown swapchain");
        return nullptr;
    }
    const XrRect2Di& rect = image.imageRect;
    if (rect.offset.x < 0 || rect.offset.y < 0 || rect.extent.width <= 0 || rect.extent.height <= 0 ||
        static_cast<std::uint32_t>(rect.offset.x + rect.extent.width) > swapchain->width ||
        static_cast<std::uint32_t>(rect.offset.y + rect.extent.height) > swapchain->height)
        s.violation(std::string(what) + " outside its image");
    if (image.imageArrayIndex >= swapchain->layers)
        s.violation(std::string(what) + " of a layer that does not exist");
    if (!swapchain->released) {
        s.violation(std::string(what) + " of a swapchain whose images were never released");
        return nullptr;
    }
    return swapchain;
}

void record_eye(State& s, const XrCompositionLayerProjectionView& view, EyeRecord& eye) {
    eye.pose = xr::to_pose(view.pose);
    const XrQuaternionf& q = view.pose.orientation;
    if (std::abs(std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w) - 1.0F) > 1e-3F)
        s.violation("an eye's orientation is not a unit quaternion");
    eye.fov = view.fov;
    eye.layer = view.subImage.imageArrayIndex;
    eye.width = static_cast<std::uint32_t>(view.subImage.imageRect.extent.width);
    eye.height = static_cast<std::uint32_t>(view.subImage.imageRect.extent.height);
    if (Swapchain* color = checked(s, view.subImage, "a picture"); color != nullptr && s.record_pictures)
        eye.rgba = read_image(s.vulkan, *color, eye.layer, eye.width, eye.height);
    const auto* depth = static_cast<const XrCompositionLayerDepthInfoKHR*>(view.next);
    if (depth == nullptr) return;
    if (depth->type != XR_TYPE_COMPOSITION_LAYER_DEPTH_INFO_KHR)
        return s.violation("an unknown structure after a view");
    if (s.enabled.count("XR_KHR_composition_layer_depth") == 0)
        s.violation("depth without XR_KHR_composition_layer_depth");
    if (depth->minDepth < 0.0F || depth->maxDepth > 1.0F || depth->minDepth >= depth->maxDepth ||
        depth->nearZ <= 0.0F || depth->farZ <= 0.0F || depth->nearZ == depth->farZ)
        s.violation("a range of depth that the specification does not permit");
    eye.depth_range = {depth->nearZ, depth->farZ};
    Swapchain* image = checked(s, depth->subImage, "a depth");
    if (image == nullptr || !s.record_pictures) return;
    const std::vector<std::uint8_t> bytes =
        read_image(s.vulkan, *image, depth->subImage.imageArrayIndex, eye.width, eye.height);
    eye.depth.resize(bytes.size() / sizeof(float));
    std::memcpy(eye.depth.data(), bytes.data(), bytes.size());
}

XrResult end_frame(XrSession, const XrFrameEndInfo* info) {
    MOCK_ENTER("xrEndFrame");
    if (!s.running) return XR_ERROR_SESSION_NOT_RUNNING;
    if (s.ended == s.begun) {
        s.violation("xrEndFrame without xrBeginFrame");
        return XR_ERROR_CALL_ORDER_INVALID;
    }
    if (info->displayTime != s.begun_time) s.violation("xrEndFrame with another time than that of the frame");
    const auto& modes = s.config.blend_modes;
    if (std::find(modes.begin(), modes.end(), info->environmentBlendMode) == modes.end())
        return XR_ERROR_ENVIRONMENT_BLEND_MODE_UNSUPPORTED;
    FrameRecord frame;
    frame.time = info->displayTime;
    frame.layers = info->layerCount > 0;
    for (std::uint32_t i = 0; i < info->layerCount; ++i) {
        const auto* layer = reinterpret_cast<const XrCompositionLayerProjection*>(info->layers[i]);
        if (layer->type != XR_TYPE_COMPOSITION_LAYER_PROJECTION) continue;
        if (find(s.spaces, layer->space) == nullptr) s.violation("a layer in an unknown space");
        if (layer->viewCount != static_cast<std::uint32_t>(s.config.eyes))
            s.violation("a layer with another number of views than the headset has");
        for (std::uint32_t eye = 0; eye < layer->viewCount; ++eye)
            record_eye(s, layer->views[eye], frame.eyes.emplace_back());
    }
    s.last_frame = std::move(frame);
    save_script_pictures(s);
    s.ended = s.begun;
    if (s.state == XR_SESSION_STATE_READY)
        s.enter(XR_SESSION_STATE_SYNCHRONIZED);
    else if (s.state == XR_SESSION_STATE_SYNCHRONIZED)
        s.enter(XR_SESSION_STATE_VISIBLE);
    else if (s.state == XR_SESSION_STATE_VISIBLE && s.gains_focus)
        s.enter(XR_SESSION_STATE_FOCUSED);
    return XR_SUCCESS;
}

XrResult locate_views(XrSession, const XrViewLocateInfo* info, XrViewState* view_state,
                      std::uint32_t capacity, std::uint32_t* count, XrView* views) {
    MOCK_ENTER("xrLocateViews");
    const Space* base = find(s.spaces, info->space);
    if (base == nullptr) return XR_ERROR_HANDLE_INVALID;
    *count = static_cast<std::uint32_t>(s.config.eyes);
    if (capacity == 0) return XR_SUCCESS;
    if (capacity < *count) return XR_ERROR_SIZE_INSUFFICIENT;
    if (s.head.valid)
        view_state->viewStateFlags = XR_VIEW_STATE_ORIENTATION_VALID_BIT | XR_VIEW_STATE_POSITION_VALID_BIT;
    for (int eye = 0; eye < s.config.eyes; ++eye) {
        views[eye].pose = xr::to_xr(inverse(pose_of(s, *base)) * eye_of(s, eye));
        // As in real headsets the outer side is wider.
        const float outer = half_fov, inner = 0.9F * half_fov;
        views[eye].fov = eye == 0 ? XrFovf{-outer, inner, half_fov, -half_fov}
                                  : XrFovf{-inner, outer, half_fov, -half_fov};
    }
    return XR_SUCCESS;
}

XrResult reference_spaces(XrSession, std::uint32_t capacity, std::uint32_t* count,
                          XrReferenceSpaceType* values) {
    MOCK_ENTER("xrEnumerateReferenceSpaces");
    std::vector<XrReferenceSpaceType> all{XR_REFERENCE_SPACE_TYPE_VIEW, XR_REFERENCE_SPACE_TYPE_LOCAL};
    if (s.config.stage) all.push_back(XR_REFERENCE_SPACE_TYPE_STAGE);
    if (s.enabled.count("XR_EXT_local_floor") != 0)
        all.push_back(static_cast<XrReferenceSpaceType>(1000426000));
    *count = static_cast<std::uint32_t>(all.size());
    if (capacity == 0) return XR_SUCCESS;
    if (capacity < *count) return XR_ERROR_SIZE_INSUFFICIENT;
    std::copy(all.begin(), all.end(), values);
    return XR_SUCCESS;
}

XrResult create_reference_space(XrSession, const XrReferenceSpaceCreateInfo* info, XrSpace* space) {
    MOCK_ENTER("xrCreateReferenceSpace");
    auto made = std::make_unique<Space>();
    made->offset = xr::to_pose(info->poseInReferenceSpace);
    switch (static_cast<int>(info->referenceSpaceType)) {
        case XR_REFERENCE_SPACE_TYPE_VIEW:
            made->kind = SpaceKind::view;
            break;
        case XR_REFERENCE_SPACE_TYPE_LOCAL:
            made->kind = SpaceKind::local;
            break;
        case XR_REFERENCE_SPACE_TYPE_STAGE:
            if (!s.config.stage) return XR_ERROR_REFERENCE_SPACE_UNSUPPORTED;
            made->kind = SpaceKind::stage;
            break;
        default:
            made->kind = SpaceKind::local_floor;
    }
    *space = reinterpret_cast<XrSpace>(made.get());
    s.spaces.insert(std::move(made));
    return XR_SUCCESS;
}

XrResult destroy_space(XrSpace space) {
    MOCK_ENTER("xrDestroySpace");
    if (!erase(s.spaces, space)) s.violation("xrDestroySpace of an unknown space");
    return XR_SUCCESS;
}

XrResult locate_space(XrSpace space, XrSpace base, XrTime, XrSpaceLocation* location) {
    MOCK_ENTER("xrLocateSpace");
    const Space *what = find(s.spaces, space), *in = find(s.spaces, base);
    if (what == nullptr || in == nullptr) return XR_ERROR_HANDLE_INVALID;
    location->locationFlags = 0;
    if (!space_valid(s, *what) || !space_valid(s, *in)) return XR_SUCCESS;
    location->locationFlags = XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_POSITION_VALID_BIT;
    if (space_tracked(s, *what))
        location->locationFlags |=
            XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT | XR_SPACE_LOCATION_POSITION_TRACKED_BIT;
    location->pose = xr::to_xr(inverse(pose_of(s, *in)) * pose_of(s, *what));
    return XR_SUCCESS;
}

Event event_named(const std::string& name) {
    static const std::map<std::string, Event> names{{"take-off", Event::take_off},
                                                    {"put-on", Event::put_on},
                                                    {"lose-focus", Event::lose_focus},
                                                    {"regain-focus", Event::regain_focus},
                                                    {"exit", Event::user_exit},
                                                    {"lose-session", Event::lose_session},
                                                    {"lose-instance", Event::lose_instance},
                                                    {"recentre", Event::recentre}};
    return names.at(name);
}

std::string word(const ScriptLine& line, std::size_t i) {
    return i < line.words.size() ? line.words[i] : "0";
}
double number(const ScriptLine& line, std::size_t i) { return std::stod(word(line, i)); }

Pose script_pose(const ScriptLine& line, std::size_t first) {
    return {{number(line, first), number(line, first + 1), number(line, first + 2)},
            glm::normalize(Quat(number(line, first + 6), number(line, first + 3), number(line, first + 4),
                                number(line, first + 5)))};
}

void apply_line(State& s, const ScriptLine& line) {
    const std::string what = word(line, 0);
    const std::size_t side = word(line, 1) == "right" ? 1 : 0;
    if (what == "head") {
        s.head.pose = script_pose(line, 1);
    } else if (what == "hand") {
        Hand& hand = s.hands.at(side);
        hand.active = true;
        hand.grip = hand.aim = script_pose(line, 2);
        hand.trigger = hand.squeeze = static_cast<float>(number(line, 9));
    } else if (what == "no-hand") {
        s.hands.at(side).active = false;
    } else if (what == "off") {
        apply_event(s, Event::take_off);
        s.put_on_at =
            std::chrono::steady_clock::now() + std::chrono::milliseconds(std::lround(1e3 * number(line, 1)));
    } else if (what == "event") {
        apply_event(s, event_named(word(line, 1)));
    }
}

}  // namespace

// Lines of frame 0 configure the mock.
void load_script(State& s) {
    const char* file = std::getenv("MOCK_OPENXR_SCRIPT");
    if (file == nullptr) return;
    std::ifstream in(file);
    for (std::string text; std::getline(in, text);) {
        std::istringstream words(text);
        ScriptLine line;
        if (!(words >> line.frame)) continue;
        for (std::string one; words >> one;) line.words.push_back(one);
        if (line.words.empty()) continue;
        if (line.frame > 0) {
            s.script.push_back(line);
        } else if (line.words.front() == "size") {
            s.config.width = static_cast<std::uint32_t>(number(line, 1));
            s.config.height = static_cast<std::uint32_t>(number(line, 2));
        } else if (line.words.front() == "real-time") {
            s.config.real_time = true;
        } else {
            apply_line(s, line);
        }
    }
}

void run_script(State& s) {
    for (const ScriptLine& line : s.script)
        if (line.frame == s.begun) {
            apply_line(s, line);
            s.record_pictures = s.record_pictures || line.words.front() == "picture";
        }
}

void save_script_pictures(State& s) {
    for (const ScriptLine& line : s.script) {
        if (line.frame != s.begun || line.words.front() != "picture" || s.last_frame.eyes.empty()) continue;
        const EyeRecord& first = s.last_frame.eyes.front();
        std::ofstream out(word(line, 1), std::ios::binary);
        out << "P6 " << first.width * s.last_frame.eyes.size() << " " << first.height << " 255\n";
        for (std::uint32_t y = 0; y < first.height; ++y)
            for (const EyeRecord& eye : s.last_frame.eyes)
                for (std::uint32_t x = 0; x < eye.width; ++x)
                    out.write(reinterpret_cast<const char*>(
                                  &eye.rgba[4 * (static_cast<std::size_t>(y) * eye.width + x)]),
                              3);
        s.record_pictures = false;
    }
}

void add_session_functions(Functions& f) {
    f.insert({{"xrCreateSession", as_void(create_session)},
              {"xrDestroySession", as_void(destroy_session)},
              {"xrBeginSession", as_void(begin_session)},
              {"xrEndSession", as_void(end_session)},
              {"xrRequestExitSession", as_void(request_exit)},
              {"xrWaitFrame", as_void(wait_frame)},
              {"xrBeginFrame", as_void(begin_frame)},
              {"xrEndFrame", as_void(end_frame)},
              {"xrLocateViews", as_void(locate_views)},
              {"xrEnumerateReferenceSpaces", as_void(reference_spaces)},
              {"xrCreateReferenceSpace", as_void(create_reference_space)},
              {"xrDestroySpace", as_void(destroy_space)},
              {"xrLocateSpace", as_void(locate_space)}});
}

}  // namespace bolt::mock_openxr
