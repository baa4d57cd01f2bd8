#include "game/trainer/active_lesson.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>

#include "game/lesson/step_requirements.hpp"
#include "game/scene/angle_dial.hpp"
#include "game/trainer/hint_visuals.hpp"

namespace bolt::trainer {

namespace {

constexpr double full_spin_drag = 120.0;  // px of drag that give the fastest twist
constexpr double wrench_reach = 22.0;     // px from the wrench within which it is picked
// m, in the frame of the head: between the shoulders, which is exact enough for the forearm's direction.
const Vec3 shoulder_at_head(0.0, -0.25, 0.05);

std::vector<Vec3> nut_centres(const scene::SceneWorld& world, const servo::Setup& setup) {
    std::vector<Vec3> centres;
    for (std::size_t i = 0; i < setup.nuts.size(); ++i) centres.push_back(world::nut_centre(world, setup, i));
    return centres;
}

bool loosening(const session::LessonSession& session) {
    return session.lesson().task == lesson::Task::loosen;
}

// Decides whether a press moves the hand or the view.
void press(ActiveLesson& active, MouseCommand& command) {
    active.pointer.drags_hand = active.pointer.nut.has_value() || active.pointer.can_take_wrench;
    if (active.pointer.nut) {
        command.nut = active.pointer.nut;
        command.loosens = loosening(*active.session);
    } else if (active.pointer.can_take_wrench) {
        command.take_wrench = true;
    }
}

// rad, tightening positive, by which a drag turns the handle of a wrench that the hand holds on a nut.
double handle_turn(const ActiveLesson& active, const Projection& projection, const glm::dvec2& drag) {
    if (!hand_of(active).nut || hand_of(active).action != HandAction::holding || !hand_of(active).wrench)
        return 0.0;
    const servo::Setup& setup = active.session->setup();
    const servo::NutGeometry& nut = setup.nuts[*hand_of(active).nut];
    const glm::dvec2 lever =
        lever_on_screen(projection, tool_of(active).pose, nut.axis, setup.wrench.handle_length);
    return nut.sense * drag_angle(lever, drag);
}

// Share of the fastest twist of the fingers, tightening positive; not limited to ±1. A drag to the right
// turns clockwise.
double finger_twist(const ActiveLesson& active, double drag) {
    const auto& nut = hand_of(active).nut;
    const double sense = nut ? active.session->setup().nuts[*nut].sense : 1.0;
    return sense * drag / full_spin_drag;
}

// The rotation about the vertical from the viewer's frame to the assembly's.
Quat viewer_heading(const ActiveLesson& active) {
    if (active.station && active.station->tracked)
        return {1.0, 0.0, 0.0, 0.0};  // its frame is the assembly's
    if (active.view.heading) return *active.view.heading;
    return glm::angleAxis(active.view.camera.shown.yaw, Vec3(0, 1, 0));
}

// The scene in which the user drags the hand.
DragScene drag_scene(const scene::SceneWorld& world, const ActiveLesson& active,
                     const Projection& projection) {
    const StationClient& client = *active.station;
    const servo::Setup& setup = active.session->setup();
    DragScene scene;
    scene.projection = projection;
    scene.wrench = hand_of(active).wrench;
    scene.tool = scene.wrench ? tool_of(active).pose : client.latest.commanded_tool;
    scene.points_at_reachable = active.pointer.can_take_wrench || active.pointer.nut.has_value();
    scene.engaged = client.latest.output.joint >= 0;
    if (const auto nut = hand_of(active).nut)
        scene.nut = force::Pivot{world::nut_centre(world, setup, *nut), setup.nuts[*nut].axis};
    const station::DeviceLayout& layout = client.link->layout();
    scene.handle_length = station::lever_arm_of(layout, setup.wrench.handle_length);
    scene.arm_to_assembly = viewer_heading(active) * layout.workspace.rotation;
    scene.scale = layout.workspace.scale;
    return scene;
}

void move_camera(ActiveLesson& active, const FrameInput& input, double height, double aspect) {
    const glm::dvec2 turned =
        input.right_drag +
        (input.left_down && !active.pointer.drags_hand ? input.left_drag : glm::dvec2(0.0));
    view::turn(active.view.camera.goal, glm::dvec2(turned.x, -turned.y) / height);
    view::pan(active.view.camera.goal, glm::dvec2(input.middle_drag.x, -input.middle_drag.y) / height);
    const glm::dvec2 at(input.pointer.x / height - 0.5 * aspect, 0.5 - input.pointer.y / height);
    if (input.scroll != 0.0)
        view::zoom(active.view.camera.goal, input.scroll, at, active.workplace.workpiece);
}

}  // namespace

namespace {

// The head determines the view and the shoulder, the measured hand the tool.
void enter_room(ActiveLesson& active, const std::optional<RoomInput>& room) {
    static const xr::HandInput no_hand;
    active.view.head = room ? std::optional(room->room_in_assembly * room->head) : std::nullopt;
    active.view.heading = room ? std::optional(room->heading) : std::nullopt;
    if (active.view.head) active.shoulder = *active.view.head * shoulder_at_head;
    if (!active.station || !active.station->tracked) return;
    StationClient& client = *active.station;
    const bool seen = room && room->hands != nullptr;
    const xr::HandInput& measured = seen ? (*room->hands)[client.tracked->side] : no_hand;
    const station_setup::WornFingers* glove = client.link->worn_fingers();
    const bool gloved = glove != nullptr && glove->measured;
    client.wrist_fault =
        seen && glove != nullptr ? wrist_fault(room->hands->trackers, client.wrist_mount) : "";
    track_hand(
        *client.tracked,
        {gloved && seen ? with_glove(*room->hands, *glove, client.wrist_mount) : measured,
         room ? room->room_in_assembly : Pose{}, hand_of(active).wrench, client.latest.output.joint >= 0});
}

}  // namespace

namespace {

// Finds the nut and the wrench under the pointer. They stay the same while the hand is dragged.
void update_pointer(const scene::SceneWorld& world, ActiveLesson& active, const FrameInput& input,
                    const Projection& projection) {
    if (!input.pressed_at && active.pointer.drags_hand && input.left_down) return;
    // In a slow frame the pointer may have moved since the press.
    const glm::dvec2 pointer = input.pressed_at.value_or(input.pointer);
    const servo::Setup& setup = active.session->setup();
    active.pointer.nut = nut_at(projection, pointer, setup, nut_centres(world, setup));
    const Vec3 end = hand_of(active).rest * Vec3(setup.wrench.handle_length, 0.0, 0.0);
    const auto off = pixels_to_segment(projection, pointer, hand_of(active).rest.position, end);
    active.pointer.can_take_wrench =
        !hand_of(active).wrench && !active.pointer.nut && off && *off < wrench_reach;
}

// Handles the input for a station's hand, which a device moves, or the mouse through a simulated arm.
void handle_station_input(const scene::SceneWorld& world, const LessonFrame& frame,
                          const Projection& projection) {
    ActiveLesson& active = frame.active;
    const FrameInput& input = frame.input;
    StationClient& client = *active.station;
    // A device has no pointer: its hand takes what is beside it.
    if (!client.dragged || active.pointer.nut != hand_of(active).nut) active.pointer.nut.reset();
    active.pointer.can_take_wrench =
        client.near_wrench && (active.pointer.can_take_wrench || !client.dragged);
    active.pointer.drags_hand = client.dragged.has_value();
    if (client.dragged && !active.clock.paused)
        drag_hand(*client.dragged,
                  {input, client.keyboard.input(), client.keyboard.shift_down(), frame.seconds},
                  drag_scene(world, active, projection));
}

// Handles the input for the helped hand: the mouse chooses the nut and turns it.
void handle_mouse_input(ActiveLesson& active, const FrameInput& input, const Projection& projection) {
    MouseCommand command;
    if (input.pressed_at) {
        active.pointer.press_position = *input.pressed_at;
        press(active, command);
    }
    command.button_down = input.left_down && active.pointer.drags_hand;
    if (input.triggered(Action::tool))
        (hand_of(active).wrench ? command.lay_down : command.take_wrench) = true;
    if (command.button_down) {
        command.turn = handle_turn(active, projection, input.left_drag);
        command.spin = finger_twist(active, input.pointer.x - active.pointer.press_position.x);
    }
    if (active.undo.target && hand_of(active).nut) command.retreat = true;
    if (active.clock.finished || active.clock.paused) command = {};
    command.tool = active.session->due_tool();
    trainer::apply_command(active.helped_hand, command, active.session->setup(), active.session->state());
}

}  // namespace

void move_second_wrench(ActiveLesson& active) {
    const lesson::Lesson& lesson = active.session->lesson();
    const lesson::LessonStep* due = trainer::due(active.undo, lesson);
    const int joint = lesson.held_joint >= 0 ? lesson.held_joint
                      : due != nullptr       ? static_cast<int>(due->joint)
                                             : -1;
    if (joint < 0 || !lesson::needs_second_wrench(*lesson.assembly, static_cast<std::size_t>(joint))) return;
    active.second_wrench =
        active.second_wrench == joint ? std::int16_t{-1} : static_cast<std::int16_t>(joint);
}

void handle_input(const scene::SceneWorld& world, LessonFrame& frame) {
    ActiveLesson& active = frame.active;
    const FrameInput& input = frame.input;
    enter_room(active, frame.room);
    const Projection projection = projection_of(active, frame.size);
    update_pointer(world, active, input, projection);
    if (input.triggered(Action::restart_step)) request_undo(active.undo, active.session->lesson(), 0);
    if (input.triggered(Action::second_wrench)) move_second_wrench(active);
    if (input.triggered(Action::undo)) request_undo(active.undo, active.session->lesson(), 1);
    FrameInput view_input = input;
    if (active.station) {
        handle_station_input(world, frame, projection);
        // The dragged hand has used the scrolling.
        if (active.station->dragged && input.left_down) view_input.scroll = 0.0;
    } else {
        handle_mouse_input(active, input, projection);
    }
    move_camera(active, view_input, frame.size.y, frame.size.x / frame.size.y);
}

namespace {

constexpr double max_catch_up = 0.25;  // s of lesson time that one frame can catch up

void log_events(ActiveLesson& active, std::span<const lesson::LessonEvent> events) {
    for (const lesson::LessonEvent& event : events) {
        // Keep the explanation of the mistake when its step restarts.
        const bool undone_by_mistake = event.kind == lesson::EventKind::undo && active.undo.by_mistake;
        if (!undone_by_mistake) lesson::add_event(active.guidance.mistakes, active.session->lesson(), event);
        observe(active.undo, active.session->lesson(), event);
        active.events.push_back(event);
    }
}

// After each tick: updates plot, effort, log and sound from the components.
void after_tick(const scene::SceneWorld& world, ActiveLesson& active, const servo::Output& output) {
    const session::LessonSession& session = *active.session;
    if (world.only<world::WorkingHand>().wrench) observe(active.plot, session.lesson(), world);
    scene::update_effort(active.effort, session.setup(), world);
    log_events(active, session.events());
    const sound::LessonCues cues = sound::lesson_cues(session.events());
    if (active.sound.live) active.sound.live->add_tick(world, cues);
    const sound::SoundCues heard = sound::detect_events(active.sound.detector, session.setup(), world, cues);
    if (active.sound.captions) observe(*active.sound.captions, heard, session.setup().dt);
    const lesson::LessonStep* due = session.lesson().due();
    const double target = due != nullptr ? due->torque : 0.0;
    servo::advance_vibration(active.vibration.state, active.vibration.options,
                             servo::vibration_input(output, target, static_cast<double>(heard.strike_speed)),
                             session.setup().dt);
}

bool continues(const ActiveLesson& active) { return continues(active.undo, *active.session); }

// Writes the pose that mouse or station gave the hand in this frame; the last tick had an older one.
WorkingHand write_hand(scene::SceneWorld& world, const WorkingHand& hand) {
    WorkingHand& written = world.only<world::WorkingHand>() = hand;
    written.pinches = !hand.wrench && hand.nut && hand.action == HandAction::holding;
    return written;
}

void write_glove(scene::SceneWorld& world, const StationClient& client) {
    const ecs::Entity hand = world.pool<world::WorkingHand>().entities().front();
    const station_setup::WornFingers* worn = client.tracked ? client.link->worn_fingers() : nullptr;
    // A hand that a headset measures closes around the wrench as the drawn handle requires.
    const bool empty = client.latest.input.grip != servo::Grip::wrench;
    if (client.gloved)
        world.add<world::GloveHand>(hand, client.fingers, client.glove_lost);
    else if (worn != nullptr && worn->measured && client.tracked->joints && empty)
        world.add<world::GloveHand>(hand, *client.tracked->joints, worn->lost);
    else
        world.remove<world::GloveHand>(hand);
}

void step_ticks(scene::SceneWorld& world, LessonFrame& frame) {
    ActiveLesson& active = frame.active;
    session::LessonSession& session = *active.session;
    if (!active.clock.paused && !active.clock.finished) active.clock.pending += frame.seconds;
    if (!active.clock.paused && !active.clock.finished)
        active.clock.lag += frame.overrun + std::max(0.0, active.clock.pending - max_catch_up);
    active.clock.pending = std::min(active.clock.pending, max_catch_up);
    const servo::Setup& setup = session.setup();
    for (; active.clock.pending >= setup.dt && continues(active) && frame.status;
         active.clock.pending -= setup.dt) {
        servo::TickInput input = step_hand(active.helped_hand, setup, session.state());
        if (const lesson::LessonStep* due = session.lesson().due(); due != nullptr && session.lesson().guides)
            input.guided_joint = static_cast<std::int16_t>(due->joint);
        input.second_wrench = active.second_wrench;
        const auto undo = steps_to_undo(active.undo, session.lesson());
        if (undo && active.helped_hand.action == HandAction::resting && !active.helped_hand.nut)
            session.request_undo(*undo);
        const Result<servo::Output> output = session.tick(world, input);
        if (!output) {
            frame.status = fail(output.error());
            break;
        }
        after_tick(world, active, *output);
    }
    const WorkingHand hand = write_hand(world, hand_of(active.helped_hand));
    if (hand.action == HandAction::reaching)
        active.handle_posture_index =
            scene::natural_handle_posture(postures_of(active), hand.to, Vec3(0, 1, 0), active.shoulder);
}

// Repeats the station's ticks since the last frame with the lesson's own servo.
void repeat_station_ticks(scene::SceneWorld& world, LessonFrame& frame) {
    ActiveLesson& active = frame.active;
    StationClient& client = *active.station;
    const bool had_wrench = hand_of(active).wrench;
    client.link->step(frame.seconds);
    for (station::StationTick tick; continues(active) && frame.status && client.link->next_tick(tick);) {
        const bool free = tool_state_of(active).joint < 0;
        frame.status = active.session->repeat(world, tick.input, tick.output);
        if (tick.output.joint >= 0 && free) client.nut_angle_at_grip = tick.output.nut_angle;
        if (frame.status) after_tick(world, active, tick.output);
    }
    if (client.link->lost_ticks() > 0 && continues(active) && frame.status)
        frame.status = fail(ErrorCode::failed,
                            fmt::format("{} ticks of the servo were dropped because frames took too "
                                        "long; the session up to there is complete",
                                        client.link->lost_ticks()),
                            "frames that are short enough for the queue of ticks: close other programs or "
                            "lower the resolution");
    const Status sent = send_actions(
        client, *active.session,
        {active.clock.paused || active.clock.finished || !continues(active),
         frame.input.triggered(Action::tool), frame.input.triggered(Action::recentre),
         steps_to_undo(active.undo, active.session->lesson()), viewer_heading(active), active.second_wrench});
    if (frame.status && !sent) frame.status = sent;
    const WorkingHand hand = write_hand(world, hand_of(client));
    if (hand.wrench && !had_wrench)
        active.handle_posture_index = scene::natural_handle_posture(postures_of(active), tool_of(active).pose,
                                                                    Vec3(0, 1, 0), active.shoulder);
    write_glove(world, client);
}

void vibrate_controller(ActiveLesson& active, const LessonFrame& frame) {
    if (!frame.room || !frame.room->vibrate || !active.station || !active.station->tracked) return;
    const auto command = servo::next_vibration(active.vibration.state, active.vibration.options);
    if (!command) return;
    frame.room->vibrate(
        active.station->tracked->side,
        {static_cast<float>(command->amplitude), static_cast<float>(command->frequency), command->duration});
}

}  // namespace

void tick_system(scene::SceneWorld& world, LessonFrame& frame) {
    ActiveLesson& active = frame.active;
    if (active.station)
        repeat_station_ticks(world, frame);
    else
        step_ticks(world, frame);
    active.clock.finished = active.clock.finished || !continues(active);
    vibrate_controller(active, frame);
}

void placement_system(scene::SceneWorld& world, LessonFrame& frame) {
    const ActiveLesson& active = frame.active;
    const servo::State& state = active.session->state();
    scene::placement_system(
        world, {active.session->setup(), postures_of(active), active.shoulder, active.handle_posture_index,
                active.effort.share, active.effort.tremor, frame.seconds,
                state.tool_contact ? &state.tool_contact->world : nullptr});
}

namespace {

constexpr glm::vec4 pointer_color{0.9F, 0.95F, 1.0F, 0.8F}, no_color{0.0F};
constexpr double force_smoothing = 0.05;   // s
constexpr double force_arrow_place = 0.4;  // share of the handle from the jaw

void show_force(scene::SceneWorld& world, ActiveLesson& active, double seconds) {
    ForceDisplay& display = active.force;
    const bool dragged = active.station && active.station->dragged;
    if (!dragged || !display.enabled || active.clock.paused || active.clock.finished) {
        display.force = Vec3(0.0);
        scene::show_arrow(world, std::nullopt, scene::ArrowMeaning::force);
        return;
    }
    display.force +=
        std::min(1.0, seconds / force_smoothing) * (active.station->latest.output.force - display.force);
    const Pose& tool = tool_of(active).pose;
    // Between hand and work, because the wrist itself is often out of the picture.
    const double along =
        hand_of(active).wrench ? force_arrow_place * active.session->setup().wrench.handle_length : 0.0;
    scene::show_arrow(world, scene::force_arrow(tool * Vec3(along, 0.0, 0.0), display.force),
                      scene::ArrowMeaning::force);
}

}  // namespace

void guidance_system(scene::SceneWorld& world, LessonFrame& frame) {
    ActiveLesson& active = frame.active;
    const lesson::Lesson& lesson = active.session->lesson();
    update(active.undo, frame.seconds);
    if (frame.input.triggered(Action::mute)) active.sound.muted = !active.sound.muted;
    if (active.sound.live)
        active.sound.live->set_volume(active.sound.muted || active.clock.paused ? 0.0 : active.sound.volume);
    if (active.sound.captions && !active.clock.paused) update(*active.sound.captions, frame.seconds);
    if (!active.clock.paused) {
        // The pending undo will leave the lesson's current step: give no hint for that step.
        if (due(active.undo, lesson) == lesson.due())
            lesson::update(active.guidance.hints, {lesson, active.session->setup(), world}, frame.seconds,
                           frame.input.triggered(Action::hint));
        else
            active.guidance.hints.shown.reset();
        lesson::update(active.guidance.mistakes, active.undo.by_mistake ? 0.0 : frame.seconds);
    }
    const lesson::Hint* hint =
        active.guidance.hints.shown && !active.clock.finished ? &*active.guidance.hints.shown : nullptr;
    const int outlined = hint != nullptr ? hint->outlined() : -1;
    for (std::size_t i = 0; i < lesson.joints.size(); ++i) {
        glm::vec4 color = no_color;
        if (outlined == static_cast<int>(i)) color = active.palette.due;
        if (active.pointer.nut == i && !active.clock.finished) color = pointer_color;
        if (active.clock.finished) color = view::color_of(active.palette, active.verdicts[i]);
        scene::outline_joint(world, i, color);
    }
    const bool take_wrench_hint = hint != nullptr && hint->arrow() == lesson::HintMotion::take;
    scene::outline_tool(world, active.pointer.can_take_wrench ? pointer_color
                               : take_wrench_hint             ? active.palette.due
                                                              : no_color);
    show_hint_visuals(world, active, hint);
    scene::show_dial(world, scene::dial_of(lesson, active.session->setup(), world, active.palette));
    show_force(world, active, frame.seconds);
}

}  // namespace bolt::trainer
