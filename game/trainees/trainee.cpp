#include "game/trainees/trainee.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "game/motion/path_planning.hpp"
#include "game/trainees/behaviour.hpp"

namespace bolt::trainees {

namespace {

using servo::Grip;

constexpr double frame_time = 1.0 / 60.0;  // s
constexpr double looks_within = 0.06;      // m from the nut, from where on it is being aligned
constexpr double worth_telling = 0.02;

// It takes hold, or did not get on: then it places the tool again and turns it a little, as anybody would.
void settle(Mind& m, const Pose& pose) {
    if (m.on_its_nut()) {
        m.stroke_begin = m.handle;
        m.nut_at_stroke = m.joint().nut.angle;

        m.misses = 0;
        m.enter(m.intent.fingers ? Phase::spin : Phase::pull);
    } else if (m.over()) {
        ++m.misses;
        if (m.obstacles() != nullptr && !m.intent.fingers) {
            lift_off(m, pose, 0.2);
            return;
        }
        m.placed = m.off_centre(0.7 * m.profile.position_noise);
        choose_grip_angle(m);
        m.enter(Phase::settle, 0.15);
    }
}

// As often as pictures come, while the wrench is in the hand: how much of the due nut is seen.
void look(Mind& m, const lesson::Step* due) {
    const auto frame = static_cast<std::uint64_t>(std::max(1.0, frame_time / m.setup->dt));
    if (due == nullptr || m.obstacles() == nullptr || !m.holds_wrench || m.state->tick % frame != 0) return;
    if (m.state->engagement.joint >= 0) return;
    const servo::NutGeometry& nut = m.setup->nuts[due->joint];
    if (glm::distance(m.hand.position, nut.seat) > looks_within) return;
    const double share = motion::nut_seen(m.sight, *m.obstacles(), due->joint, m.sight.eye);
    if (m.told_of == due->joint && std::abs(share - m.told) < worth_telling) return;
    m.told = share;
    m.told_of = due->joint;
    m.noticed.push_back({m.state->tick, "sight", static_cast<int>(due->joint), share,
                         fmt::format("{:.0f} % of the nut is seen", 100.0 * share)});
}

// Where the tool goes in this tick, and with which grip.
Pose move(Mind& m, const Feeling& felt, Grip& grip) {
    const Grip own = m.intent.fingers ? Grip::fingers : Grip::wrench;
    Pose pose = m.from;
    switch (m.phase) {
        case Phase::think:
            if (m.over()) decide(m);
            pose = m.from;
            break;
        case Phase::look:
            if (m.over()) set_off(m);
            pose = m.from;
            break;
        case Phase::fetch:
            pose = motion::along(m.from, m.to, motion::minimum_jerk(m.progress()), m.bulge);
            if (!m.over() || goes_on(m, Phase::fetch)) break;
            m.holds_wrench = !m.intent.fingers;
            m.enter(Phase::think, 0.2);
            break;
        case Phase::reach:
            pose = motion::along(m.from, m.to, motion::minimum_jerk(m.progress()), m.bulge);
            if (!m.over() || goes_on(m, Phase::reach)) break;
            m.enter(Phase::lower, m.profile.placing_time * m.random.uniform(0.8, 1.3));
            break;
        case Phase::lower:
            pose = motion::along(m.from, m.at_nut(0.0), motion::minimum_jerk(m.progress()), Vec3(0.0));
            if (m.over()) m.enter(Phase::settle, 0.12);
            break;
        case Phase::settle:
            grip = own;
            pose = m.at_nut(0.0);
            settle(m, pose);
            break;
        case Phase::pull:
            grip = own;
            pull(m, felt);
            pose = m.at_nut(0.0);
            if (!m.on_its_nut()) lift_off(m, pose, 0.3);  // it slipped off
            break;
        case Phase::ease:
            grip = own;
            ease(m);
            pose = m.at_nut(0.0);
            if (m.over()) lift_off(m, pose, 0.25);
            break;
        case Phase::lift: {
            pose = motion::along(m.from, m.to, motion::minimum_jerk(m.progress()), Vec3(0.0));
            if (!m.over()) break;
            m.from = m.to;
            const bool done = m.intent.finished || m.step_is_past();
            m.enter(Phase::think, done ? m.profile.pause * m.random.uniform(0.3, 1.7) : 0.05);
            break;
        }
        case Phase::spin:
            grip = own;
            spin(m, felt);
            pose = m.at_nut(0.0);
            break;
        case Phase::spin_back:
            spin_back(m);
            pose = m.at_nut(0.0);
            if (!m.over()) break;
            if (m.intent.finished || m.step_is_past())
                lift_off(m, pose, 0.3);
            else
                m.enter(Phase::settle, 0.05);
            break;
        case Phase::done:
            break;
    }
    return pose;
}

}  // namespace

Operator::Operator(const Profile& profile, std::uint64_t seed, const servo::Setup& setup,
                   motion::ViewHelp help)
    : mind_(std::make_unique<Mind>(profile, seed, setup)) {
    Mind& mind = *mind_;
    mind.view_help = std::move(help);
    Vec3 centre(0.0);
    for (const servo::NutGeometry& nut : setup.nuts)
        centre += nut.seat / static_cast<double>(setup.nuts.size());
    mind.from.position = centre + Vec3(0.0, 0.3, 0.4);  // the hand rests in front of the assembly
    mind.to = mind.rest = mind.hand = mind.from;
    mind.sight.eye = centre + Vec3(0.0, 0.45, 0.6);  // and the head above it
}

Operator::Operator(Operator&&) noexcept = default;
Operator& Operator::operator=(Operator&&) noexcept = default;
Operator::~Operator() = default;

servo::Input Operator::act(const servo::Setup& setup, const servo::State& state,
                           const lesson::Lesson& lesson) {
    Mind& m = *mind_;
    m.setup = &setup;
    m.state = &state;
    m.lesson = &lesson;
    // Where the lesson names views it begins in the first of them.
    if (m.time <= 0.0 && !lesson.assembly->views.empty()) m.sight.eye = lesson.assembly->views.front().eye;
    m.time += setup.dt;

    servo::Input input;
    input.enabled = true;
    const lesson::Step* due = lesson.due();
    if (due != nullptr && lesson.guides) input.guide = static_cast<std::int16_t>(due->joint);
    // What has hold of a nut stays; a hand in the air is moved by what it feels, and by nothing else.
    // While it still lowers the wrench the jaw may have the nut, but the hand does not hold yet.
    const bool grips = state.engagement.joint >= 0 && m.phase != Phase::lower;
    const bool takes = grips && !m.gripped;
    if (takes && m.on_its_nut()) take_hold(m);
    const force::OutputCommand output{state.output.output.force, state.output.output.torque};
    const double torque = felt_torque(setup.torque, m.nut(), m.hand.orientation * Vec3(1, 0, 0), output);
    const Feeling& felt = m.nerves.feel(grips ? torque : 0.0, m.handle, m.joint().nut.speed, grips,
                                        grips && state.engagement.swung > 0.0);
    Pose pose = move(m, felt, input.grip);
    if (m.phase != Phase::done) {
        pose.position += m.tremor.at(m.time) * m.profile.tremor;
        if (m.phase == Phase::pull) {
            const double sway = m.profile.tremor_torsion * m.tremor.torsion(m.time);
            pose.orientation = motion::orientation_of(m.nut(), m.handle + sway, m.flipped);
        }
    }
    // It changed its mind, not its place.
    if (grips != m.gripped || m.turned_back) take_up(m.arm, m.hand, pose);
    m.gripped = grips;
    m.turned_back = false;
    m.hand = follow(m.profile.hand, m.arm, pose, output, grips, setup.dt);
    if (m.obstacles() != nullptr && m.holds_wrench) {
        input.grip = Grip::wrench;
        if (m.obstacles()->in_hand) {
            const Pose& wrench = m.obstacles()->god_object.tool;
            notice_caught(m, pose, wrench);
            if (grips) m.hand = motion::give_way(m.hand, wrench);
        }
    }
    input.device = servo::sample_of(m.hand);
    look(m, due);
    return input;
}

std::vector<lesson::Event> Operator::take_noticed() { return std::exchange(mind_->noticed, {}); }

Result<session::Played> train(const content::Assembly& given, const TrainOptions& options,
                              const std::filesystem::path& file,
                              const std::function<bool(const Progress&)>& watch) {
    session::CourseOptions options_of_course = options.course;
    options_of_course.operator_name = options.trainee.name;
    options_of_course.view_help = options.view_help ? "on" : "off";
    Result<std::unique_ptr<session::Course>> begun = session::Course::begin(given, options_of_course, file);
    if (!begun) return fail(begun.error());
    session::Course& course = **begun;
    const double dt = options.course.dt;
    trainees::Operator trainee(options.trainee, options.course.seed, course.setup(), options.view_help);
    const auto second = static_cast<std::uint64_t>(std::lround(1.0 / dt));
    const auto last = static_cast<std::uint64_t>(options.longest / dt);
    const auto patience = static_cast<std::uint64_t>(options.patience / dt);
    const servo::State& state = course.state();
    const lesson::Lesson& lesson = course.lesson();
    std::size_t step = lesson.current;
    std::uint64_t since = 0;
    bool go_on = true;
    while (go_on && state.tick - since < patience && !course.over() && state.tick < last) {
        const servo::Input input = trainee.act(course.setup(), state, lesson);
        const Result<servo::Output> output = course.step(input, trainee.take_noticed());
        if (!output) return fail(output.error());
        Progress progress{course.time(), lesson.current, lesson.steps.size(), nullptr};
        for (const lesson::Event& event : course.events()) {
            progress.event = &event;
            go_on = watch(progress) && go_on;
            progress.event = nullptr;
        }
        if (lesson.current != step) {
            step = lesson.current;
            since = state.tick;
        }
        if (state.tick % second == 0) go_on = watch(progress) && go_on;
    }
    return course.finish();
}

}  // namespace bolt::trainees
