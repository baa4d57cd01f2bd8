#include "game/viewer/recording.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::viewer {

namespace {

constexpr double shortest_period = 0.02;    // s
constexpr std::size_t max_states = 50'000;  // bounds the memory of a long session

std::vector<TimelineMark> marks_of(const std::vector<lesson::LessonEvent>& events, double dt) {
    std::vector<TimelineMark> marks;
    for (const lesson::LessonEvent& event : events)
        if (event.kind == lesson::EventKind::step_begin || event.kind == lesson::EventKind::mistake)
            marks.push_back({static_cast<double>(event.tick) * dt, event.joint,
                             event.kind == lesson::EventKind::mistake, event, std::nullopt});
    return marks;
}

// Adds the explanations of the mistakes of this tick.
void explain_mistakes(std::vector<TimelineMark>& marks, const session::ReplayTick& tick) {
    for (const lesson::LessonEvent& event : tick.lesson.events) {
        if (event.kind != lesson::EventKind::mistake) continue;
        for (TimelineMark& mark : marks)
            if (mark.mistake && mark.event.tick == event.tick && mark.joint == event.joint &&
                mark.event.text == event.text)
                mark.explanation = lesson::mistake_of(tick.lesson, event);
    }
}

}  // namespace

std::size_t Recording::index_at(double time) const {
    const double index = std::round(std::max(time, 0.0) / period);
    return std::min(static_cast<std::size_t>(index), states.size() - 1);
}

const TimelineMark* Recording::chapter_at(double time) const {
    const TimelineMark* chapter = nullptr;
    for (const TimelineMark& mark : marks)
        if (!mark.mistake && mark.time <= time) chapter = &mark;
    return chapter;
}

double Recording::neighbouring_chapter(double time, int by) const {
    double before = 0.0;
    for (const TimelineMark& mark : marks) {
        if (mark.mistake) continue;
        if (by > 0 && mark.time > time + 1e-9) return mark.time;
        if (mark.time < time - 1.0) before = mark.time;
    }
    return by > 0 ? duration() : before;
}

Result<std::unique_ptr<Recording>> replay_session(const session::SessionReader& session) {
    auto recording = std::make_unique<Recording>();
    if (session.tick_count() == 0)
        return fail(ErrorCode::failed, session.file() + ": the session has no tick",
                    "a session with a lesson");
    BOLT_TRY_ASSIGN(auto data, analysis::read_session(session));
    recording->data = std::move(data);
    BOLT_TRY_ASSIGN(auto events, session.events());
    const double dt = session.header().dt;
    recording->marks = marks_of(events, dt);
    BOLT_TRY_ASSIGN(auto shown, session::restore_setup(session));
    recording->start = std::move(shown);
    BOLT_TRY_ASSIGN(auto replayed, session::restore_setup(session));

    const double duration = static_cast<double>(session.tick_count()) * dt;
    recording->period = std::max(shortest_period, duration / static_cast<double>(max_states));
    world::World world;
    world::add_haptics(world, replayed.state);
    recording->states.push_back(state_of(world));
    recording->lesson_index.push_back(0);
    const auto keep_lesson = [&](const lesson::Lesson& lesson) {
        recording->lessons.push_back(lesson);
        recording->lessons.back().assembly = &recording->start.assembly;
        recording->lessons.back().events.clear();
        recording->lessons.back().step_starts.clear();
    };
    BOLT_TRY_ASSIGN(
        const auto result,
        session::replay(session, std::move(replayed), world, [&](const session::ReplayTick& tick) {
            const auto changes_step = [](const lesson::LessonEvent& event) {
                return event.kind == lesson::EventKind::step_begin ||
                       event.kind == lesson::EventKind::step_end || event.kind == lesson::EventKind::undo;
            };
            explain_mistakes(recording->marks, tick);
            const std::vector<lesson::LessonEvent>& events_now = tick.lesson.events;
            if (recording->lessons.empty() || std::any_of(events_now.begin(), events_now.end(), changes_step))
                keep_lesson(tick.lesson);
            if (tick.time + 0.5 * dt >= static_cast<double>(recording->states.size()) * recording->period) {
                recording->states.push_back(state_of(world));
                recording->lesson_index.push_back(recording->lessons.size() - 1);
            }
            return true;
        }));
    recording->mismatches = result.mismatches;
    return recording;
}

RecordedState state_of(const world::ReadHaptics& world) {
    RecordedState state{world.only<world::ServoClock>(),
                        world.only<world::ConstrainedTool>(),
                        world.only<world::ToolState>(),
                        world.only<world::GuidingForce>(),
                        world.only<world::DeviceForce>(),
                        world.only<world::WorkingHand>(),
                        {}};
    world.view<const world::Joint>().each([&](const world::Joint& joint) {
        if (state.joints.size() <= joint.index) state.joints.resize(joint.index + 1);
        state.joints[joint.index] = joint;
    });
    return state;
}

void write_state(const world::WriteHaptics& world, const RecordedState& state) {
    world.only<world::ServoClock>() = state.clock;
    world.only<world::ConstrainedTool>() = state.tool;
    world.only<world::ToolState>() = state.contact;
    world.only<world::GuidingForce>() = state.guiding;
    world.only<world::DeviceForce>() = state.force;
    world::WorkingHand& hand = world.only<world::WorkingHand>();
    const Pose rest = hand.rest;
    hand = state.hand;
    hand.rest = rest;
    world.view<world::Joint>().each([&](world::Joint& joint) { joint = state.joints[joint.index]; });
}

}  // namespace bolt::viewer
