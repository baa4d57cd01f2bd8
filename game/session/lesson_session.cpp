#include "game/session/lesson_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "game/lesson/judge.hpp"
#include "game/lesson/law.hpp"
#include "game/lesson/step_requirements.hpp"
#include "game/session/session_file.hpp"
#include "game/tool_models/tool_model.hpp"

namespace bolt::session {

namespace {

servo::ToolDescription describe(const content::WrenchDesign& design) {
    const tool_models::GrippingHead gripping = tool_models::gripping_head(design);
    servo::ToolDescription tool;
    tool.head = gripping.head;
    tool.head_angle = gripping.head_angle;
    tool.twist_stiffness = gripping.twist_stiffness;
    tool.yield_torque = tool_models::yield_torque(design);
    tool.handle_length = design.handle_length;
    tool.click_swing = design.click_swing;
    tool.click_accuracy = design.click_accuracy;
    tool.adaptor_ratio = content::adaptor_ratio(design);
    return tool;
}

}  // namespace

servo::Setup make_setup(const content::Assembly& assembly, joint::Law law, const force::OutputLimits& limits,
                        std::uint64_t seed, double dt) {
    servo::SetupDescription description;
    std::vector<joint::JointDesign> designs;
    double highest_torque = 0.0;
    for (const content::AssemblyJoint& joint : assembly.joints) {
        designs.push_back(joint.design);
        description.published.push_back(joint.published.law);
        highest_torque = std::max(highest_torque, joint.spec.torque.high);
    }
    const content::FlangeDesign& f = assembly.flange;
    joint::FlangePlate plate;
    if (f.joints_interact)
        plate = joint::FlangePlate::make(f.thickness, f.E, f.poisson, f.interface_stiffness);

    description.joints = designs;
    description.law = law;
    description.flange = f.joints_interact ? &plate : nullptr;
    const content::LessonTools tools = content::lesson_tools(assembly);
    std::vector<servo::ToolDescription> tool_designs;
    for (const content::WrenchDesign* design : content::designs_of(assembly, tools))
        tool_designs.push_back(describe(*design));
    description.tool = tool_designs.front();
    description.more_tools.assign(tool_designs.begin() + 1, tool_designs.end());
    description.tool_of_joint = tools.of_joint;
    description.max_torque = highest_torque;
    description.limits = limits;
    description.seed = seed;
    description.dt = dt;
    return servo::make_setup(description);
}

Status pretighten(const content::Assembly& assembly, const servo::Setup& setup, servo::State& state) {
    constexpr double speed = to_radians(120.0);
    constexpr int max_steps = 4'000'000;
    for (const std::size_t i : assembly.passes.back().order) {
        const double target = assembly.joints[i].spec.torque.target;
        joint::JointState& joint = state.joints[i];
        int steps = 0;
        const bool into_yield = assembly.joints[i].spec.strategy == content::Strategy::yield;
        const auto tightened = [&] {
            return joint.torque >= target || (into_yield && joint.stage == joint::Stage::yield);
        };
        while (!tightened() && joint.condition == joint::JointCondition::intact && ++steps < max_steps) {
            const bool contact = joint.stage != joint::Stage::navigation;
            const double step = (contact ? 0.1 : 1.0) * speed * setup.dt;
            joint::turn_nut(setup.group, state.joints, i, joint.nut.angle + step, 1.0, setup.dt);
        }
        if (!tightened())
            return fail(ErrorCode::bad_content,
                        fmt::format("joint {} cannot be tightened to {:.1f} N·m: it is {}",
                                    assembly.joints[i].design.id, target, joint::name(joint.condition)),
                        "a target torque that the joint bears");
        joint.nut.speed = 0.0;
    }
    for (double rest = 0.0; rest < 10.0; rest += setup.dt)
        joint::step_group(setup.group, state.joints, -1, joint::NutDrive{}, setup.dt);
    return {};
}

Header make_header(const SessionSetup& start, const LessonOptions& options) {
    const content::Assembly& assembly = start.assembly;
    Header header;
    header.guiding_force = options.guiding_force && options.mode == lesson::Mode::guided;
    header.view_help = options.view_help;
    header.contact_models = start.contact_models;
    header.obstacle_names = start.obstacle_names;
    header.device_limits = options.device_limits;
    header.servo_rate = options.servo_rate;
    header.assembly = assembly.name;
    header.assembly_file = assembly.file;
    header.assembly_text = assembly.text;
    header.variant = assembly.variant;
    header.tool = assembly.tool;
    header.law = options.law;
    header.mode = options.mode;
    header.task = options.task;
    header.trainee_profile = options.trainee_profile;
    header.trainee = options.trainee;
    header.hand = options.hand;

    header.seed = options.seed;
    header.dt = options.dt;
    header.program = "boltwright " BOLTWRIGHT_VERSION;
    if (!options.continues) return header;
    for (const std::uint64_t ticks : options.continues->header.continued_after)
        if (ticks < options.continues->ticks) header.continued_after.push_back(ticks);
    header.continued_after.push_back(options.continues->ticks);
    return header;
}

namespace {

Result<std::optional<ContactModels>> obstacles_of(const content::Assembly& assembly,
                                                  const servo::Setup& setup, ObstacleUse obstacles) {
    if (obstacles == ObstacleUse::none) return std::nullopt;
    Result<std::optional<ContactModels>> models = load_contact_models(assembly, setup);
    if (models && !models->has_value() && obstacles == ObstacleUse::required)
        return fail(*missing_contact_model(assembly));
    return models;
}

// Compares the outputs bit by bit, also the members that the session file does not store. Forces, torques,
// nut angle and clamp force are compared in the single precision of the file.
bool same_tick(const servo::TickInput& input, const servo::Output& a, const servo::Output& b) {
    return same_output(make_record(input, a), make_record(input, b)) &&
           std::memcmp(&a.constrained_tool, &b.constrained_tool, sizeof a.constrained_tool) == 0 &&
           a.slipped == b.slipped && a.clicked == b.clicked && a.undone == b.undone &&
           std::memcmp(&a.rounded, &b.rounded, sizeof a.rounded) == 0;
}

}  // namespace

void haptic_system(const world::WriteHaptics& world, TickContext& tick) {
    world::write_haptics(world, tick.servo);
    world::turn_ratchet_head(world, tick.setup, tick.servo);
}

void lesson_system(const world::WriteHaptics& world, TickContext& tick) {
    LessonTracker& tracker = tick.tracker;
    lesson::Lesson& lesson = tracker.lesson;
    lesson::observe(lesson, world);
    for (const lesson::LessonEvent& event : lesson.events)
        tracker.expected_checkpoints += event.kind == lesson::EventKind::step_begin ? 1U : 0U;
    const lesson::ToolReading reading = lesson::tool_reading(lesson, world);
    world.only<world::ToolState>().displayed = reading.value;
    world.only<world::ToolState>().target = reading.target;
    const std::uint8_t undone = tick.servo.output.undone;
    if (undone == 0) return;
    const std::uint32_t saved = tick.servo.state.checkpoint_count;
    const std::uint32_t unsaved = tracker.expected_checkpoints - (saved + undone - 1U);
    // The last checkpoint belongs to the due step, or to the last step once all are done.
    const std::uint32_t done = lesson.due() == nullptr ? 1U : 0U;
    (void)lesson::undo_steps(lesson, world, undone - 1U + unsaved + done);
    tracker.expected_checkpoints = saved;  // the last one is that of the step that is due again
}

LessonSession::~LessonSession() = default;

namespace {

servo::Setup make_lesson_setup(const content::Assembly& assembly, const LessonOptions& options) {
    servo::Setup setup = make_setup(assembly, options.law, options.device_limits, options.seed, options.dt);
    servo::set_ratchets(setup, options.task == lesson::Task::loosen);
    setup.rounds_all_loaded_corners = options.rules.rounds_all_loaded_corners;
    setup.allows_narrow_gaps = options.rules.allows_narrow_gaps;
    setup.renders_tool_in_use = options.rules.renders_tool_in_use;
    const bool yields =
        options.rules.tools_yield == ToolYield::all_laws ||
        (options.rules.tools_yield == ToolYield::mechanistic_law && options.law == joint::Law::mechanistic);
    if (!yields) servo::disable_tool_yield(setup);
    if (options.rules.tools_yield != ToolYield::all_laws) return setup;
    const auto designs = content::designs_of(assembly, content::lesson_tools(assembly));
    for (std::size_t i = 0; i < designs.size(); ++i)
        setup.tools[i].wrench.yield_torque =
            tool_models::yield_torque(*designs[i], tool_models::KeyStrength::first_yield);
    setup.wrench.yield_torque = setup.tools[setup.tool].wrench.yield_torque;
    return setup;
}

// Fails if the tool of a joint cannot turn it.
Status check_turned_parts(const content::Assembly& assembly) {
    for (const content::AssemblyJoint& joint : assembly.joints) {
        const auto head = content::tool_of(assembly, joint).head;
        const bool turns_sockets =
            head == content::ToolHeadKind::hex_key || head == content::ToolHeadKind::hex_bit;
        const joint::TurnedPartSize part = joint::turned_part_size(joint.design);
        if ((part.depth > 0.0) == turns_sockets) continue;
        Error error;
        error.code = ErrorCode::bad_content;
        error.file = assembly.file;
        error.what = fmt::format("joint {} has a {}, which the tool \"{}\" cannot turn", joint.design.id,
                                 part.depth > 0.0 ? "socket head" : "hexagon",
                                 joint.tool.empty() ? assembly.tool : joint.tool);
        error.expected =
            part.depth > 0.0
                ? fmt::format("a hex_key of {:g} mm, or a ratchet with a hex_bit", part.across_flats / mm)
                : fmt::format("an open end, ring or socket of {:g} mm", part.across_flats / mm);
        return fail(std::move(error));
    }
    return {};
}

}  // namespace

Result<SessionSetup> prepare_session(const content::Assembly& given, const LessonOptions& options) {
    BOLT_TRY(check_turned_parts(given));
    SessionSetup start;
    start.assembly = lesson::apply_law(given, options.law, options.rules.law_adaptation);
    start.setup = make_lesson_setup(start.assembly, options);
    start.state = servo::initial_state(start.setup);
    if (options.task == lesson::Task::loosen) {
        BOLT_TRY(pretighten(start.assembly, start.setup, start.state));
    }
    BOLT_TRY_ASSIGN(auto models, obstacles_of(start.assembly, start.setup, options.obstacles));
    if (!models.has_value()) return start;
    start.contact_models = models->files;
    start.obstacle_names = std::move(models->names);
    start.state.tool_contact = std::move(models->tool_contact);
    return start;
}

void set_device_limits(const LessonOptions& options, SessionSetup& start) {
    start.setup = make_lesson_setup(start.assembly, options);
    if (start.state.tool_contact) servo::set_coupling(start.setup, *start.state.tool_contact);
}

Result<std::unique_ptr<LessonSession>> LessonSession::begin(const content::Assembly& given,
                                                            const LessonOptions& options,
                                                            const std::filesystem::path& file) {
    BOLT_TRY_ASSIGN(auto start, prepare_session(given, options));
    return begin(std::move(start), options, file);
}

Result<std::unique_ptr<LessonSession>> LessonSession::begin(SessionSetup start, const LessonOptions& options,
                                                            const std::filesystem::path& file) {
    std::unique_ptr<LessonSession> session(new LessonSession);
    LessonSession& s = *session;
    s.session_setup_ = std::move(start);
    BOLT_TRY_ASSIGN(auto created, SessionWriter::create(file, make_header(s.session_setup_, options)));
    s.writer_.emplace(std::move(created));

    lesson::Lesson& lesson = s.tracker_.lesson;
    lesson = lesson::begin(s.session_setup_.assembly, options.mode, options.task);
    lesson.guides = lesson.guides && options.guiding_force;
    world::World initial;
    world::add_haptics(initial, s.session_setup_.state);
    for (std::size_t i = 0; i < lesson.joints.size(); ++i)
        BOLT_TRY(s.writer_->update(lesson::judge_joint(lesson, i, initial)));
    return session;
}

Status LessonSession::record_events(const world::ReadHaptics& world) {
    for (const lesson::LessonEvent& event : events_) {
        BOLT_TRY(writer_->add(event));
        if (event.kind != lesson::EventKind::step_end && event.kind != lesson::EventKind::release) continue;
        const auto joint = static_cast<std::size_t>(event.joint);
        BOLT_TRY(writer_->update(lesson::judge_joint(lesson(), joint, world)));
    }
    return {};
}

Result<servo::Output> LessonSession::tick(const world::WriteHaptics& world, const servo::TickInput& given,
                                          std::vector<lesson::LessonEvent> extra_events) {
    servo::TickInput input = given;
    const auto undo = std::exchange(requested_undo_, std::nullopt);
    input.checkpoint_action = target_checkpoints() != checkpoints_saved_ ? servo::save_checkpoint
                              : undo                                     ? restore_action(*undo)
                                                                         : std::uint8_t{0};
    input.set_torque = static_cast<float>(lesson::wrench_set_torque(lesson()));
    return compute_tick(world, input, std::move(extra_events));
}

std::uint8_t LessonSession::due_tool() const {
    const lesson::LessonStep* due = lesson().due();
    return static_cast<std::uint8_t>(due != nullptr ? setup().nuts[due->joint].tool : setup().tool);
}

std::uint8_t LessonSession::restore_action(std::size_t steps) const {
    const lesson::Lesson& l = lesson();
    const std::size_t checkpoints = steps + (finished() ? 0 : 1);  // as in lesson_system()
    const bool allowed =
        l.mode != lesson::Mode::assessment && checkpoints <= servo::max_checkpoints && steps <= l.current;
    return allowed ? static_cast<std::uint8_t>(checkpoints) : std::uint8_t{0};
}

Status LessonSession::repeat(const world::WriteHaptics& world, const servo::TickInput& input,
                             const servo::Output& output) {
    BOLT_TRY_ASSIGN(const auto again, compute_tick(world, input, {}));
    if (same_tick(input, again, output)) return {};
    return fail(ErrorCode::failed,
                fmt::format("at {:.3f} s the station and the recording of the lesson computed different "
                            "results from the same inputs",
                            time()),
                "equal results; the lesson is saved up to this time");
}

Result<servo::Output> LessonSession::compute_tick(const world::WriteHaptics& world,
                                                  const servo::TickInput& input,
                                                  std::vector<lesson::LessonEvent>&& extra_events) {
    servo::change_tool(session_setup_.setup, session_setup_.state, input);
    const servo::Output output = servo::tick(session_setup_.setup, session_setup_.state, input);
    checkpoints_saved_ += input.checkpoint_action == servo::save_checkpoint ? 1U : 0U;
    TickContext context{{session_setup_.state, input, output}, session_setup_.setup, tracker_};
    ecs::run(tick_systems, world, context);
    events_.clear();
    std::swap(events_, tracker_.lesson.events);
    for (lesson::LessonEvent& event : extra_events) events_.push_back(std::move(event));
    BOLT_TRY(writer_->append(make_record(input, output)));
    if (!events_.empty()) BOLT_TRY(record_events(world));  // rarely: saves most ticks an empty Status
    return output;
}

LessonOutcome LessonSession::outcome(const world::ReadHaptics& world) const {
    return {lesson::judge(lesson(), world, session_setup_.setup.dt),
            session_setup_.state.tool_contact.has_value()};
}

Result<LessonOutcome> LessonSession::finish(const world::ReadHaptics& world) {
    LessonOutcome result = outcome(world);
    BOLT_TRY(writer_->finish(result.result));
    return result;
}

}  // namespace bolt::session
