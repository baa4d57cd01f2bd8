#include "game/trainer/close_up.hpp"

#include <algorithm>
#include <cmath>

#include "engine/render/camera.hpp"
#include "game/trainer/active_lesson.hpp"
#include "game/trainer/occupied_areas.hpp"
#include "game/view/close_up_eye.hpp"

namespace bolt::trainer {

namespace {

constexpr double appears = 0.07, goes = 0.1;  // m, tool from nut; a hand hovers nearer than the first
constexpr double swing = to_radians(60.0);    // that the eye is good for
constexpr double past = to_radians(70.0), level = 0.9;
constexpr float width = 240.0F, edge = 12.0F;                  // points
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
Pose at_work(const ActiveLesson& p) {
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
    c.tool = at_work(p);
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
    const float side = std::round(edge * scale);
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

}  // namespace bolt::trainer
