#include "game/trainer/systems.hpp"

#include "game/operators/mind.hpp"
#include "game/scene/find_view.hpp"

namespace bolt::trainer {

namespace {

constexpr double lost_below = 0.15, lost_after = 3.0;  // of nut and jaw; s

// The joint that is worked at, or is due; which one is due an assessment does not tell.
std::optional<std::size_t> at_work(const Playing& p) {
    if (p.course->lesson().mode == lesson::Mode::assessment) return p.hand.nut;
    if (p.hand.nut && p.hand.doing != Doing::resting) return p.hand.nut;
    const lesson::Step* due = trainer::due(p.back, p.course->lesson());
    return due != nullptr ? std::optional(due->joint) : std::nullopt;
}

scene::ViewOf view_of(const Playing& p, std::size_t joint) {
    const servo::Setup& setup = p.course->setup();
    const servo::State& state = p.course->state();
    scene::ViewOf of{setup, state.touch ? &*state.touch : nullptr, joint,
                     servo::nut_centre(setup.nuts[joint], state.joints[joint].nut.angle), std::nullopt};
    if (p.hand.wrench && p.hand.nut == joint) of.wrench = p.output.tool;
    return of;
}

// Where the hand is at the nut, or will be.
Vec3 wrist_at(const Playing& p, std::size_t joint) {
    const servo::Setup& setup = p.course->setup();
    const servo::State& state = p.course->state();
    const bool there = p.hand.nut == joint && p.hand.doing != Doing::resting;
    if (p.hand.wrench) {
        const bool loosens = p.course->lesson().task == lesson::Task::loosen;
        const Pose tool = there ? p.output.tool : wrench_on(p.hand.rest, setup, state, joint, loosens);
        const std::size_t grip = scene::natural_grip(p.postures, tool, Vec3(0, 1, 0), p.shoulder);
        return tool * p.postures.on_handle.at(grip).position[hand::wrist];
    }
    const servo::NutPlace& nut = setup.nuts[joint];
    const Pose at{servo::nut_centre(nut, state.joints[joint].nut.angle),
                  operators::orientation_of(nut, 0.0, false)};
    return scene::towards(at, p.shoulder, 0.0) * p.postures.on_nut.position[hand::wrist];
}

void look_at_work(Playing& p, const glm::dvec2& picture) {
    const auto joint = at_work(p);
    if (!joint) return;
    scene::ViewOf of = view_of(p, *joint);
    of.wrist = wrist_at(p, *joint);
    of.aspect = picture.x / picture.y;
    p.camera.go(scene::find_view(of, p.sight, p.camera.goal));
    p.unseen = 0.0;
}

// What is due has been out of the picture or hidden for a while. Not in an assessment: nobody helps there.
bool lost(Playing& p, const Frame& frame) {
    const auto joint = at_work(p);
    if (!joint || p.course->lesson().mode == lesson::Mode::assessment || p.finished || p.paused) return false;
    const scene::ViewOf of = view_of(p, *joint);
    const Screen screen = screen_of(p, frame.size);
    const auto at = project(screen, of.nut);
    const glm::dvec2 edge = 0.04 * frame.size;
    const bool inside = at && at->x > edge.x && at->y > edge.y && at->x < frame.size.x - edge.x &&
                        at->y < frame.size.y - edge.y;
    const bool seen = inside && scene::seen_from(of, p.sight, Vec3(screen.eye.position)) > lost_below;
    p.unseen = seen ? 0.0 : p.unseen + frame.seconds;
    return p.unseen > lost_after;
}

}  // namespace

Screen screen_of(const Playing& p, const glm::dvec2& size) {
    return {view::eye_of(p.camera.shown, render::bounds(p.scene), static_cast<float>(size.x / size.y)), size};
}

void view_system(scene::World& world, Frame& frame) {
    Playing& p = frame.playing;
    if (frame.wanted.wants(Action::whole_view))
        p.camera.go(
            view::framing(p.camera.goal, p.place.machine, static_cast<float>(frame.size.x / frame.size.y)));
    if (frame.wanted.wants(Action::find_view) || lost(p, frame)) look_at_work(p, frame.size);
    (void)p.camera.advance(frame.seconds);
    scene::thin_near_arms(world, Vec3(view::viewpoint_of(p.camera.shown).eye));

    const bool helps = p.course->lesson().mode != lesson::Mode::assessment;
    if (frame.wanted.wants(Action::close_up)) p.close_up.wished = !p.close_up.wished;
    update_close_up(p);
    p.scene.cut_away.strength = 0.0F;
    if (!helps) return;
    const bool works = p.hand.nut && p.hand.doing != Doing::resting;
    // A hand that waits above the last nut fills the picture of the next one.
    if (const auto joint = works ? p.hand.nut : at_work(p))
        scene::keep_in_sight(world, p.scene, p.course->setup(), p.course->state(), *joint,
                             works ? scene::Hides::all : scene::Hides::hand);
}

}  // namespace bolt::trainer
