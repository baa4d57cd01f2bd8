#include "game/trainer/systems.hpp"

#include "game/scene/labels.hpp"
#include "game/trainer/aids.hpp"
#include "game/view/palette.hpp"

namespace bolt::trainer {

namespace {

constexpr glm::vec4 under_color{0.9F, 0.95F, 1.0F, 0.8F}, nothing{0.0F};

// What hints are made of.
hints::Scene hint_scene(const Playing& p) {
    const play::Course& course = *p.course;
    hints::Scene scene{course.lesson(), course.setup(), course.state().joints, p.output,
                       course.state().rounded};
    scene.wrench_in_hand = p.hand.wrench;
    if (p.hand.doing == Doing::holding) scene.room = p.hand.room;

    return scene;
}

}  // namespace

void lesson_system(scene::World& world, Frame& frame) {
    Playing& p = frame.playing;
    const lesson::Lesson& lesson = p.course->lesson();
    wait(p.back, frame.seconds);
    if (frame.wanted.wants(Action::quiet)) p.quiet = !p.quiet;
    if (p.sound) p.sound->set_volume(p.quiet || p.paused ? 0.0 : p.volume);
    if (p.captions && !p.paused) update(*p.captions, frame.seconds);
    if (!p.paused) {
        // Work that ended the step on the way out is about to be undone: there is no next one to speak of.
        if (due(p.back, lesson) == lesson.due())
            hints::update(p.hints, hint_scene(p), frame.seconds, frame.wanted.wants(Action::hint));
        else
            p.hints.shown.reset();
        hints::update(p.mistakes, p.back.by_mistake ? 0.0 : frame.seconds);
    }
    const hints::Hint* hint = p.hints.shown && !p.finished ? &*p.hints.shown : nullptr;
    const int outlined = hint != nullptr ? hint->outlined() : -1;
    for (std::size_t i = 0; i < lesson.joints.size(); ++i) {
        glm::vec4 color = nothing;
        if (outlined == static_cast<int>(i)) color = p.palette.due;
        if (p.under == i && !p.finished) color = under_color;
        if (p.finished) color = view::color_of(p.palette, p.verdicts[i]);
        scene::outline_joint(world, i, color);
    }
    const bool wants_wrench = hint != nullptr && hint->arrow() == hints::Motion::take;
    scene::outline_tool(world, p.over_wrench ? under_color : wants_wrench ? p.palette.due : nothing);
    show_aids(world, p, hint);
}

}  // namespace bolt::trainer
