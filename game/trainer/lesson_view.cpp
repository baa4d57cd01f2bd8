#include "game/trainer/lesson_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/render/camera.hpp"
#include "game/motion/path_planning.hpp"
#include "game/scene/annotations.hpp"
#include "game/trainer/active_lesson.hpp"
#include "game/trainer/hud.hpp"
#include "game/view/camera.hpp"
#include "game/view/labels.hpp"

namespace bolt::trainer {

namespace {

// m between tool and nut. A hovering hand is closer than show_distance.
constexpr double show_distance = 0.07, hide_distance = 0.1;
// Part of the pull during which the eye should see nut and jaw.
constexpr double considered_swing = to_radians(60.0);
constexpr double max_rotation = to_radians(70.0);  // of the tool, before another eye is chosen
constexpr double min_alignment = 0.9;  // cosine of the angle between the tool's normal and the bolt
constexpr float close_up_width = 240.0F, close_up_margin = 12.0F;  // points
constexpr float max_width_share = 0.28F;                           // fraction of the picture
constexpr float effort_width = 290.0F, effort_height = 62.0F;      // points, at the bottom centre (hud.cpp)
constexpr const char* window_name = "##close_up";

// The nut that the tool is near.
std::optional<std::size_t> nut_near(const ActiveLesson& active, const Pose& tool) {
    const servo::Setup& setup = active.session->setup();
    std::optional<std::size_t> found;
    double least = show_distance;
    for (std::size_t i = 0; i < setup.nuts.size(); ++i) {
        const Vec3 middle = world::nut_centre(active.workplace.world, setup, i);
        // Skip a wrench that is still tilted on its way.
        if (std::abs(glm::dot(tool.orientation * Vec3(0, 0, 1), setup.nuts[i].axis)) < min_alignment)
            continue;
        const double distance = glm::distance(tool.position, middle);
        const double reach = active.view.close_up.joint == i ? hide_distance : show_distance;
        if (distance >= reach || (found && distance >= least)) continue;
        least = distance;
        found = i;
    }
    return found;
}

// The pose of the tool that carries the eye. The eye does not twist with the fingers.
Pose tool_at_work(const ActiveLesson& active) {
    if (hand_of(active).wrench) return tool_of(active).pose;
    return scene::frame_towards(hand_of(active).pose, active.shoulder, 0.0);
}

void choose_eye(ActiveLesson& active, std::size_t joint) {
    const servo::Setup& setup = active.session->setup();
    const std::optional<servo::ToolContact>& obstacles = active.session->state().tool_contact;
    const Vec3 nut = world::nut_centre(active.workplace.world, setup, joint);
    view::ViewTarget target{setup, obstacles ? &*obstacles : nullptr, joint, nut, std::nullopt};
    // The tool may still hover: use its pose on the nut.
    Pose tool = active.view.close_up.tool;
    tool.position = nut;
    if (hand_of(active).wrench) target.wrench = tool;
    const double sense = active.session->lesson().task == lesson::Task::loosen ? 1.0 : -1.0;

    const double swing =
        hand_of(active).wrench ? sense * std::min(hand_of(active).free_swing, considered_swing) : 0.0;
    const view::CloseUpEye eye = view::close_up_eye(target, tool, swing, active.view.visibility);
    active.view.close_up.eye = eye.position;
    active.view.close_up.visibility = eye.visibility;
}

bool overlap(const render::Rectangle& a, const render::Rectangle& b) {
    return a.low.x < b.high.x && b.low.x < a.high.x && a.low.y < b.high.y && b.low.y < a.high.y;
}

render::Eye eye_of(const ActiveLesson& active, float aspect) {
    const double size = active.session->setup().nuts[*active.view.close_up.joint].across_flats;
    render::Perspective lens;
    lens.fov = static_cast<float>(view::close_up_fov);
    lens.aspect = aspect;
    lens.znear = static_cast<float>(0.2 * size);
    lens.zfar = 1.0F;  // m; leaves the background out
    return render::make_eye(glm::vec3(active.view.close_up.tool * active.view.close_up.eye),
                            glm::vec3(active.view.close_up.tool.position), lens);
}

}  // namespace

void update_close_up(ActiveLesson& active) {
    CloseUp& close_up = active.view.close_up;
    const bool allowed = close_up.wanted && !active.clock.finished &&
                         active.session->lesson().mode != lesson::Mode::assessment;
    close_up.tool = tool_at_work(active);
    const auto joint = allowed ? nut_near(active, close_up.tool) : std::nullopt;
    const bool turned =
        glm::length(rotation_vector(close_up.tool.orientation *
                                    glm::conjugate(close_up.chosen_orientation))) > max_rotation;
    const bool changed = joint != close_up.joint || hand_of(active).wrench != close_up.with_wrench || turned;
    close_up.joint = joint;
    close_up.with_wrench = hand_of(active).wrench;
    if (!joint || !changed) return;
    close_up.chosen_orientation = close_up.tool.orientation;
    choose_eye(active, *joint);
}

std::optional<render::Rectangle> close_up_rectangle(const glm::dvec2& picture, float scale,
                                                    std::span<const render::Rectangle> occupied) {
    const glm::vec2 whole(picture);
    const float wide = std::round(
        std::min(close_up_width * scale, max_width_share * std::min(whole.x, whole.y * 4.0F / 3.0F)));
    const glm::vec2 size(wide, std::round(0.75F * wide));
    const float side = std::round(close_up_margin * scale);
    const float effort_left = 0.5F * (whole.x - effort_width * scale);
    for (const float above : {0.0F, std::round(effort_height * scale)}) {
        if (above == 0.0F && side + wide > effort_left) continue;
        const glm::vec2 low(side, whole.y - side - above - size.y);
        const render::Rectangle place{low, low + size};
        const auto covers = [&](const render::Rectangle& other) { return overlap(place, other); };
        if (low.y >= 0.0F && std::none_of(occupied.begin(), occupied.end(), covers)) return place;
    }
    return std::nullopt;
}

Status draw_close_up(const DrawContext& context, const ActiveLesson& active, const glm::dvec2& picture,
                     float scale) {
    if (!active.view.close_up.joint) return {};
    const auto place = close_up_rectangle(picture, scale, occupied_areas());
    if (!place) return {};
    const glm::vec2 size = place->high - place->low;
    const VkExtent2D extent{static_cast<std::uint32_t>(size.x), static_cast<std::uint32_t>(size.y)};
    const render::Eye eye = eye_of(active, size.x / size.y);
    render::Scene scene = active.scene;
    scene.labels.clear();
    for (render::Object& object : scene.objects) object.outline.w = 0.0F;  // outlines would hide the nut
    BOLT_TRY(context.renderer.render(context.frame, scene, {&eye, 1}, extent, 1));
    ImGui::SetNextWindowPos({place->low.x, place->low.y});
    ImGui::SetNextWindowSize({size.x, size.y});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0F, 0.0F});
    ImGui::Begin(window_name, nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoBringToFrontOnFocus);
    ImGui::Image(context.ui.picture(context.renderer.picture(0, 1)), {size.x, size.y});
    ImGui::GetWindowDrawList()->AddRect({place->low.x, place->low.y}, {place->high.x, place->high.y},
                                        IM_COL32(235, 240, 245, 200), 0.0F, 0, 2.0F * scale);
    ImGui::End();
    ImGui::PopStyleVar();
    return {};
}

namespace {

constexpr double room_fov = to_radians(60.0);  // vertical
// rad, em size in a room of a label of `normal_label` px in a window: 20 dmm (mm at 1 m).
constexpr float label_angle = 0.020F, normal_label = 16.0F;
constexpr double min_visibility = 0.15, max_time_out_of_view = 3.0;  // fraction of nut and jaw; s

// The joint that the hand works at, else the due one. An assessment does not reveal the due joint.
std::optional<std::size_t> joint_to_show(const ActiveLesson& active) {
    if (active.session->lesson().mode == lesson::Mode::assessment) return hand_of(active).nut;
    if (hand_of(active).nut && hand_of(active).action != HandAction::resting) return hand_of(active).nut;
    const lesson::LessonStep* due = trainer::due(active.undo, active.session->lesson());
    return due != nullptr ? std::optional(due->joint) : std::nullopt;
}

view::ViewTarget view_of(const ActiveLesson& active, std::size_t joint) {
    const servo::Setup& setup = active.session->setup();
    const std::optional<servo::ToolContact>& obstacles = active.session->state().tool_contact;
    view::ViewTarget target{setup, obstacles ? &*obstacles : nullptr, joint,
                            world::nut_centre(active.workplace.world, setup, joint), std::nullopt};
    if (hand_of(active).wrench && hand_of(active).nut == joint) target.wrench = tool_of(active).pose;
    return target;
}

// The wrist's position, m, at the nut, now or when the hand will be there.
Vec3 wrist_at(const ActiveLesson& active, std::size_t joint) {
    const servo::Setup& setup = active.session->setup();
    const bool at_nut = hand_of(active).nut == joint && hand_of(active).action != HandAction::resting;
    if (hand_of(active).wrench) {
        const bool loosens = active.session->lesson().task == lesson::Task::loosen;
        const Pose tool =
            at_nut ? tool_of(active).pose
                   : wrench_pose_on_nut(hand_of(active).rest, setup, active.session->state(), joint, loosens);
        const std::size_t posture =
            scene::natural_handle_posture(postures_of(active), tool, Vec3(0, 1, 0), active.shoulder);
        return tool * postures_of(active).on_handle.at(posture).position[hand::wrist];
    }
    const servo::NutGeometry& nut = setup.nuts[joint];
    const Pose at{world::nut_centre(active.workplace.world, setup, joint),
                  motion::tool_orientation(nut, 0.0, false)};
    return scene::frame_towards(at, active.shoulder, 0.0) * postures_of(active).on_nut.position[hand::wrist];
}

void show_due_joint(ActiveLesson& active, const glm::dvec2& picture) {
    const auto joint = joint_to_show(active);
    if (!joint) return;
    view::ViewTarget target = view_of(active, *joint);
    target.wrist = wrist_at(active, *joint);
    target.aspect = picture.x / picture.y;
    active.view.camera.glide_to(view::find_view(target, active.view.visibility, active.view.camera.goal));
    active.view.out_of_view = 0.0;
}

// Returns true if joint_to_show() has been out of the picture or hidden for too long. Always false in an
// assessment, which gives no help.
bool joint_out_of_view(ActiveLesson& active, const LessonFrame& frame) {
    const auto joint = joint_to_show(active);
    if (!joint || active.session->lesson().mode == lesson::Mode::assessment || active.clock.finished ||
        active.clock.paused)
        return false;
    const view::ViewTarget target = view_of(active, *joint);
    const Projection projection = projection_of(active, frame.size);
    const auto at = project(projection, target.nut);
    const glm::dvec2 edge = 0.04 * frame.size;
    const bool inside = at && at->x > edge.x && at->y > edge.y && at->x < frame.size.x - edge.x &&
                        at->y < frame.size.y - edge.y;
    const bool visible = inside && view::visibility_from(target, active.view.visibility,
                                                         Vec3(projection.eye.position)) > min_visibility;
    active.view.out_of_view = visible ? 0.0 : active.view.out_of_view + frame.seconds;
    return active.view.out_of_view > max_time_out_of_view;
}

}  // namespace

Projection projection_of(const ActiveLesson& active, const glm::dvec2& size) {
    if (active.view.head) {
        // A picture of what the user looks at; the eyes of the display are drawn with their own projections.
        const double half = std::atan(std::tan(0.5 * room_fov) * size.x / size.y);
        return {render::make_eye(*active.view.head, {-half, half, 0.5 * room_fov, -0.5 * room_fov},
                                 view::immersive_range.near, view::immersive_range.far),
                size};
    }
    return {view::eye_of(active.view.camera.shown, render::bounds(active.scene),
                         static_cast<float>(size.x / size.y)),
            size};
}

void view_system(scene::SceneWorld& world, LessonFrame& frame) {
    ActiveLesson& active = frame.active;
    if (frame.input.triggered(Action::whole_view) && !active.view.head)
        active.view.camera.glide_to(view::fit_to_box(active.view.camera.goal, active.workplace.workpiece,
                                                     static_cast<float>(frame.size.x / frame.size.y)));
    // In a room the user moves the head; nothing else moves the view.
    if (!active.view.head && active.view.help &&
        (frame.input.triggered(Action::find_view) || joint_out_of_view(active, frame)))
        show_due_joint(active, frame.size);
    (void)active.view.camera.advance(frame.seconds);
    scene::fade_near_arms(world, active.view.head ? active.view.head->position
                                                  : Vec3(view::viewpoint_of(active.view.camera.shown).eye));

    const bool assists = active.session->lesson().mode != lesson::Mode::assessment;
    if (frame.input.triggered(Action::close_up)) active.view.close_up.wanted = !active.view.close_up.wanted;
    update_close_up(active);
    active.scene.cut_away.strength = 0.0F;
    if (!assists) return;
    const bool working = hand_of(active).nut && hand_of(active).action != HandAction::resting;
    // A hand that waits above the previous nut would hide the next one: fade only the hand.
    if (const auto joint = working ? hand_of(active).nut : joint_to_show(active))
        scene::fade_occluders(world, active.scene, active.session->setup(), *joint,
                              working ? scene::Occluders::all : scene::Occluders::hand);
}

namespace {

// The label of a joint's clamp force; after the lesson with the symbol of its verdict, which the outline
// shows as a colour.
render::Label clamp_label(const ActiveLesson& active, const words::Words& words, std::size_t joint) {
    const session::LessonSession& session = *active.session;
    render::Label label =
        scene::clamp_label(words, session.assembly(), session.setup(), active.workplace.world, joint);
    if (active.clock.finished && active.verdicts[joint] != lesson::Verdict::none)
        label.text = fmt::format("{} {}", view::symbol_of(active.verdicts[joint]), label.text);
    return label;
}

// Adds the areas of the nuts, so that no label covers another joint's nut.
void add_nut_areas(const ActiveLesson& active, const Projection& projection,
                   std::vector<render::Rectangle>& occupied) {
    const servo::Setup& setup = active.session->setup();
    for (std::size_t i = 0; i < setup.nuts.size(); ++i) {
        const servo::NutGeometry& nut = setup.nuts[i];
        const Vec3 middle = world::nut_centre(active.workplace.world, setup, i);
        const auto at = project(projection, middle),
                   edge = project(projection, middle + nut.across_flats * nut.e1),
                   other = project(projection, middle + nut.across_flats * nut.e2);
        if (!at || !edge || !other) continue;
        const auto radius =
            static_cast<float>(0.6 * std::max(glm::distance(*at, *edge), glm::distance(*at, *other)));
        occupied.push_back({glm::vec2(*at) - radius, glm::vec2(*at) + radius});
    }
}

// In a room a text has an angular size, whatever the resolution of the display.
void size_for_room(std::vector<render::Label>& labels, const Pose& head) {
    for (render::Label& label : labels) {
        if (label.placement != render::LabelPlacement::on_screen) continue;
        label.placement = render::LabelPlacement::facing;
        const auto distance = static_cast<float>(glm::distance(Vec3(label.position), head.position));
        label.height *= label_angle / normal_label * distance;
        label.offset_px = glm::vec2(0.0F);
    }
}

}  // namespace

void label_system(scene::SceneWorld& world, LessonFrame& frame) {
    ActiveLesson& active = frame.active;
    const session::LessonSession& session = *active.session;
    const servo::Setup& setup = session.setup();
    const lesson::LessonStep* due = trainer::due(active.undo, session.lesson());
    active.scene.labels.clear();
    // An assessment shows nothing that a trainee could not see on a real machine.
    const bool assists = session.lesson().mode != lesson::Mode::assessment;
    if (frame.input.triggered(Action::clamp_map)) active.view.clamp_map = !active.view.clamp_map && assists;
    if (!active.clock.finished)
        if (auto figure = scene::work_label(frame.words, session.lesson(), setup, world, active.palette))
            active.scene.labels.push_back(*figure);
    // In a window the interface shows the pull (draw_effort).
    if (!active.clock.finished && active.view.head)
        if (auto pull = scene::pull_label(frame.words, setup, world)) active.scene.labels.push_back(*pull);
    const auto add_name = [&](std::size_t joint, bool is_due) {
        const std::string& id = session.assembly().joints[joint].design.id;
        render::Label label = scene::plate_label(is_due ? fmt::format("{} {}", view::due_symbol, id) : id,
                                                 scene::label_position(setup, world, joint), 16.0F);
        label.color = is_due ? active.palette.due : scene::label_color;
        label.offset_px = {0.0F, 8.0F};
        active.scene.labels.push_back(label);
    };
    const bool guided = session.lesson().mode == lesson::Mode::guided;
    const std::size_t marked = due != nullptr && guided ? due->joint : SIZE_MAX;
    const std::int16_t engaged = world.only<world::ToolState>().joint;
    for (std::size_t i = 0; i < setup.nuts.size(); ++i) {
        // In a room the labels of one nut would cover each other: the values of the held nut matter more.
        if (active.view.head && !active.clock.finished && engaged == static_cast<std::int16_t>(i)) continue;
        if (active.view.clamp_map || active.clock.finished)
            active.scene.labels.push_back(clamp_label(active, frame.words, i));
        else if (i == marked || active.pointer.nut == i)
            add_name(i, i == marked);
    }
    if (active.view.head) return size_for_room(active.scene.labels, *active.view.head);
    if (frame.fonts == nullptr) return;
    const Projection projection = projection_of(active, frame.size);
    std::vector<render::Rectangle> occupied = active.view.occupied;
    if (!active.view.clamp_map && !active.clock.finished) add_nut_areas(active, projection, occupied);
    view::separate_labels(*frame.fonts, active.scene.labels, projection.eye, glm::vec2(frame.size), occupied);
}

void collect_system(scene::SceneWorld& world, LessonFrame& frame) {
    scene::appearance_system(world);
    view::collect_objects(world, frame.active.scene);
}

}  // namespace bolt::trainer
