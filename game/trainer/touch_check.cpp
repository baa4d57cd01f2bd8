#include "game/trainer/touch_check.hpp"

#include <imgui/imgui.h>

#include <utility>

#include "game/scene/annotations.hpp"
#include "game/station/frame_registration.hpp"
#include "game/station/point_source.hpp"
#include "game/trainer/arm_screen.hpp"

namespace bolt::trainer {

namespace {

using station_setup::max_check_error;

constexpr double marker_length = 0.06;  // m, of its arrows
constexpr glm::vec4 marker_color{1.0F, 0.75F, 0.2F, 1.0F};
constexpr float marker_outline = 0.8F;       // opacity
constexpr double marker_above_plate = 0.02;  // m, if no workpiece is registered
constexpr double tip_length = 0.09;          // m, of the arrow
constexpr glm::vec4 tip_color{0.3F, 0.7F, 1.0F, 1.0F};
constexpr float touch_label_height = 0.014F;  // m
constexpr double touch_label_gap = 0.02;      // m, from the arrow

void show_phase(TouchCheck& check, TouchPhase phase) {
    check.phase = phase;
    check.shown_for = 0.0;
}

// Collects positions for the duration of a touch, and for longer if slow frames give too few of them.
void measure(TouchCheck& check, const std::optional<station::MoverSample>& mover) {
    const station_setup::TouchOptions options;
    if (mover) check.touched.push_back(check.arm_in_room * (mover->pose * check.tip));
    if (mover && (check.shown_for < options.duration || check.touched.size() < options.min_samples)) return;
    const Result<Vec3> mean = station_setup::average_touch(check.touched, options);
    check.failed_touch = !mover || !mean;
    if (check.failed_touch) return show_phase(check, TouchPhase::waiting);
    check.error = glm::length(*mean - check.marker);
    show_phase(check, check.error <= max_check_error ? TouchPhase::passed : TouchPhase::failed);
}

words::Number millimetres(double length) { return {length / mm, 1}; }

}  // namespace

std::optional<TouchCheck> touch_check_of(const content::Registration& registration) {
    const auto found = station_setup::registration_from(
        std::span(&registration, 1), content::CoordinateFrame::arm, content::CoordinateFrame::room);
    if (!found || !found->check_point) return std::nullopt;
    TouchCheck check;
    check.marker = found->check_point->to;
    check.arm_in_room = found->pose;
    check.tip = found->tip;
    return check;
}

bool update(TouchCheck& check, const std::optional<station::MoverSample>& mover, bool confirmed,
            double seconds) {
    check.shown_for += seconds;
    const std::uint32_t buttons = mover ? mover->buttons : ~0U;
    const bool pressed = (buttons & ~std::exchange(check.held_buttons, buttons)) != 0 && mover;
    if (check.phase == TouchPhase::measuring) {
        measure(check, mover);
        return false;
    }
    if (!pressed && !confirmed) return false;
    if (check.phase != TouchPhase::waiting) return true;
    if (!mover) return false;
    check.touched.clear();
    check.failed_touch = false;
    show_phase(check, TouchPhase::measuring);
    return false;
}

TouchAnswer answer_of(const TouchCheck& check, std::span<const platform::InputEvent> events,
                      bool enter_key_answers) {
    TouchAnswer answer;
    for (const platform::InputEvent& event : events) {
        const bool answers = enter_key_answers || !std::holds_alternative<platform::KeyEvent>(event);
        answer.confirmed =
            answer.confirmed || (is_confirmation(event) && answers && check.shown_for >= question_time);
        answer.ended = answer.ended || is_back(event);
    }
    return answer;
}

ScreenAction draw_touch_check(const ScreenContext& context, const TouchCheck& check) {
    const words::Words& words = context.words;
    const std::string enter(platform::name(platform::Key::enter));
    const std::string escape(platform::name(platform::Key::escape));
    const bool asks = waits_for_touch(check);
    begin_dialog(context, "##touch", 420.0F * context.scale, 0.94F);
    if (asks) {
        draw_wrapped(words["touch.ask"], muted_text);
        if (check.failed_touch) draw_wrapped(words["touch.moved"], warning_text);
    } else if (check.phase == TouchPhase::passed) {
        draw_wrapped(words::format_text(words, "touch.right", {{"error", millimetres(check.error)}}),
                     muted_text);
    } else {
        draw_wrapped(words::format_text(words, "touch.wrong",
                                        {{"error", millimetres(check.error)},
                                         {"limit", words::Number{max_check_error / mm, 0}}}),
                     warning_text);
    }
    ImGui::Separator();
    draw_wrapped(
        asks ? words::format_text(words, "touch.keys", {{"measure", enter}, {"skip", escape}})
             : words["touch.place"] + "\n" + words::format_text(words, "touch.key", {{"start", enter}}),
        muted_text);
    const bool pressed =
        draw_button(context, asks ? words::TextKey("touch.skip") : words::TextKey("touch.start"));
    ImGui::End();
    return pressed ? ScreenAction::end_touch_check : ScreenAction::none;
}

Pose touch_scene(const TouchCheck& check, const Pose& workpiece, bool registered,
                 const render::BoundingBox& box) {
    if (registered) return workpiece;
    const Vec3 low(box.low), high(box.high);
    const Vec3 below_marker(0.5 * (low.x + high.x), low.y + marker_above_plate, 0.5 * (low.z + high.z));
    return {check.marker - workpiece.orientation * below_marker, workpiece.orientation};
}

namespace {

void add_arrow(render::Scene& scene, const render::GpuModel& arrows, const scene::MotionArrow& arrow,
               const glm::vec4& color) {
    render::Object object;
    object.model = &arrows;
    object.mesh = static_cast<std::uint32_t>(arrow.shape);
    object.world = glm::mat4(arrow.world);
    object.tint = color;
    object.moves = true;
    object.outline = glm::vec4(glm::vec3(color), marker_outline);
    scene.objects.push_back(object);
}

void add_label(render::Scene& scene, const Vec3& at, const std::string& text, const glm::vec4& color) {
    render::Label label;
    label.text = text;
    label.position = glm::vec3(at);
    label.placement = render::LabelPlacement::facing;
    label.height = touch_label_height;
    label.color = color;
    label.plate = {0.08F, 0.09F, 0.1F, 0.85F};
    label.occluded_visibility = 1.0F;
    scene.labels.push_back(std::move(label));
}

}  // namespace

void show_touch_marker(render::Scene& scene, const scene::GpuLessonModels& models, const TouchCheck& check,
                       const TouchView& view) {
    std::erase_if(scene.objects, [&](const render::Object& object) {
        return object.model != &models.workshop &&
               !(view.shows_workpiece && object.model == &models.workpiece);
    });
    scene.labels.clear();
    const Pose room_in_scene = inverse(view.scene_in_room);
    const Vec3 at = room_in_scene * check.marker;
    for (const Vec3& side : {Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 0, -1)})
        add_arrow(
            scene, models.arrows,
            scene::straight_arrow(room_in_scene * (check.marker + marker_length * side), at, marker_color),
            marker_color);
    add_label(scene, room_in_scene * (check.marker + Vec3(0.0, marker_length + touch_label_gap, 0.0)),
              view.words["touch.mark"], marker_color);
    if (!view.handle) return;
    const Pose handle = check.arm_in_room * *view.handle;
    const Vec3 tip = handle * check.tip;
    if (glm::distance(tip, check.marker) < hidden_tip_distance) return;
    // From the handle to the tip; from above if the tip is the handle's own point.
    const double length = glm::length(check.tip);
    const Vec3 back = length > 1e-3 ? handle.orientation * (-check.tip / length) : Vec3(0.0, 1.0, 0.0);
    add_arrow(
        scene, models.arrows,
        scene::straight_arrow(room_in_scene * (tip + tip_length * back), room_in_scene * tip, tip_color),
        tip_color);
    add_label(scene, room_in_scene * (tip + (tip_length + touch_label_gap) * back), view.words["touch.tip"],
              tip_color);
}

}  // namespace bolt::trainer
