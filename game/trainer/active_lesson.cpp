#include "game/trainer/active_lesson.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace bolt::trainer {

namespace {

constexpr double max_catch_up = 0.25;  // s of lesson time that one frame can catch up

void log_events(ActiveLesson& active, std::span<const lesson::LessonEvent> events) {
    for (const lesson::LessonEvent& event : events) {
        // Keep the explanation of the mistake when its step restarts.
        const bool undone_by_mistake = event.kind == lesson::EventKind::undo && active.undo.by_mistake;
        if (!undone_by_mistake) lesson::add_event(active.coaching.mistakes, active.session->lesson(), event);
        observe(active.undo, active.session->lesson(), event);
        active.events.push_back(event);
    }
}

// After each tick: updates plot, effort, log and sound from the components.
void after_tick(const scene::SceneWorld& world, ActiveLesson& active) {
    const session::LessonSession& session = *active.session;
    if (world.only<world::WorkingHand>().wrench) observe(active.plot, session.lesson(), world);
    scene::update_effort(active.effort, session.setup(), world);
    log_events(active, session.events());
    const sound::LessonCues cues = sound::lesson_cues(session.events());
    if (active.sound.live) active.sound.live->add_tick(world, cues);
    if (active.sound.captions)
        observe(*active.sound.captions,
                sound::detect_events(active.sound.detector, session.setup(), world, cues),
                session.setup().dt);
}

bool continues(const ActiveLesson& active) { return continues(active.undo, *active.session); }

// Writes the hand as mouse or station have moved it, which is newer than the input of the last tick.
WorkingHand write_hand(scene::SceneWorld& world, const WorkingHand& hand) {
    WorkingHand& written = world.only<world::WorkingHand>() = hand;
    written.pinches = !hand.wrench && hand.nut && hand.action == HandAction::holding;
    return written;
}

void write_glove(scene::SceneWorld& world, const StationClient& client) {
    const ecs::Entity hand = world.pool<world::WorkingHand>().entities().front();
    if (client.gloved)
        world.add<world::GloveHand>(hand, client.fingers, client.glove_lost);
    else
        world.remove<world::GloveHand>(hand);
}

void step_ticks(scene::SceneWorld& world, Frame& frame) {
    ActiveLesson& active = frame.active;
    session::LessonSession& session = *active.session;
    if (!active.clock.paused && !active.clock.finished) active.clock.pending += frame.seconds;
    if (!active.clock.paused && !active.clock.finished)
        active.clock.lag += frame.overrun + std::max(0.0, active.clock.pending - max_catch_up);
    active.clock.pending = std::min(active.clock.pending, max_catch_up);
    const servo::Setup& setup = session.setup();
    for (; active.clock.pending >= setup.dt && continues(active) && frame.status;
         active.clock.pending -= setup.dt) {
        servo::Input input = step_hand(active.mouse, setup, session.state());
        if (const lesson::LessonStep* due = session.lesson().due(); due != nullptr && session.lesson().guides)
            input.guide = static_cast<std::int16_t>(due->joint);
        const auto undo = steps_to_undo(active.undo, session.lesson());
        if (undo && active.mouse.action == HandAction::resting && !active.mouse.nut)
            session.request_undo(*undo);
        const Result<servo::Output> output = session.step(world, input);
        if (!output) {
            frame.status = fail(output.error());
            break;
        }
        after_tick(world, active);
    }
    const WorkingHand hand = write_hand(world, hand_of(active.mouse));
    if (hand.action == HandAction::reaching)
        active.handle_grip = scene::natural_grip(active.postures, hand.to, Vec3(0, 1, 0), active.shoulder);
}

// Repeats the station's ticks since the last frame with the lesson's own servo.
void repeat_station_ticks(scene::SceneWorld& world, Frame& frame) {
    ActiveLesson& active = frame.active;
    StationClient& client = *active.station;
    const bool had_wrench = hand_of(active).wrench;
    for (station::StationTick tick; continues(active) && frame.status && client.link->next_tick(tick);) {
        const bool free = contact_of(active).joint < 0;
        frame.status = active.session->repeat(world, tick.input, tick.output);
        if (tick.output.joint >= 0 && free) client.nut_angle_at_grip = tick.output.nut_angle;
        if (frame.status) after_tick(world, active);
    }
    if (client.link->lost_ticks() > 0 && continues(active) && frame.status)
        frame.status =
            fail(ErrorCode::failed, fmt::format("{} ticks of the servo were dropped because frames took too "
                                                "long; the session up to there is complete",
                                                client.link->lost_ticks()));
    const Status sent =
        send_intent(client, *active.session,
                    {active.clock.paused || active.clock.finished || !continues(active),
                     frame.input.triggered(Action::tool), frame.input.triggered(Action::recentre),
                     steps_to_undo(active.undo, active.session->lesson()),
                     glm::angleAxis(active.view.camera.shown.yaw, Vec3(0, 1, 0))});
    if (frame.status && !sent) frame.status = sent;
    const WorkingHand hand = write_hand(world, hand_of(client));
    if (hand.wrench && !had_wrench)
        active.handle_grip =
            scene::natural_grip(active.postures, tool_of(active).pose, Vec3(0, 1, 0), active.shoulder);
    write_glove(world, client);
}

}  // namespace

void tick_system(scene::SceneWorld& world, Frame& frame) {
    ActiveLesson& active = frame.active;
    if (active.station)
        repeat_station_ticks(world, frame);
    else
        step_ticks(world, frame);
    active.clock.finished = active.clock.finished || !continues(active);
}

void placement_system(scene::SceneWorld& world, Frame& frame) {
    const ActiveLesson& active = frame.active;
    const servo::State& state = active.session->state();
    scene::placement_system(
        world,
        {active.session->setup(), active.postures, active.shoulder, active.handle_grip, active.effort.share,
         active.effort.tremor, frame.seconds, state.tool_contact ? &state.tool_contact->world : nullptr});
}

}  // namespace bolt::trainer
