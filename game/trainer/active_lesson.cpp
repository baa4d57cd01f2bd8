#include "game/trainer/active_lesson.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace bolt::trainer {

namespace {

constexpr double twist_shown = 0.3;    // of the fingers' twist, at the wrist
constexpr double longest_step = 0.25;  // s of lesson that one frame catches up with

void say(ActiveLesson& p, std::span<const lesson::Event> events) {
    for (const lesson::Event& event : events) {
        // What begins again because of a mistake is still told why.
        const bool by_mistake = event.kind == "back" && p.undo.by_mistake;
        if (!by_mistake) lesson::note(p.coaching.mistakes, p.course->lesson(), event);
        note(p.undo, p.course->lesson(), event);
        p.events.push_back(event);
    }
}

// After each tick: the components first, then whatever follows the work tick by tick.
void write_tick(scene::World& world, ActiveLesson& p, const servo::Input& input,
                const servo::Output& output) {
    const session::Course& course = *p.course;
    world::write_snapshot(world, {course.state(), input, output});
    if (input.grip == servo::Grip::wrench) note(p.plot, course.lesson(), world);
    scene::strain(p.strain, course.setup(), world);
    say(p, course.events());
    const sound::Cues cues = sound::cues_of(course.events());
    if (p.sound.live) p.sound.live->tick(world, cues);
    if (p.sound.captions)
        note(*p.sound.captions, sound::hear(p.sound.ear, course.setup(), world, cues), course.setup().dt);
}

bool goes_on(const ActiveLesson& p) { return goes_on(p.undo, *p.course); }

// The hand between two ticks, as mouse or station move it: further on than the input of the last tick.
Hand write_hand(scene::World& world, const Hand& hand) {
    Hand& now = world.only<world::Hand>() = hand;
    now.pinches = !hand.wrench && hand.nut && hand.doing == Doing::holding;
    return now;
}

void write_glove(scene::World& world, const StationClient& at) {
    const ecs::Entity hand = world.pool<world::Hand>().entities().front();
    if (at.gloved)
        world.add<world::GloveHand>(hand, at.fingers, at.glove_lost);
    else
        world.remove<world::GloveHand>(hand);
}

void step_ticks(scene::World& world, Frame& frame) {
    ActiveLesson& p = frame.playing;
    session::Course& course = *p.course;
    if (!p.pace.paused && !p.pace.finished) p.pace.owed += frame.seconds;
    if (!p.pace.paused && !p.pace.finished)
        p.pace.lagged += frame.late + std::max(0.0, p.pace.owed - longest_step);
    p.pace.owed = std::min(p.pace.owed, longest_step);
    const servo::Setup& setup = course.setup();
    for (; p.pace.owed >= setup.dt && goes_on(p) && frame.status; p.pace.owed -= setup.dt) {
        servo::Input input = move(p.mouse, setup, course.state());
        if (const lesson::Step* due = course.lesson().due(); due != nullptr && course.lesson().guides)
            input.guide = static_cast<std::int16_t>(due->joint);
        const auto back = steps_back(p.undo, course.lesson());
        if (back && p.mouse.doing == Doing::resting && !p.mouse.nut) course.go_back(*back);
        const Result<servo::Output> output = course.step(input);
        if (!output) {
            frame.status = fail(output.error());
            break;
        }
        write_tick(world, p, input, *output);
    }
    const Hand hand = write_hand(world, hand_of(p.mouse));
    if (hand.doing == Doing::reaching)
        p.grip = scene::natural_grip(p.postures, hand.to, Vec3(0, 1, 0), p.shoulder);
}

// What the station has done since the last picture, done again beside it.
void follow_station(scene::World& world, Frame& frame) {
    ActiveLesson& p = frame.playing;
    StationClient& at = *p.station;
    const bool had = hand_of(p).wrench;
    for (station::TickRecord tick; goes_on(p) && frame.status && at.bench->next_tick(tick);) {
        frame.status = p.course->take(tick.input, tick.output);
        if (tick.output.joint >= 0 && contact_of(p).joint < 0) at.taken_at = tick.output.nut_angle;
        if (frame.status) write_tick(world, p, tick.input, tick.output);
    }
    if (at.bench->lost_ticks() > 0 && goes_on(p) && frame.status)
        frame.status = fail(ErrorCode::failed,
                            fmt::format("pictures took so long that {} ticks of the servo could not be kept",
                                        at.bench->lost_ticks()),
                            "the session until then is whole");
    const Status sent =
        wish(at, *p.course,
             {p.pace.paused || p.pace.finished || !goes_on(p), frame.wanted.wants(Action::tool),
              frame.wanted.wants(Action::recentre), steps_back(p.undo, p.course->lesson()),
              glm::angleAxis(p.view.camera.shown.yaw, Vec3(0, 1, 0))});
    if (frame.status && !sent) frame.status = sent;
    const Hand hand = write_hand(world, hand_of(at));
    if (hand.wrench && !had)
        p.grip = scene::natural_grip(p.postures, tool_of(p).pose, Vec3(0, 1, 0), p.shoulder);
    write_glove(world, at);
}

scene::Held held_of(const scene::World& world, const ActiveLesson& p, double seconds) {
    const world::Hand& hand = world.only<world::Hand>();
    const world::GloveHand* glove =
        world.find<world::GloveHand>(world.pool<world::Hand>().entities().front());
    return {hand.wrench ? world.only<world::Tool>().pose : hand.pose,
            hand.wrench,
            hand.rest,
            hand.pinches,
            glove != nullptr ? hand.rest : scene::towards(hand.pose, p.shoulder, -twist_shown * hand.twisted),
            p.grip,
            seconds,
            p.strain.share,
            p.strain.tremor,
            glove != nullptr ? &glove->fingers : nullptr,
            p.course->state().tool_contact ? &p.course->state().tool_contact->world : nullptr};
}

}  // namespace

void haptic_system(scene::World& world, Frame& frame) {
    ActiveLesson& p = frame.playing;
    if (p.station)
        follow_station(world, frame);
    else
        step_ticks(world, frame);
    p.pace.finished = p.pace.finished || !goes_on(p);
}

void placement_system(scene::World& world, Frame& frame) {
    ActiveLesson& p = frame.playing;
    const scene::Held held = held_of(world, p, frame.seconds);
    scene::place_nuts(world, p.course->setup());
    scene::place_tool(world, held);
    scene::place_hand(world, p.postures, held);
}

}  // namespace bolt::trainer
