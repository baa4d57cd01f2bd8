#include "game/trainees/intent.hpp"

#include <algorithm>

namespace bolt::trainees {

using lesson::StepKind;

const lesson::Step* next_step(const lesson::Lesson& lesson, const Intent& intent) {
    const lesson::Step* due = lesson.due();
    const bool believes = intent.finished && !intent.wrong && intent.step == lesson.current;
    const bool left_alone = lesson.mode == lesson::Mode::assessment && believes;
    if (!left_alone) return due;
    return lesson.current + 1 < lesson.steps.size() ? due + 1 : nullptr;  // after the last one: hand in
}

Intent intend(const Profile& profile, Random& random, const servo::Setup& setup, const lesson::Lesson& lesson,
              const lesson::Step& due, const Intent& before) {
    const bool retry = &due == lesson.due() && before.step == lesson.current;
    const std::size_t joints = setup.nuts.size();
    Intent intent;
    intent.step = static_cast<std::size_t>(&due - lesson.steps.data());
    intent.tries = retry ? before.tries + 1 : 0;
    intent.joint = due.joint;
    const double drag = lesson.assembly->joints[due.joint].design.prevailing_torque;
    intent.until_seated = due.kind == StepKind::run_down;
    intent.fingers = lesson::by_fingers(*lesson.assembly, due, setup.finger_torque(setup.nuts[due.joint]));
    intent.loosening = due.kind == StepKind::loosen;
    intent.checks = due.kind == StepKind::recheck;
    if (!retry && !intent.fingers && joints > 1 && random.chance(profile.wrong_joint)) {
        intent.wrong = true;
        intent.joint = (due.joint + 1 + random.bits() % (joints - 1)) % joints;
    }
    // With a torque wrench nobody needs to feel torques: who means to stop where one should waits for the
    // click.
    intent.until_click = !intent.wrong && lesson::setting(lesson) > 0.0;
    double stop = 1.0 + profile.torque_bias + profile.torque_noise * random.normal();
    if (!retry && random.chance(profile.stops_early)) {
        stop *= 0.75;
        intent.until_click = false;
    }
    if (random.chance(profile.overdoes)) {
        stop *= 1.25;
        intent.until_click = false;
    }
    stop += 0.04 * intent.tries;  // it was not enough: a little more
    intent.goal = (intent.wrong ? 0.3 : 1.0) * due.torque * stop;
    if (intent.until_seated) intent.goal = 1.3 * drag + 2.0;
    // Tightening into yield: who can feel it goes on until it comes, and knows the torques to reach and not
    // to pass.
    const content::Specification& spec = lesson.assembly->joints[intent.joint].spec;
    const bool in_full = due.kind == StepKind::tighten && due.fraction > 0.999;
    intent.stops_at_yield = !intent.wrong && in_full && spec.strategy == content::Strategy::yield &&
                            random.chance(profile.feels_yield);
    intent.least = spec.torque.low;
    if (intent.stops_at_yield)
        intent.goal = spec.torque.high * (std::min(0.98, stop - 0.04 * intent.tries) + 0.04 * intent.tries);
    return intent;
}

}  // namespace bolt::trainees
