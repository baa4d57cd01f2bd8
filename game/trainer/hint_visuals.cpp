#include "game/trainer/hint_visuals.hpp"

#include "game/motion/path_planning.hpp"
#include "game/scene/annotations.hpp"
#include "game/trainer/active_lesson.hpp"
#include "game/view/labels.hpp"

namespace bolt::trainer {

namespace {

using lesson::Motion;
using scene::Arrow;

// Of the nut's width, above what a straight arrow points to.
constexpr double nearest = 1.6, furthest = 4.4;
constexpr double by_handle = 0.45, by_fingers = 1.15;  // radius: of the handle, of the nut's width
constexpr double forearm = 0.25, too_near = 0.25;      // m: what is shown of it; from the eye
constexpr double above_handle = 0.03, above_nut = 0.02, lifted = 0.06;  // m

Arrow down_to(const Vec3& at, const Vec3& up, double width, const glm::vec4& color) {
    return scene::straight_arrow(at + furthest * width * up, at + nearest * width * up, color);
}

Arrow up_from(const Vec3& at, const Vec3& up, double width) {
    return scene::straight_arrow(at + nearest * width * up, at + furthest * width * up, back_color);
}

// `sense`: 1 tightens.
Arrow with_handle(const MotionPlace& place, double sense, double height, const glm::vec4& color) {
    const Vec3 axis = -sense * place.nut.axis;
    return scene::round_arrow({place.middle + height * place.nut.axis, axis,
                               place.tool.orientation * Vec3(1, 0, 0), by_handle * place.handle_length},
                              color);
}

Arrow with_fingers(const MotionPlace& place, double sense, const glm::vec4& color) {
    return scene::round_arrow({place.middle + above_nut * place.nut.axis, -sense * place.nut.axis,
                               place.nut.e1, by_fingers * place.nut.across_flats},
                              color);
}

// Hands are where the work is to be done: fingers on the nut, or around the wrench that lies there.
void show_hand(scene::World& world, ActiveLesson& p, Motion motion) {
    const servo::Setup& setup = p.course->setup();
    const lesson::Step* due = p.course->lesson().due();
    if (motion == Motion::take) {
        const std::size_t grip = scene::natural_grip(p.postures, hand_of(p).rest, Vec3(0, 1, 0), p.shoulder);
        scene::show_hand_ghost(world, hand_of(p).rest, p.postures.on_handle.at(grip));
        return;
    }
    const servo::NutGeometry& nut = setup.nuts[due->joint];
    const Pose at{world::nut_centre(p.place.world, setup, due->joint),
                  motion::orientation_of(nut, 0.0, false)};
    scene::show_hand_ghost(world, scene::towards(at, p.shoulder, 0.0),
                           motion == Motion::let_go ? p.postures.open : p.postures.on_nut);
}

// Where the hand would put the wrench; looked for once a step, for it takes rays.
const Pose& wrench_for(ActiveLesson& p, const lesson::Step& due) {
    const std::size_t step = p.course->lesson().current;
    if (!p.coaching.ghost || p.coaching.ghost->first != step)
        p.coaching.ghost = {step, wrench_on(hand_of(p).rest, p.course->setup(), p.course->state(), due.joint,
                                            due.kind == lesson::StepKind::loosen)};
    return p.coaching.ghost->second;
}

void show_ghosts(scene::World& world, ActiveLesson& p, const lesson::Hint& hint, const lesson::Step& due) {
    if (hint.ghost() == lesson::Ghost::none) return;
    if (hint.ghost() == lesson::Ghost::hand) {
        show_hand(world, p, hint.motion);
        return;
    }
    const Pose& tool = wrench_for(p, due);
    const std::size_t grip = scene::natural_grip(p.postures, tool, Vec3(0, 1, 0), p.shoulder);
    scene::show_ghost(world, tool);
    scene::show_hand_ghost(world, tool, p.postures.on_handle.at(grip));
}

MotionPlace place_of(const ActiveLesson& p, const lesson::Step& due, std::size_t joint) {
    const servo::Setup& setup = p.course->setup();
    const servo::NutGeometry& nut = setup.nuts[joint];
    return {nut,
            world::nut_centre(p.place.world, setup, joint),
            tool_of(p).pose,
            hand_of(p).rest,
            setup.wrench.handle_length,
            due.kind == lesson::StepKind::loosen};
}

}  // namespace

std::optional<Arrow> arrow_of(Motion motion, const MotionPlace& place) {
    const Vec3& axis = place.nut.axis;
    const Vec3 grip = place.rest * Vec3(0.5 * place.handle_length, 0.0, 0.0);
    const double sense = place.loosens ? -1.0 : 1.0, width = place.nut.across_flats;
    switch (motion) {
        case Motion::none:
            return std::nullopt;
        case Motion::take:
            return down_to(grip, place.rest.orientation * Vec3(0, 0, 1), width, forth_color);
        case Motion::put_away:
            return down_to(grip, place.rest.orientation * Vec3(0, 0, 1), width, back_color);
        case Motion::approach:
        case Motion::reach:
        case Motion::set_on:
        case Motion::grip_nut:
            return down_to(place.middle, axis, width, forth_color);
        case Motion::spin:
            return with_fingers(place, 1.0, forth_color);
        case Motion::twist_back:
            return with_fingers(place, -1.0, back_color);
        case Motion::pull_on:
            return with_handle(place, 1.0, above_handle, forth_color);
        case Motion::pull_off:
            return with_handle(place, -1.0, above_handle, forth_color);
        case Motion::set_back:
            return with_handle(place, -sense, lifted, back_color);
        case Motion::let_go:
        case Motion::lift:
            return up_from(place.middle, axis, width);
    }
    return std::nullopt;
}

void show_hint_visuals(scene::World& world, ActiveLesson& p, const lesson::Hint* hint) {
    scene::hide_ghosts(world);
    const lesson::Step* due = p.course->lesson().due();
    if (hint == nullptr || due == nullptr) {
        p.coaching.ghost.reset();
        scene::show_arrow(world, std::nullopt);
        return;
    }
    // What is held is let go of where it is, though something else is due.
    const int held = p.course->lesson().held;
    const std::size_t joint = held >= 0 ? static_cast<std::size_t>(held) : due->joint;
    scene::show_arrow(world, arrow_of(hint->arrow(), place_of(p, *due, joint)));
    show_ghosts(world, p, *hint, *due);
}

namespace {

constexpr glm::vec4 under_color{0.9F, 0.95F, 1.0F, 0.8F}, nothing{0.0F};

}  // namespace

void lesson_system(scene::World& world, Frame& frame) {
    ActiveLesson& p = frame.playing;
    const lesson::Lesson& lesson = p.course->lesson();
    wait(p.undo, frame.seconds);
    if (frame.wanted.wants(Action::quiet)) p.sound.quiet = !p.sound.quiet;
    if (p.sound.live) p.sound.live->set_volume(p.sound.quiet || p.pace.paused ? 0.0 : p.sound.volume);
    if (p.sound.captions && !p.pace.paused) update(*p.sound.captions, frame.seconds);
    if (!p.pace.paused) {
        // Work that ended the step on the way out is about to be undone: there is no next one to speak of.
        if (due(p.undo, lesson) == lesson.due())
            lesson::update(p.coaching.hints, {lesson, p.course->setup(), world}, frame.seconds,
                           frame.wanted.wants(Action::hint));
        else
            p.coaching.hints.shown.reset();
        lesson::update(p.coaching.mistakes, p.undo.by_mistake ? 0.0 : frame.seconds);
    }
    const lesson::Hint* hint =
        p.coaching.hints.shown && !p.pace.finished ? &*p.coaching.hints.shown : nullptr;
    const int outlined = hint != nullptr ? hint->outlined() : -1;
    for (std::size_t i = 0; i < lesson.joints.size(); ++i) {
        glm::vec4 color = nothing;
        if (outlined == static_cast<int>(i)) color = p.palette.due;
        if (p.pointing.nut == i && !p.pace.finished) color = under_color;
        if (p.pace.finished) color = view::color_of(p.palette, p.verdicts[i]);
        scene::outline_joint(world, i, color);
    }
    const bool wants_wrench = hint != nullptr && hint->arrow() == lesson::Motion::take;
    scene::outline_tool(world, p.pointing.wrench ? under_color : wants_wrench ? p.palette.due : nothing);
    show_hint_visuals(world, p, hint);
}

}  // namespace bolt::trainer
