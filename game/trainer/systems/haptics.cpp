#include "game/trainer/systems.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace bolt::trainer {

namespace {

constexpr double twist_shown = 0.3;    // of the fingers' twist, at the wrist
constexpr double longest_step = 0.25;  // s of lesson that one frame catches up with

void say(Playing& p, std::span<const lesson::Event> events) {
    for (const lesson::Event& event : events) {
        // What begins again because of a mistake is still told why.
        const bool by_mistake = event.kind == "back" && p.back.by_mistake;
        if (!by_mistake) hints::note(p.mistakes, p.course->lesson(), event);
        note(p.back, p.course->lesson(), event);
        p.said.push_back(event);
    }
}

void note(Playing& p, servo::Grip grip, const servo::Output& output) {
    const bool wrench = grip == servo::Grip::wrench;
    p.output = output;
    if (wrench) note(p.plot, p.course->lesson(), output);
    scene::strain(p.strain, output, p.course->setup(), wrench);

    say(p, p.course->events());
    if (p.sound) p.sound->tick(output, sound::cues_of(p.course->events()));
    if (p.captions)
        note(*p.captions, sound::hear(p.ear, p.course->setup(), output, sound::cues_of(p.course->events())),
             p.course->setup().dt);
}

bool goes_on(const Playing& p) { return goes_on(p.back, *p.course); }

void step_ticks(Frame& frame) {
    Playing& p = frame.playing;
    play::Course& course = *p.course;
    if (!p.paused && !p.finished) p.owed += frame.seconds;
    if (!p.paused && !p.finished) p.lagged += frame.late + std::max(0.0, p.owed - longest_step);
    p.owed = std::min(p.owed, longest_step);
    const servo::Setup& setup = course.setup();
    for (; p.owed >= setup.dt && goes_on(p) && frame.status; p.owed -= setup.dt) {
        servo::Input input = move(p.mouse, setup, course.state());
        if (const lesson::Step* due = course.lesson().due(); due != nullptr && course.lesson().guides)
            input.guide = static_cast<std::int16_t>(due->joint);
        const auto back = steps_back(p.back, course.lesson());
        if (back && p.mouse.doing == Doing::resting && !p.mouse.nut) course.go_back(*back);
        const Result<servo::Output> output = course.step(input);
        if (!output) {
            frame.status = fail(output.error());
            break;
        }
        note(p, input.grip, *output);
    }
    p.hand = hand_of(p.mouse);
    if (p.hand.doing == Doing::reaching)
        p.grip = scene::natural_grip(p.postures, p.hand.to, Vec3(0, 1, 0), p.shoulder);
}

// What the station has done since the last picture, done again beside it.
void follow_station(Frame& frame) {
    Playing& p = frame.playing;
    AtStation& at = *p.station;
    for (station::Ticked tick; goes_on(p) && frame.status && at.bench->next(tick);) {
        frame.status = p.course->take(tick.input, tick.output);
        if (tick.output.joint >= 0 && p.output.joint < 0) at.taken_at = tick.output.nut_angle;
        if (frame.status) note(p, tick.input.grip, tick.output);
    }
    if (at.bench->lost() > 0 && goes_on(p) && frame.status)
        frame.status = fail(ErrorCode::failed,
                            fmt::format("pictures took so long that {} ticks of the servo could not be kept",
                                        at.bench->lost()),
                            "the session until then is whole");
    wish(at, *p.course,
         {p.paused || p.finished || !goes_on(p), frame.wanted.wants(Action::tool),
          frame.wanted.wants(Action::recentre), steps_back(p.back, p.course->lesson()),
          glm::angleAxis(p.camera.shown.yaw, Vec3(0, 1, 0))});
    const bool had = p.hand.wrench;
    p.hand = hand_of(at);

    if (p.hand.wrench && !had)
        p.grip = scene::natural_grip(p.postures, p.output.tool, Vec3(0, 1, 0), p.shoulder);
}

scene::Held held_of(const Playing& p, double seconds) {
    const bool pinches = !p.hand.wrench && p.hand.nut && p.hand.doing == Doing::holding;
    const bool gloved = p.station && p.station->gloved;
    return {p.hand.wrench ? p.output.tool : p.hand.pose,
            p.hand.wrench,
            p.hand.rest,
            pinches,
            gloved ? p.hand.rest : scene::towards(p.hand.pose, p.shoulder, -twist_shown * p.hand.twisted),
            p.grip,
            seconds,
            p.strain.share,
            p.strain.tremor,
            gloved ? &p.station->fingers : nullptr};
}

}  // namespace

void haptic_system(scene::World& world, Frame& frame) {
    Playing& p = frame.playing;
    if (p.station)
        follow_station(frame);
    else
        step_ticks(frame);
    p.finished = p.finished || !goes_on(p);
    const scene::Held held = held_of(p, frame.seconds);
    scene::place_nuts(world, p.course->setup(), p.course->state().joints);
    scene::place_tool(world, held);
    scene::place_hand(world, p.postures, held);
}

}  // namespace bolt::trainer
