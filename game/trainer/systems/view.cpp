#include "game/trainer/systems.hpp"

#include "game/motion/path_planning.hpp"
#include "game/view/view_search.hpp"

namespace bolt::trainer {

namespace {

constexpr double lost_below = 0.15, lost_after = 3.0;  // of nut and jaw; s

// The joint that is worked at, or is due; which one is due an assessment does not tell.
std::optional<std::size_t> at_work(const ActiveLesson& p) {
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
    const auto joint = at_work(p);
    if (!joint) return;
    view::ViewOf of = view_of(p, *joint);
    of.wrist = wrist_at(p, *joint);
    of.aspect = picture.x / picture.y;
    p.view.camera.go(view::find_view(of, p.view.sight, p.view.camera.goal));
    p.view.unseen = 0.0;
}

// What is due has been out of the picture or hidden for a while. Not in an assessment: nobody helps there.
bool lost(ActiveLesson& p, const Frame& frame) {
    const auto joint = at_work(p);
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
    if (const auto joint = works ? hand_of(p).nut : at_work(p))
        scene::keep_in_sight(world, p.scene, p.course->setup(), *joint,
                             works ? scene::Hides::all : scene::Hides::hand);
}

}  // namespace bolt::trainer
