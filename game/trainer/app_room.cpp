// The part of App that is played in a room, in a headset or before walls: the poses of workpiece and panel,
// the input of the hands, and the pictures.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "content/displays/panel_fit.hpp"
#include "game/station/frame_registration.hpp"
#include "game/trainer/app.hpp"

namespace bolt::trainer {

namespace {

static_assert(panel_points.x == content::panel_width_points &&
              panel_points.y == content::panel_height_points);
constexpr std::array room_actions{Action::place_again, Action::turn_left, Action::turn_right,
                                  Action::raise,       Action::lower,     Action::mirror};
constexpr double default_seated_eyes = 1.2;  // m above the floor, about the mean of DIN 33402-2

}  // namespace

// The pose of the assembly's frame in the room; the identity without a lesson.
Pose App::scene_in_room() const {
    if (!active_ || !room_->workpiece) return {};
    if (awaits_touch())
        return touch_scene(*room_->touch, *room_->workpiece, room_->workpiece_registered,
                           active_->workplace.workpiece);
    if (room_->arm && active_->station)
        return registered_scene(*room_->arm, active_->station->latest.mover_in_assembly);
    if (room_->workpiece_registered) return *room_->workpiece;
    return adjusted(*room_->workpiece, active_->workplace.workpiece, room_->turns, room_->height);
}

// Returns the room as the systems of a lesson read it.
RoomInput App::room_input(const view::ImmersiveFrame& immersive) const {
    const Pose scene = scene_in_room();
    RoomInput input;
    input.room_in_assembly = inverse(scene);
    input.head = immersive.head;
    input.hands = &immersive.hands;
    input.vibrate = immersive.vibrate;
    // A registered arm moves in the assembly as it moves in the room. Other devices move the tool to the
    // user's right for a push to the right, also after the user has turned the workpiece.
    if (!room_->arm && room_->workpiece)
        input.heading = glm::conjugate(scene.orientation) * room_->workpiece->orientation;
    return input;
}

Status App::share(cluster::MessageWriter& message, cluster::MessageWriter& bulk) {
    if (!sender_) sender_.emplace();
    SharedFrame frame;
    if (active_) {
        frame.models = &shared_models_;
        frame.lesson = lesson_number_;
        frame.on_gpu = gpu_->models.get();
        frame.scene = &active_->scene;
    }
    frame.scene_in_room = scene_in_room();
    if (in_room()) {
        frame.panel = room_->panel;
        frame.panel_point_size = room_->panel_point_size;
        frame.ray = wand_ray_;
    }
    sender_->write(message, bulk, frame);
    return {};
}

// Pauses a lesson when its user no longer sees it, and one that begins unseen in a room: no device may push,
// and a tracked hand is lost. The lesson continues when the user sees it again, unless the user resumes or
// ends it in the window before that. `immersive`: the frame has a room.
void App::pause_unseen(bool seen, bool immersive) {
    if (!room_) return;
    bool was_seen = std::exchange(room_->seen, seen);
    if (active_ && immersive)
        was_seen = std::exchange(room_->watched_lesson, lesson_number_) != lesson_number_ || was_seen;
    if (!active_ || screen_ != ShownScreen::lesson || !active_->station) return;
    bool& paused = active_->clock.paused;
    if (was_seen && !seen && !paused) room_->paused = paused = true;
    if (!seen) return;
    if (std::exchange(room_->paused, false)) paused = false;
}

// A tracked hand needs its headset. Without one the lesson pauses; if its user resumes it, the mouse moves
// the hand until the headset is back.
void App::follow_headset(const view::ImmersiveFrame* immersive) {
    MissingHeadset& missing = missing_headset_;
    if (!active_ || screen_ != ShownScreen::lesson || !active_->station) {
        missing.paused = missing.mouse_plays = false;
        return;
    }
    StationClient& client = *active_->station;
    bool& paused = active_->clock.paused;
    const auto pause = [&] {
        if (!paused) missing.paused = paused = true;
    };
    if (shown_in_headset() && immersive == nullptr) pause();
    if (client.tracked && immersive == nullptr) {
        if (!std::exchange(missing.noticed, true)) return pause();
        if (paused) return;
        missing = {true, false, true};
        if (room_) room_->paused = false;
        give_hand_to_mouse(client);
        apply_preferences();
        log("the mouse moves the hand until the headset is back");
    }
    if (immersive == nullptr) return;
    missing.noticed = false;
    if (!immersive->attentive) {
        // The window now shows the panel to a user who does not wear the headset yet.
        if (missing.mouse_plays) pause();
        return;
    }
    if (std::exchange(missing.paused, false)) paused = false;
    if (!std::exchange(missing.mouse_plays, false)) return;
    give_hand_to_headset(client, context_->worker.side);
    apply_preferences();
    log("the headset is back and tracks the hand");
}

// Once a lesson: if an arm is registered, sets its pose in the room and begins the touch check, or logs why
// picture and arm cannot be aligned.
void App::start_registered_arm(const view::ImmersiveFrame& immersive) {
    RoomState& room = *room_;
    if (!active_ || !active_->station) {
        room.arm.reset();
        room.touch.reset();
        room.arm_lesson = 0;
        return;
    }
    if (std::exchange(room.arm_lesson, lesson_number_) == lesson_number_) return;
    for (const content::Registration& one : context_->choice.equipment.station.registrations)
        if (const auto unused = station_setup::unused_registration(one.from, one.to)) log(unused->message());
    room.arm.reset();
    room.touch.reset();
    const content::Registration* found =
        content::find_registration(context_->choice.equipment.station.registrations,
                                   content::CoordinateFrame::arm, content::CoordinateFrame::room);
    // Only an arm is registered; the mouse and a tracked hand move the tool in the assembly's own frame.
    const StationClient& client = *active_->station;
    if (found == nullptr || !context_->choice.equipment.station.arm || client.dragged || client.tracked)
        return;
    const double scale = client.link->layout().workspace.scale;
    if (scale != 1.0 || !immersive.fixed_in_room) {
        log(fmt::format(
            "picture and arm are not aligned: {}",
            scale != 1.0
                ? fmt::format("the scale of the arm is {:.2f}; expected 1 (\"scale\" in the station file)",
                              scale)
                : "the poses of the headset are not fixed in the room; expected a headset whose room is "
                  "set up"));
        return;
    }
    room.arm = found->from == content::CoordinateFrame::arm ? found->pose : inverse(found->pose);
    log(
        fmt::format("picture and arm are aligned: registered on {} with {:.1f} mm rms; `boltwright station "
                    "register FILE --check` checks it",
                    found->date, found->rms / mm));
    if (!room.touch_done && active_->session->time() == 0.0) room.touch = touch_check_of(*found);
    if (room.touch) active_->clock.paused = true;
}

// Advances the touch check: keeps the lesson paused and performs the user's answer.
void App::follow_touch_check(std::span<const platform::InputEvent> events, double seconds,
                             bool enter_key_answers) {
    if (!room_ || !room_->touch) return;
    if (!active_ || screen_ != ShownScreen::lesson || !active_->station) return room_->touch.reset();
    TouchCheck& touch = *room_->touch;
    active_->clock.paused = true;
    if (settings_ || arm_screen_.needs.any()) {  // another screen covers it
        touch.held_buttons = ~0U;
        return;
    }
    const TouchAnswer answer = answer_of(touch, events, enter_key_answers);
    const bool asked = waits_for_touch(touch);
    const bool started = trainer::update(touch, active_->station->latest.mover, answer.confirmed, seconds);
    if (asked && !waits_for_touch(touch))
        log(fmt::format("a touch of the registration's check point is off by {:.1f} mm{}", touch.error / mm,
                        touch.phase == TouchPhase::failed ? "; register the arm again" : ""));
    if (started || answer.ended) end_touch_check();
}

void App::show_touch() {
    TouchView view{words_, scene_in_room(), std::nullopt, room_->workpiece_registered};
    if (active_->station && active_->station->latest.mover)
        view.handle = active_->station->latest.mover->pose;
    show_touch_marker(active_->scene, *gpu_->models, *room_->touch, view);
}

// Ends the touch check and starts the lesson, unless its user does not see it.
void App::end_touch_check() {
    if (!room_ || !room_->touch) return;
    if (waits_for_touch(*room_->touch)) log("the check of the arm's registration was skipped");
    room_->touch.reset();
    room_->touch_done = true;
    active_->clock.paused = room_->paused = !room_->seen;
}

// The pose of the real workpiece in the room, if it is registered.
std::optional<Pose> App::registered_workpiece(const view::ImmersiveFrame& immersive) {
    const Result<content::Registration> found =
        station_setup::registration_from(context_->choice.equipment.station.registrations,
                                         content::CoordinateFrame::workpiece, content::CoordinateFrame::room);
    if (!found) return std::nullopt;
    if (immersive.fixed_in_room) return found->pose;
    log("the registered workpiece is not used: the poses of the headset are not fixed in the room; expected "
        "a headset whose room is set up");
    return std::nullopt;
}

// Places panel and workpiece if they have no place yet.
void App::place_in_room(const view::ImmersiveFrame& immersive) {
    RoomState& room = *room_;
    const Pose& viewer = immersive.expected_head ? *immersive.expected_head : immersive.head;
    const bool placed = can_place(room.placement, immersive);
    if (placed && !room.panel) {
        room.panel = immersive.panel ? immersive.panel->pose : place_panel(viewer);
        room.panel_point_size = immersive.panel ? immersive.panel->point_size : point_size;
        room.placement.provisional = !immersive.expected_head && !is_worn(immersive);
    }
    if (!active_) {
        room.workpiece.reset();
        room.workpiece_registered = false;
    }
    start_registered_arm(immersive);
    if (placed && active_ && !room.workpiece) {
        const bool before = std::exchange(room.workpiece_registered, false);
        room.workpiece = registered_workpiece(immersive);
        room.workpiece_registered = room.workpiece.has_value();
        if (room.workpiece_registered && !before)
            log("the workpiece stands where the real one is registered");
    }
    if (placed && active_ && !room.workpiece) {
        const render::BoundingBox& box = active_->workplace.workpiece;
        const content::TraineeSettings& settings = preferences_.settings;
        UserBody user{settings.seated_eye_height, settings.arm_reach};
        if (!user.seated_eyes && !immersive.floor_known) user.seated_eyes = default_seated_eyes;
        room.workpiece = place_workpiece(viewer, box, user);
        if (immersive.shows) room.workpiece = moved_into_view(*room.workpiece, box, viewer, immersive.shows);
        room.placement.workpiece_faced = false;
    }
}

// The tracked hand that holds the wrench, or is beside the wrench or a nut; none: the hands may point at the
// panel.
std::optional<xr::Side> App::working_hand() const {
    const bool works = active_ && screen_ == ShownScreen::lesson && !active_->clock.paused && !settings_ &&
                       active_->station && active_->station->tracked;
    if (!works) return std::nullopt;
    const StationClient& client = *active_->station;
    const bool busy = hand_of(*active_).wrench || client.near_wrench || client.near_nut;
    return busy ? std::optional(client.tracked->side) : std::nullopt;
}

// The hands, with the glove that a lesson uses.
xr::Hands App::gloved_hands(xr::Hands hands) const {
    if (!active_ || !active_->station) return hands;
    const StationClient& client = *active_->station;
    if (const station_setup::WornFingers* glove = client.link->worn_fingers())
        hands[glove->side] = with_glove(hands, *glove, client.wrist_mount);
    return hands;
}

// Performs an action of a key or of a button of the pause, in a room.
void App::perform_in_room(Action action) {
    if (!room_) return;
    RoomState& room = *room_;
    if (action == Action::place_again) room.placement.requested = true;
    if (action == Action::turn_left) --room.turns;
    if (action == Action::turn_right) ++room.turns;
    if (action == Action::raise) raise(room, raise_step);
    if (action == Action::lower) raise(room, -raise_step);
    if (action == Action::mirror)
        options_.mirror =
            static_cast<view::Mirror>((static_cast<std::size_t>(options_.mirror) + 1) % view::mirror_count);
}

// Removes the places that are to be chosen again in this frame.
void App::follow_placement(const view::ImmersiveFrame& immersive,
                           std::span<const platform::InputEvent> events, double seconds) {
    RoomState& room = *room_;
    const bool types = settings_ || gpu_->ui->edits_text();
    for (const platform::InputEvent& event : events) {
        const auto* key = std::get_if<platform::KeyEvent>(&event);
        if (key == nullptr || !key->down || key->repeated || types) continue;
        for (const Action action : room_actions)
            if (key->key == preferences_.keys.of(action)) perform_in_room(action);
    }
    if (immersive.expected_head && room.placement.requested) {
        // On walls all stands in front of the viewer but for what the user has changed.
        room.turns = 0;
        room.height = 0.0;
    }
    PlacedObjects placed{room.panel, std::nullopt};
    if (active_ && room.workpiece)
        placed.workpiece =
            scene_in_room() *
            (0.5 * (Vec3(active_->workplace.workpiece.low) + Vec3(active_->workplace.workpiece.high)));
    const ObjectsToPlace replaced = trainer::update(room.placement, immersive, placed, seconds);
    if (replaced.panel) room.panel.reset();
    if (replaced.workpiece) room.workpiece.reset();
    if (immersive.origin_moved) room.touch_done = false;  // the registration may be wrong from now on
}

// Places workpiece and panel, and adds the input of the hands as events.
void App::follow_room(const view::WindowFrame& window, std::vector<platform::InputEvent>& events) {
    const view::ImmersiveFrame* immersive = window.immersive;
    if (room_) room_->plays_in_room = room_->has_display = false;
    wand_ray_.reset();
    if (immersive == nullptr) {
        pause_unseen(false, false);
        follow_headset(nullptr);
        return;
    }
    if (!room_) room_.emplace();
    RoomState& room = *room_;
    room.has_display = true;
    // On walls a lesson by mouse is played in the window, and the walls show it.
    const Equipment& equipment = (active_ ? context_->choice : options_.choice).equipment;
    room.plays_in_room = immersive->tracks_hands || !active_ || equipment.has_hardware();
    if (immersive->tracks_hands) offer_tracked_hand(menu_.devices);
    follow_placement(*immersive, events, window.seconds);
    place_in_room(*immersive);
    pause_unseen(immersive->attentive && room.panel && (!active_ || room.workpiece), true);
    follow_headset(immersive);
    if (!room.plays_in_room) return;
    if (immersive->tracks_hands) {
        // The window's pointer would compete with the hands'.
        std::erase_if(events, [](platform::InputEvent& event) { return pointer_position(event) != nullptr; });
    } else {
        move_to_panel(events, view::fitted(panel_extent, window.size));
    }
    const xr::HandInput& wand = immersive->hands[Side::right];
    if (!immersive->tracks_hands && wand.active && wand.aim)
        wand_ray_ = pointing_ray(room, wand.aim->pose, room.pointer.pressed);
    trainer::update(room.vignette, scene_in_room(), window.seconds);
    const HandKeys keys{platform::Key::escape, preferences_.keys.of(Action::tool)};
    const std::vector<platform::InputEvent> hands =
        hand_events(room, gloved_hands(immersive->hands), keys, window.seconds, working_hand());
    events.insert(events.end(), hands.begin(), hands.end());
}

// Adds the hands that the lesson does not draw, and their rays, to the scene; for a wand only its ray.
Status App::draw_hands(render::Scene& scene, const view::ImmersiveFrame& immersive) {
    if (!room_ || !(immersive.tracks_hands || wand_ray_)) return {};
    if (!gpu_->room_hands) {
        BOLT_TRY_ASSIGN(auto models, load_room_hands(*gpu_->context->device));
        gpu_->room_hands = std::move(models);
    }
    if (wand_ray_) add_ray(scene, gpu_->room_hands->ray, *wand_ray_, inverse(scene_in_room()));
    if (!immersive.tracks_hands) return {};
    const bool plays = active_ && screen_ == ShownScreen::lesson && !active_->clock.paused && !settings_;
    ShownHands shown{!plays, {}};
    if (plays && active_->station && active_->station->tracked)
        shown.by_lesson = active_->station->tracked->side;
    if (!active_) add_menu_light(scene);
    add_room_hands(scene, *gpu_->room_hands, gloved_hands(immersive.hands), *room_, scene_in_room(), shown);
    return {};
}

Status App::draw_room(gpu::FrameContext& frame, const view::ImmersiveFrame& immersive) {
    const Pose place = scene_in_room();
    render::Scene scene = active_ ? active_->scene : empty_room();
    if (immersive.has_passthrough && wants_passthrough()) {
        scene.transparent = true;
        if (active_)
            std::erase_if(scene.objects, [&](const render::Object& object) {
                return object.model == &gpu_->models->workshop;
            });
    }
    BOLT_TRY(draw_hands(scene, immersive));
    if (in_room() && room_->panel)
        scene.panels.push_back(
            panel_in_scene({*room_->panel, room_->panel_point_size}, place, gpu_->panel->image()));
    BOLT_TRY(draw_in_room(*gpu_->context->renderer, frame, scene, place, immersive));
    if (!room_) return {};
    room_->drawn_scene = place;
    // Neither the real room behind a transparent picture nor the surroundings of a wall move with the scene.
    const bool darkens = preferences_.settings.vignette && immersive.tracks_hands && !scene.transparent;
    return darkens ? draw_vignette(*gpu_->context->renderer, frame, room_->vignette, immersive) : Status{};
}

bool App::move_eyes(const view::WindowFrame& window) {
    // draw() may have ended the lesson, so scene_in_room() may differ from the drawn pose.
    if (room_) move_eyes_in_room(*gpu_->context->renderer, room_->drawn_scene, *window.immersive);
    return room_.has_value();
}

}  // namespace bolt::trainer
