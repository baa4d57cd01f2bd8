#include "game/trainer/station_client.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "game/station/station_setup.hpp"
#include "haptics/device/device.hpp"
#include "haptics/hand/glove_driver.hpp"

namespace bolt::trainer {

namespace {

using platform::Key;

struct Way {
    Key key;
    Vec3 along, about;
};
const Way ways[] = {
    {Key::d, Vec3(1, 0, 0), Vec3(0.0)},       {Key::a, Vec3(-1, 0, 0), Vec3(0.0)},
    {Key::e, Vec3(0, 1, 0), Vec3(0.0)},       {Key::q, Vec3(0, -1, 0), Vec3(0.0)},
    {Key::s, Vec3(0, 0, 1), Vec3(0.0)},       {Key::w, Vec3(0, 0, -1), Vec3(0.0)},
    {Key::left, Vec3(0.0), Vec3(0, 1, 0)},    {Key::right, Vec3(0.0), Vec3(0, -1, 0)},
    {Key::up, Vec3(0.0), Vec3(-1, 0, 0)},     {Key::down, Vec3(0.0), Vec3(1, 0, 0)},
    {Key::page_up, Vec3(0.0), Vec3(0, 0, 1)}, {Key::page_down, Vec3(0.0), Vec3(0, 0, -1)},
};
// A key is pressed or it is not. Faster than a tool is drawn to a nut, or it would never come off.
constexpr double share = 0.75;

}  // namespace

void Pushing::take(std::span<const platform::Event> events) {
    for (const platform::Event& event : events) {
        if (const auto* key = std::get_if<platform::KeyEvent>(&event))
            down_.set(static_cast<std::size_t>(key->key), key->down);
        else if (const auto* focus = std::get_if<platform::FocusEvent>(&event);
                 focus != nullptr && !focus->here)
            down_.reset();
    }
}

device::PuckInput Pushing::push() const {
    device::PuckInput push;
    for (const Way& way : ways) {
        if (!down_.test(static_cast<std::size_t>(way.key))) continue;
        push.along += share * way.along;
        push.about += share * way.about;
    }
    push.buttons = closes() ? 1 : 0;
    return push;
}

bool Pushing::closes() const { return down_.test(static_cast<std::size_t>(Key::space)); }

namespace {

std::string name_of(const station_setup::Choice& choice) {
    std::string name = choice.mover ? choice.mover->name : std::string();
    if (choice.wheel) name += (name.empty() ? "" : " + ") + choice.wheel->name;
    return name;
}

}  // namespace

std::vector<Seat> seats() {
    std::vector<Seat> there{{{}, {}}};
    const station_setup::Choice all = station_setup::choose_any(device::list_devices());
    const auto add = [&](const station_setup::Choice& choice) {
        there.push_back({name_of(choice), {station_setup::ids_of(choice), {}, {}, 1.0, false}});
    };
    if (all.mover) add({all.mover, std::nullopt});
    if (all.wheel) add({std::nullopt, all.wheel});
    if (all.mover && all.wheel) add(all);
    return there;
}

Equipment usual_equipment() {
    Equipment with;
    const station_setup::Choice all = station_setup::choose_any(device::list_devices());
    if (all.mover) with.devices = station_setup::ids_of(all);
    return with;
}

Result<std::unique_ptr<station_setup::Bench>> start_station(const content::Assembly& assembly,
                                                            const session::CourseOptions& course,
                                                            const Equipment& with,
                                                            const std::string& trainee) {
    device::VirtualPuck puck({}, device::steady_timer());
    station_setup::Wanted wanted;
    wanted.devices = with.devices;
    wanted.rig = with.rig;
    wanted.otherwise = puck.open();
    wanted.glove = with.glove;
    wanted.trainee = trainee;
    wanted.force_scale = with.force_scale;
    if (!with.glove.empty() && trainee.empty())
        return fail(ErrorCode::no_device, "nobody is said to wear the glove",
                    "the trainee's name, as boltwright glove calibrate has it");
    Result<station_setup::Planned> planned = station_setup::plan_lesson(assembly, course, wanted, {});
    if (!planned) return fail(planned.error());
    station::StationOptions& plan = planned->plan;
    plan.controls.pause = true;
    std::optional<device::VirtualPuck> pushed;
    if (!planned->choice.mover) {
        pushed = std::move(puck);
        plan.mover_buttons = {1, 0, 0, 0};
    }
    return station_setup::start_bench(std::move(plan), std::move(pushed));
}

namespace {

constexpr double believed = 0.5;       // s without a picture, then nobody holds the dead-man
constexpr double nut_reach = 0.06;     // m
constexpr double let_go_reach = 0.08;  // m, of a nut that the hand is at
constexpr double draws_from = 0.06;    // m, where no lesson leads: a tool that is only pushed is drawn on

double off_handle(const Vec3& point, const Pose& wrench, double length) {
    const Vec3 local = inverse(wrench) * point;
    return glm::distance(local, Vec3(std::clamp(local.x, 0.0, length), 0.0, 0.0));
}

std::optional<std::size_t> nearest_nut(const session::Course& course, const Vec3& tool, double within) {
    std::optional<std::size_t> nearest;
    for (std::size_t i = 0; i < course.setup().nuts.size(); ++i) {
        const Vec3 nut = servo::nut_centre(course.setup().nuts[i], course.state().joints[i].nut.angle);
        const double distance = glm::distance(nut, tool);
        if (distance >= within) continue;
        within = distance;
        nearest = i;
    }
    return nearest;
}

bool pinches(const hand::Skeleton& hand) {
    return glm::distance(hand.position[hand::thumb_tip], hand.position[hand::index_tip]) < pinch;
}

// What a hand without a glove has, or the fingers of one with a glove; the wrench in that is the glove's.
servo::Grip grip_of(const StationClient& at, bool closes, const Asked& asked) {
    const bool has = (at.gloved ? at.now.input.grip : at.controls.grip) == servo::Grip::wrench;
    const bool engaged = at.now.output.joint >= 0;
    if (has && !at.gloved) return asked.tool && !engaged ? servo::Grip::none : servo::Grip::wrench;
    if (has) return servo::Grip::none;
    const bool takes = (closes && !at.closed) || asked.tool;
    if (!at.gloved && takes && at.near_wrench && !engaged) return servo::Grip::wrench;
    return closes && at.near ? servo::Grip::fingers : servo::Grip::none;
}

void look(StationClient& at, const session::Course& course) {
    at.now = at.bench->latest_tick();
    at.troubles = at.bench->troubles();
    const station::DisplayedHand* hand = at.bench->hand();
    at.gloved = hand != nullptr;
    at.glove_lost = hand != nullptr && hand->lost;
    if (hand != nullptr && hand->has_frame) at.fingers = hand->joints;
    const double within = at.near ? let_go_reach : nut_reach;
    at.near = nearest_nut(course, at.now.output.tool.position, within);
    at.near_wrench = at.now.wrench_rest &&
                     off_handle(at.now.tool.position, *at.now.wrench_rest,
                                course.setup().wrench.handle_length) < station::handle_capture_distance;
}

// Sends what the station does once: checkpoints, undo, and moves of the tool to its beginning.
Status send_commands(StationClient& at, const session::Course& course, const Asked& asked) {
    for (; at.checkpoints_sent < course.marks(); ++at.checkpoints_sent)
        BOLT_TRY(at.bench->send(station::SaveCheckpoint{}));
    const bool engaged = at.now.output.joint >= 0;
    const std::uint8_t back = asked.undo && !engaged ? course.undo_by(*asked.undo) : std::uint8_t{0};
    if (back != at.restore_sent) {
        if (at.restore_sent == 0)
            BOLT_TRY(at.bench->send(station::RestoreCheckpoint{back}));
        else
            BOLT_TRY(at.bench->send(station::AmendRestore{back}));
        at.restore_sent = back;
    }
    if (at.placed && (engaged || !asked.recentre)) return {};
    at.placed = true;
    return at.bench->send(station::PlaceTool{at.home});
}

}  // namespace

Hand hand_of(const StationClient& at) {
    const bool engaged = at.now.output.joint >= 0;
    Hand hand;
    hand.wrench = at.now.input.grip == servo::Grip::wrench;
    hand.nut = engaged ? std::optional(static_cast<std::size_t>(at.now.output.joint)) : at.near;
    hand.doing = engaged ? Doing::holding : hand.nut ? Doing::lowering : Doing::resting;
    hand.pose = hand.to = at.now.tool;
    hand.rest = at.now.wrench_rest.value_or(at.rest);
    if (at.gloved && engaged && at.now.input.grip == servo::Grip::fingers)
        hand.room = std::max(0.0, forearm_turns - std::abs(at.now.output.nut_angle - at.taken_at));
    return hand;
}

bool has_dead_man(const station::Layout& layout) {
    const auto pulls = [](const std::optional<device::Description>& d) {
        return d && (station::renders_force(*d) || station::renders_torque(*d));
    };
    return pulls(layout.mover) || pulls(layout.wheel);
}

Status wish(StationClient& at, const session::Course& course, const Asked& asked) {
    look(at, course);
    at.bench->push(at.keys.push());
    station::StationControls& w = at.controls;
    const bool held = at.gloved && at.now.input.grip == servo::Grip::wrench;
    const bool closes =
        at.keys.closes() || at.now.dead_man_pressed || (at.gloved && !held && pinches(at.fingers));
    w.pause = asked.paused;
    w.wrench_rest = at.rest;
    w.bare_wrist = at.bare_wrist;
    w.grip = grip_of(at, closes, asked);
    // A glove that tells nothing any more holds the wrench, but no dead-man.
    const bool hand_closed = at.gloved && !at.glove_lost && (held || closes);
    w.dead_man = !has_dead_man(at.bench->layout()) || hand_closed || at.keys.closes();
    w.dead_man_timeout = believed;
    w.view = asked.looks;
    const lesson::Step* due = course.lesson().due();
    const bool leads = due != nullptr && course.lesson().guides;
    w.guide = leads ? static_cast<std::int16_t>(due->joint) : std::int16_t{-1};
    // Only while the hand closes: nothing is done by itself.
    const auto drawn =
        leads ? std::optional(due->joint) : nearest_nut(course, at.now.output.tool.position, draws_from);
    w.glide = drawn && closes ? static_cast<std::int16_t>(*drawn) : std::int16_t{-1};
    w.click_setting = static_cast<float>(lesson::setting(course.lesson()));
    at.bench->set_controls(w);
    at.closed = closes;
    return send_commands(at, course, asked);
}

}  // namespace bolt::trainer
