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

constexpr double appears = 0.07, goes = 0.1;  // m, tool from nut; a hand hovers nearer than the first
constexpr double swing = to_radians(60.0);    // that the eye is good for
constexpr double past = to_radians(70.0), level = 0.9;
constexpr float width = 240.0F, margin = 12.0F;                // points
constexpr float widest = 0.28F;                                // of the picture
constexpr float strain_width = 290.0F, strain_height = 62.0F;  // points, in the middle below (hud.cpp)
constexpr const char* window_name = "##close_up";

// The nut that the tool is next to.
std::optional<std::size_t> near_to(const ActiveLesson& p, const Pose& tool) {
    const servo::Setup& setup = p.course->setup();
    std::optional<std::size_t> found;
    double least = appears;
    for (std::size_t i = 0; i < setup.nuts.size(); ++i) {
        const Vec3 middle = world::nut_centre(p.place.world, setup, i);
        // On its way, wrong side up, it has nothing to look at.
        if (std::abs(glm::dot(tool.orientation * Vec3(0, 0, 1), setup.nuts[i].axis)) < level) continue;
        const double far = glm::distance(tool.position, middle);
        const double reach = p.view.close_up.joint == i ? goes : appears;
        if (far >= reach || (found && far >= least)) continue;
        least = far;
        found = i;
    }
    return found;
}

// Fingers twist, their eye does not.
Pose tool_at_work(const ActiveLesson& p) {
    if (hand_of(p).wrench) return tool_of(p).pose;
    return scene::towards(hand_of(p).pose, p.shoulder, 0.0);
}

void choose_eye(ActiveLesson& p, std::size_t joint) {
    const servo::Setup& setup = p.course->setup();
    const std::optional<servo::ToolContact>& obstacles = p.course->state().tool_contact;
    const Vec3 nut = world::nut_centre(p.place.world, setup, joint);
    view::ViewOf of{setup, obstacles ? &*obstacles : nullptr, joint, nut, std::nullopt};
    // As it will be on the nut: it may hover yet.
    Pose tool = p.view.close_up.tool;
    tool.position = nut;
    if (hand_of(p).wrench) of.wrench = tool;
    const double sense = p.course->lesson().task == lesson::Task::loosen ? 1.0 : -1.0;

    const double through = hand_of(p).wrench ? sense * std::min(hand_of(p).room, swing) : 0.0;
    const view::CloseUpEye eye = view::close_up_eye(of, tool, through, p.view.sight);
    p.view.close_up.eye = eye.at;
    p.view.close_up.seen = eye.seen;
}

bool meet(const render::Rectangle& a, const render::Rectangle& b) {
    return a.low.x < b.high.x && b.low.x < a.high.x && a.low.y < b.high.y && b.low.y < a.high.y;
}

render::Eye eye_of(const ActiveLesson& p, float aspect) {
    const double size = p.course->setup().nuts[*p.view.close_up.joint].across_flats;
    render::Perspective lens;
    lens.fov = static_cast<float>(view::close_up_fov);
    lens.aspect = aspect;
    lens.znear = static_cast<float>(0.2 * size);
    lens.zfar = 1.0F;  // what is far is no part of a close-up
    return render::make_eye(glm::vec3(p.view.close_up.tool * p.view.close_up.eye),
                            glm::vec3(p.view.close_up.tool.position), lens);
}

}  // namespace

void update_close_up(ActiveLesson& p) {
    CloseUp& c = p.view.close_up;
    const bool may = c.wished && !p.pace.finished && p.course->lesson().mode != lesson::Mode::assessment;
    c.tool = tool_at_work(p);
    const auto joint = may ? near_to(p, c.tool) : std::nullopt;
    const bool turned = glm::length(rotation_vector(c.tool.orientation * glm::conjugate(c.chosen))) > past;
    const bool other = joint != c.joint || hand_of(p).wrench != c.wrench || turned;
    c.joint = joint;
    c.wrench = hand_of(p).wrench;
    if (!joint || !other) return;
    c.chosen = c.tool.orientation;
    choose_eye(p, *joint);
}

std::optional<render::Rectangle> close_up_place(const glm::dvec2& picture, float scale,
                                                std::span<const render::Rectangle> taken) {
    const glm::vec2 whole(picture);
    const float wide = std::round(std::min(width * scale, widest * std::min(whole.x, whole.y * 4.0F / 3.0F)));
    const glm::vec2 size(wide, std::round(0.75F * wide));
    const float side = std::round(margin * scale);
    const float strain = 0.5F * (whole.x - strain_width * scale);
    for (const float above : {0.0F, std::round(strain_height * scale)}) {
        if (above == 0.0F && side + wide > strain) continue;
        const glm::vec2 low(side, whole.y - side - above - size.y);
        const render::Rectangle place{low, low + size};
        const auto over = [&](const render::Rectangle& other) { return meet(place, other); };
        if (low.y >= 0.0F && std::none_of(taken.begin(), taken.end(), over)) return place;
    }
    return std::nullopt;
}

Status draw_close_up(const Drawing& on, const ActiveLesson& p, const glm::dvec2& picture, float scale) {
    if (!p.view.close_up.joint) return {};
    const auto place = close_up_place(picture, scale, occupied_areas());
    if (!place) return {};
    const glm::vec2 size = place->high - place->low;
    const VkExtent2D extent{static_cast<std::uint32_t>(size.x), static_cast<std::uint32_t>(size.y)};
    const render::Eye eye = eye_of(p, size.x / size.y);
    render::Scene scene = p.scene;
    scene.labels.clear();
    for (render::Object& object : scene.objects) object.outline.w = 0.0F;  // so near they only cover
    BOLT_TRY(on.renderer.render(on.frame, scene, {&eye, 1}, extent, 1));
    ImGui::SetNextWindowPos({place->low.x, place->low.y});
    ImGui::SetNextWindowSize({size.x, size.y});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0F, 0.0F});
    ImGui::Begin(window_name, nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoBringToFrontOnFocus);
    ImGui::Image(on.ui.picture(on.renderer.picture(0, 1)), {size.x, size.y});
    ImGui::GetWindowDrawList()->AddRect({place->low.x, place->low.y}, {place->high.x, place->high.y},
                                        IM_COL32(235, 240, 245, 200), 0.0F, 0, 2.0F * scale);
    ImGui::End();
    ImGui::PopStyleVar();
    return {};
}

namespace {

constexpr double lost_below = 0.15, lost_after = 3.0;  // of nut and jaw; s

// The joint that is worked at, or is due; which one is due an assessment does not tell.
std::optional<std::size_t> due_joint(const ActiveLesson& p) {
    if (p.course->lesson().mode == lesson::Mode::assessment) return hand_of(p).nut;
    if (hand_of(p).nut && hand_of(p).doing != Doing::resting) return hand_of(p).nut;
    const lesson::Step* due = trainer::due(p.undo, p.course->lesson());
    return due != nullptr ? std::optional(due->joint) : std::nullopt;
}

view::ViewOf view_of(const ActiveLesson& p, std::size_t joint) {
    const servo::Setup& setup = p.course->setup();
    const std::optional<servo::ToolContact>& obstacles = p.course->state().tool_contact;
    view::ViewOf of{setup, obstacles ? &*obstacles : nullptr, joint,
                    world::nut_centre(p.place.world, setup, joint), std::nullopt};
    if (hand_of(p).wrench && hand_of(p).nut == joint) of.wrench = tool_of(p).pose;
    return of;
}

// Where the hand is at the nut, or will be.
Vec3 wrist_at(const ActiveLesson& p, std::size_t joint) {
    const servo::Setup& setup = p.course->setup();
    const bool there = hand_of(p).nut == joint && hand_of(p).doing != Doing::resting;
    if (hand_of(p).wrench) {
        const bool loosens = p.course->lesson().task == lesson::Task::loosen;
        const Pose tool =
            there ? tool_of(p).pose : wrench_on(hand_of(p).rest, setup, p.course->state(), joint, loosens);
        const std::size_t grip = scene::natural_grip(p.postures, tool, Vec3(0, 1, 0), p.shoulder);
        return tool * p.postures.on_handle.at(grip).position[hand::wrist];
    }
    const servo::NutGeometry& nut = setup.nuts[joint];
    const Pose at{world::nut_centre(p.place.world, setup, joint), motion::orientation_of(nut, 0.0, false)};
    return scene::towards(at, p.shoulder, 0.0) * p.postures.on_nut.position[hand::wrist];
}

void look_at_work(ActiveLesson& p, const glm::dvec2& picture) {
    const auto joint = due_joint(p);
    if (!joint) return;
    view::ViewOf of = view_of(p, *joint);
    of.wrist = wrist_at(p, *joint);
    of.aspect = picture.x / picture.y;
    p.view.camera.go(view::find_view(of, p.view.sight, p.view.camera.goal));
    p.view.unseen = 0.0;
}

// What is due has been out of the picture or hidden for a while. Not in an assessment: nobody helps there.
bool lost(ActiveLesson& p, const Frame& frame) {
    const auto joint = due_joint(p);
    if (!joint || p.course->lesson().mode == lesson::Mode::assessment || p.pace.finished || p.pace.paused)
        return false;
    const view::ViewOf of = view_of(p, *joint);
    const Screen screen = screen_of(p, frame.size);
    const auto at = project(screen, of.nut);
    const glm::dvec2 edge = 0.04 * frame.size;
    const bool inside = at && at->x > edge.x && at->y > edge.y && at->x < frame.size.x - edge.x &&
                        at->y < frame.size.y - edge.y;
    const bool seen = inside && view::seen_from(of, p.view.sight, Vec3(screen.eye.position)) > lost_below;
    p.view.unseen = seen ? 0.0 : p.view.unseen + frame.seconds;
    return p.view.unseen > lost_after;
}

}  // namespace

Screen screen_of(const ActiveLesson& p, const glm::dvec2& size) {
    return {view::eye_of(p.view.camera.shown, render::bounds(p.scene), static_cast<float>(size.x / size.y)),
            size};
}

void view_system(scene::World& world, Frame& frame) {
    ActiveLesson& p = frame.playing;
    if (frame.wanted.wants(Action::whole_view))
        p.view.camera.go(view::framing(p.view.camera.goal, p.place.machine,
                                       static_cast<float>(frame.size.x / frame.size.y)));
    if (frame.wanted.wants(Action::find_view) || lost(p, frame)) look_at_work(p, frame.size);
    (void)p.view.camera.advance(frame.seconds);
    scene::thin_near_arms(world, Vec3(view::viewpoint_of(p.view.camera.shown).eye));

    const bool helps = p.course->lesson().mode != lesson::Mode::assessment;
    if (frame.wanted.wants(Action::close_up)) p.view.close_up.wished = !p.view.close_up.wished;
    update_close_up(p);
    p.scene.cut_away.strength = 0.0F;
    if (!helps) return;
    const bool works = hand_of(p).nut && hand_of(p).doing != Doing::resting;
    // A hand that waits above the last nut fills the picture of the next one.
    if (const auto joint = works ? hand_of(p).nut : due_joint(p))
        scene::keep_in_sight(world, p.scene, p.course->setup(), *joint,
                             works ? scene::Hides::all : scene::Hides::hand);
}

namespace {

// After the lesson with the sign of what became of the joint, as its outline has the colour.
render::Label clamp_of(const ActiveLesson& p, const words::Words& words, std::size_t joint) {
    const session::Course& course = *p.course;
    render::Label label = scene::clamp_label(words, course.assembly(), course.setup(), p.place.world, joint);
    if (p.pace.finished && p.verdicts[joint] != lesson::Verdict::none)
        label.text = fmt::format("{} {}", view::sign_of(p.verdicts[joint]), label.text);
    return label;
}

// A plate over another joint's nut would name the wrong one.
void keep_off_nuts(const ActiveLesson& p, const Screen& screen, std::vector<render::Rectangle>& taken) {
    const servo::Setup& setup = p.course->setup();
    for (std::size_t i = 0; i < setup.nuts.size(); ++i) {
        const servo::NutGeometry& nut = setup.nuts[i];
        const Vec3 middle = world::nut_centre(p.place.world, setup, i);
        const auto at = project(screen, middle), edge = project(screen, middle + nut.across_flats * nut.e1),
                   other = project(screen, middle + nut.across_flats * nut.e2);
        if (!at || !edge || !other) continue;
        const auto radius =
            static_cast<float>(0.6 * std::max(glm::distance(*at, *edge), glm::distance(*at, *other)));
        taken.push_back({glm::vec2(*at) - radius, glm::vec2(*at) + radius});
    }
}

}  // namespace

void label_system(scene::World& world, Frame& frame) {
    ActiveLesson& p = frame.playing;
    const session::Course& course = *p.course;
    const servo::Setup& setup = course.setup();
    const lesson::Step* due = trainer::due(p.undo, course.lesson());
    p.scene.labels.clear();
    // What a trainee at a real machine would not see is no part of an assessment.
    const bool helps = course.lesson().mode != lesson::Mode::assessment;
    if (frame.wanted.wants(Action::flange_map)) p.view.clamp_map = !p.view.clamp_map && helps;
    if (!p.pace.finished)
        if (auto figure = scene::work_label(frame.words, course.lesson(), setup, world, p.palette))
            p.scene.labels.push_back(*figure);
    const auto named = [&](std::size_t joint, bool is_due) {
        const std::string& id = course.assembly().joints[joint].design.id;
        render::Label label = scene::plate(is_due ? fmt::format("{} {}", view::due_sign, id) : id,
                                           scene::above_nut(setup, world, joint), 16.0F);
        label.color = is_due ? p.palette.due : scene::label_color;
        label.moved_px = {0.0F, 8.0F};
        p.scene.labels.push_back(label);
    };
    const bool guided = course.lesson().mode == lesson::Mode::guided;
    const std::size_t marked = due != nullptr && guided ? due->joint : SIZE_MAX;
    for (std::size_t i = 0; i < setup.nuts.size(); ++i) {
        if (p.view.clamp_map || p.pace.finished)
            p.scene.labels.push_back(clamp_of(p, frame.words, i));
        else if (i == marked || p.pointing.nut == i)
            named(i, i == marked);
    }
    if (frame.fonts == nullptr) return;
    const Screen screen = screen_of(p, frame.size);
    std::vector<render::Rectangle> taken = p.view.occupied;
    if (!p.view.clamp_map && !p.pace.finished) keep_off_nuts(p, screen, taken);
    view::move_apart(*frame.fonts, p.scene.labels, screen.eye, glm::vec2(frame.size), taken);
}

void present_system(scene::World& world, Frame& frame) { scene::present(world, frame.playing.scene); }

}  // namespace bolt::trainer
