#include "game/trainer/systems.hpp"

#include "game/scene/labels.hpp"
#include "game/trainer/hint_visuals.hpp"
#include "game/view/palette.hpp"

namespace bolt::trainer {

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
