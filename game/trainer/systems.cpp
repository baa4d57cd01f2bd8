#include "game/trainer/systems.hpp"

#include <algorithm>
#include <cmath>

#include "game/scene/find_view.hpp"
#include "game/scene/labels.hpp"
#include "game/view/label_places.hpp"
#include "game/view/result_pictures.hpp"

namespace bolt::trainer {

namespace {

constexpr double twist_shown = 0.3;                    // of the fingers' twist, at the wrist
constexpr double longest_step = 0.25;                  // s of lesson that one frame catches up with
constexpr double undo_patience = 6.0;                  // s
constexpr double spin_reach = 120.0;                   // px of drag for the fastest twist
constexpr double wrench_reach = 22.0;                  // px beside a wrench that still count
constexpr double lost_below = 0.15, lost_after = 3.0;  // of nut and jaw; s
constexpr std::size_t most_plotted = 4000;

constexpr glm::vec4 under_color{0.9F, 0.95F, 1.0F, 0.8F}, nothing{0.0F};

std::vector<Vec3> centres_of(const play::Course& course) {
    std::vector<Vec3> centres;
    for (std::size_t i = 0; i < course.setup().nuts.size(); ++i)
        centres.push_back(servo::nut_centre(course.setup().nuts[i], course.state().joints[i].nut.angle));
    return centres;
}

bool loosening(const play::Course& course) { return course.lesson().task == lesson::Task::loosen; }

// What the press meant: the hand, or the view.
void press(Playing& p, Wish& wish) {
    p.hand_drag = p.under.has_value() || p.over_wrench;
    if (p.under) {
        wish.nut = p.under;
        wish.loosens = loosening(*p.course);
    } else if (p.over_wrench) {
        wish.wrench = true;
    }
}

double drag_of(const Playing& p, const Screen& screen, const glm::dvec2& drag) {
    if (!p.hand.nut || p.hand.doing != Doing::holding || !p.hand.wrench) return 0.0;
    const servo::Setup& setup = p.course->setup();
    const glm::dvec2 lever =
        lever_on_screen(screen, p.output.tool, setup.nuts[*p.hand.nut].axis, setup.wrench.handle_length);
    return turn_of_drag(lever, drag);
}

void move_camera(Playing& p, const Wanted& wanted, double height, double aspect) {
    const glm::dvec2 turned =
        wanted.turned + (wanted.left && !p.hand_drag ? wanted.dragged : glm::dvec2(0.0));
    view::turn(p.camera.goal, glm::dvec2(turned.x, -turned.y) / height);
    view::pan(p.camera.goal, glm::dvec2(wanted.moved.x, -wanted.moved.y) / height);
    const glm::dvec2 at(wanted.pointer.x / height - 0.5 * aspect, 0.5 - wanted.pointer.y / height);
    if (wanted.wheel != 0.0) view::zoom(p.camera.goal, wanted.wheel, at, p.place.machine);
}

void plot(Playing& p, const servo::Output& output) {
    if (output.joint < 0 || !p.hand.wrench) return;
    if (output.joint != p.plotted) p.plot.clear();
    p.plotted = output.joint;
    const PlotPoint now{static_cast<float>(to_degrees(output.nut_angle)),
                        static_cast<float>(output.wrench_torque)};
    const bool same = !p.plot.empty() && std::abs(p.plot.back().angle - now.angle) < 0.02F &&
                      std::abs(p.plot.back().torque - now.torque) < 0.2F;
    if (!same && p.plot.size() < most_plotted) p.plot.push_back(now);
}

void say(Playing& p, std::span<const lesson::Event> events) {
    for (const lesson::Event& event : events) {
        hints::note(p.mistakes, p.course->lesson(), event);
        p.said.push_back(event);
    }
}

// What hints are made of.
hints::Scene hint_scene(const Playing& p) {
    const play::Course& course = *p.course;
    hints::Scene scene{course.lesson(), course.setup(), course.state().joints, p.output,
                       course.state().rounded};
    scene.wrench_in_hand = p.hand.wrench;
    if (p.hand.wrench && p.hand.doing == Doing::holding)
        scene.room = p.hand.room - std::abs(p.hand.handle - p.hand.begun_at);
    return scene;
}

// The wrench on the due nut, or the hand there, as an image of what is to be done.
void show_ghost(scene::World& world, Playing& p, hints::Ghost ghost) {
    const lesson::Lesson& lesson = p.course->lesson();
    const lesson::Step* due = lesson.due();
    if (due == nullptr || ghost != hints::Ghost::hand_and_wrench) {
        p.ghost.reset();
        scene::hide_ghost(world);
        return;
    }
    if (!p.ghost || p.ghost->first != lesson.current)
        p.ghost = {lesson.current, wrench_on(p.hand, p.course->setup(), p.course->state(), due->joint,
                                             due->kind == lesson::StepKind::loosen)};
    scene::show_ghost(world, p.ghost->second);
}

// The joint that is worked at, or is due; which one is due an assessment does not tell.
std::optional<std::size_t> at_work(const Playing& p) {
    if (p.course->lesson().mode == lesson::Mode::assessment) return p.hand.nut;
    if (p.hand.nut && p.hand.doing != Doing::resting) return p.hand.nut;
    const lesson::Step* due = p.course->lesson().due();
    return due != nullptr ? std::optional(due->joint) : std::nullopt;
}

scene::ViewOf view_of(const Playing& p, std::size_t joint) {
    const servo::Setup& setup = p.course->setup();
    const servo::State& state = p.course->state();
    scene::ViewOf of{setup, state.touch ? &*state.touch : nullptr, joint,
                     servo::nut_centre(setup.nuts[joint], state.joints[joint].nut.angle), std::nullopt};
    if (p.hand.wrench && p.hand.nut == joint) of.wrench = p.output.tool;
    return of;
}

void look_at_work(Playing& p) {
    const auto joint = at_work(p);
    if (!joint) return;
    p.camera.go(scene::find_view(view_of(p, *joint), p.sight, p.camera.goal));
    p.unseen = 0.0;
}

// What is due has been out of the picture or hidden for a while. Not in an assessment: nobody helps there.
bool lost(Playing& p, const Frame& frame) {
    const auto joint = at_work(p);
    if (!joint || p.course->lesson().mode == lesson::Mode::assessment || p.finished || p.paused) return false;
    const scene::ViewOf of = view_of(p, *joint);
    const Screen screen = screen_of(p, frame.size);
    const auto at = project(screen, of.nut);
    const glm::dvec2 edge = 0.04 * frame.size;
    const bool inside = at && at->x > edge.x && at->y > edge.y && at->x < frame.size.x - edge.x &&
                        at->y < frame.size.y - edge.y;
    const bool seen = inside && scene::seen_from(of, p.sight, Vec3(screen.eye.position)) > lost_below;
    p.unseen = seen ? 0.0 : p.unseen + frame.seconds;
    return p.unseen > lost_after;
}

}  // namespace

Screen screen_of(const Playing& p, const glm::dvec2& size) {
    return {view::eye_of(p.camera.shown, render::bounds(p.scene), static_cast<float>(size.x / size.y)), size};
}

void pointing_system(scene::World&, Frame& frame) {
    Playing& p = frame.playing;
    const Wanted& wanted = frame.wanted;
    const Screen screen = screen_of(p, frame.size);
    if (!p.hand_drag || !wanted.left) {
        p.under = nut_at(screen, wanted.pointer, p.course->setup(), centres_of(*p.course));
        const Vec3 end = p.hand.rest * Vec3(p.course->setup().wrench.handle_length, 0.0, 0.0);
        const auto off = pixels_to(screen, wanted.pointer, p.hand.rest.position, end);
        p.over_wrench = !p.hand.wrench && !p.under && off && *off < wrench_reach;
    }
    Wish wish;
    wish.held = wanted.left && p.hand_drag;
    if (wanted.pressed) {
        p.press = *wanted.pressed;
        press(p, wish);
        wish.held = wanted.left && p.hand_drag;
    }
    if (wanted.wants(Action::restart_step)) p.undo = 0;
    if (wanted.wants(Action::undo)) p.undo = 1;
    if (wanted.wants(Action::tool)) (p.hand.wrench ? wish.lay_down : wish.wrench) = true;
    if (wish.held) {
        wish.turn = drag_of(p, screen, wanted.dragged);
        wish.spin = (wanted.pointer.x - p.press.x) / spin_reach;
    }
    if (p.course->lesson().mode == lesson::Mode::assessment) p.undo.reset();
    if (p.undo && p.hand.nut) wish.retreat = true;
    if (p.finished || p.paused) wish = {};
    trainer::wish(p.hand, wish, p.course->setup(), p.course->state());
    move_camera(p, wanted, frame.size.y, frame.size.x / frame.size.y);
}

void haptic_system(scene::World& world, Frame& frame) {
    Playing& p = frame.playing;
    play::Course& course = *p.course;
    if (!p.paused && !p.finished) p.owed += frame.seconds;
    p.lagged += std::max(0.0, p.owed - longest_step);
    p.owed = std::min(p.owed, longest_step);
    const servo::Setup& setup = course.setup();
    for (; p.owed >= setup.dt && !course.over() && frame.status; p.owed -= setup.dt) {
        servo::Input input = move(p.hand, setup, course.state());
        if (const lesson::Step* due = course.lesson().due(); due != nullptr && course.lesson().guides)
            input.guide = static_cast<std::int16_t>(due->joint);
        if (p.undo && p.hand.doing == Doing::resting && !p.hand.nut) course.go_back(*p.undo);
        const Result<servo::Output> output = course.step(input);
        if (!output) {
            frame.status = fail(output.error());
            break;
        }
        p.output = *output;
        plot(p, *output);
        say(p, course.events());
        if (p.sound) p.sound->tick(*output, sound::cues_of(course.events()));
        if (output->undone > 0) p.undo.reset();
    }
    p.finished = p.finished || course.over();
    const bool pinches = !p.hand.wrench && p.hand.nut && p.hand.doing == Doing::holding;
    if (p.hand.doing == Doing::reaching)
        p.grip =
            scene::natural_grip(p.postures, p.hand.stations.empty() ? p.hand.to : p.hand.stations.front(),
                                Vec3(0, 1, 0), p.shoulder);
    const bool returning = p.hand.doing == Doing::returning || p.hand.doing == Doing::holding;
    const double twisted = returning ? -twist_shown * (p.hand.handle - p.hand.begun_at) : 0.0;
    const scene::Held held{
        p.hand.wrench ? p.output.tool : p.hand.pose,      p.hand.wrench, p.hand.rest,  pinches,
        scene::towards(p.hand.pose, p.shoulder, twisted), p.grip,        frame.seconds};
    scene::place_nuts(world, setup, course.state().joints);
    scene::place_tool(world, held);
    scene::place_hand(world, p.postures, held);
}

void lesson_system(scene::World& world, Frame& frame) {
    Playing& p = frame.playing;
    const lesson::Lesson& lesson = p.course->lesson();
    // A wish that cannot be granted is forgotten: nothing leaps when nobody expects it any more.
    p.undo_for = p.undo ? p.undo_for + frame.seconds : 0.0;
    if (p.undo_for > undo_patience) p.undo.reset();
    if (frame.wanted.wants(Action::quiet)) p.quiet = !p.quiet;
    if (p.sound) p.sound->set_volume(p.quiet || p.paused ? 0.0 : 1.0);
    if (!p.paused) {
        hints::update(p.hints, hint_scene(p), frame.seconds, frame.wanted.wants(Action::hint));
        hints::update(p.mistakes, frame.seconds);
    }
    const hints::Hint* hint = p.hints.shown && !p.finished ? &*p.hints.shown : nullptr;
    const int outlined = hint != nullptr ? hint->outlined() : -1;
    for (std::size_t i = 0; i < lesson.joints.size(); ++i) {
        glm::vec4 color = nothing;
        if (outlined == static_cast<int>(i)) color = scene::due_color;
        if (p.under == i && !p.finished) color = under_color;
        if (p.finished) color = view::verdict_color(lesson.joints[i].result);
        scene::outline_joint(world, i, color);
    }
    const bool wants_wrench = hint != nullptr && hint->arrow() == hints::Motion::take;
    scene::outline_tool(world, p.over_wrench ? under_color : wants_wrench ? scene::due_color : nothing);
    show_ghost(world, p, hint != nullptr ? hint->ghost() : hints::Ghost::none);
}

void view_system(scene::World& world, Frame& frame) {
    Playing& p = frame.playing;
    if (frame.wanted.wants(Action::whole_view))
        p.camera.go(
            view::framing(p.camera.goal, p.place.machine, static_cast<float>(frame.size.x / frame.size.y)));
    if (frame.wanted.wants(Action::find_view) || lost(p, frame)) look_at_work(p);
    (void)p.camera.advance(frame.seconds);
    const bool helps = p.course->lesson().mode != lesson::Mode::assessment;
    p.scene.cut_away.strength = 0.0F;
    if (p.hand.nut && p.hand.doing != Doing::resting && helps)
        scene::keep_in_sight(world, p.scene, p.course->setup(), p.course->state(), *p.hand.nut);
}

void label_system(scene::World&, Frame& frame) {
    Playing& p = frame.playing;
    const play::Course& course = *p.course;
    const servo::Setup& setup = course.setup();
    const servo::State& state = course.state();
    const lesson::Step* due = course.lesson().due();
    p.scene.labels.clear();
    // What a trainee at a real machine would not see is no part of an assessment.
    const bool helps = course.lesson().mode != lesson::Mode::assessment;
    if (frame.wanted.wants(Action::flange_map)) p.clamp_map = !p.clamp_map && helps;
    if (!p.finished)
        if (auto figure = scene::work_label(course.lesson(), setup, state, p.output, p.hand.wrench))
            p.scene.labels.push_back(*figure);
    const auto named = [&](std::size_t joint, const glm::vec4& color) {
        render::Label label = scene::plate(course.assembly().joints[joint].design.id,
                                           scene::above_nut(setup, state, joint), 16.0F);
        label.color = color;
        label.moved_px = {0.0F, 8.0F};
        p.scene.labels.push_back(label);
    };
    const bool guided = course.lesson().mode == lesson::Mode::guided;
    const std::size_t marked = due != nullptr && guided ? due->joint : SIZE_MAX;
    for (std::size_t i = 0; i < setup.nuts.size(); ++i) {
        if (p.clamp_map || p.finished)
            p.scene.labels.push_back(scene::clamp_label(course.assembly(), setup, state, i));
        else if (i == marked || p.under == i)
            named(i, i == marked ? scene::due_color : scene::label_color);
    }
    const Screen screen = screen_of(p, frame.size);
    if (frame.fonts != nullptr)
        view::move_apart(*frame.fonts, p.scene.labels, screen.eye, glm::vec2(frame.size));
}

void present_system(scene::World& world, Frame& frame) { scene::present(world, frame.playing.scene); }

}  // namespace bolt::trainer
