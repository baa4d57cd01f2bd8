#include "game/session/lesson_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "game/session/session_file.hpp"

namespace bolt::session {

servo::Setup make_setup(const content::Assembly& assembly, joint::Law law, const force::OutputLimits& limits,
                        std::uint64_t seed, double dt) {
    std::vector<joint::JointDesign> designs;
    double greatest = 0.0;
    for (const content::AssemblyJoint& joint : assembly.joints) {
        designs.push_back(joint.design);
        greatest = std::max(greatest, joint.spec.torque.high);
    }
    const content::FlangeDesign& f = assembly.flange;
    joint::FlangePlate plate;
    if (f.coupled) plate = joint::FlangePlate::make(f.thickness, f.E, f.poisson, f.interface_stiffness);

    servo::SetupDescription description;
    description.joints = designs;
    description.law = law;
    description.published = assembly.published;
    description.flange = f.coupled ? &plate : nullptr;
    description.jaw = assembly.wrench.jaw;
    description.head_thickness = assembly.wrench.head_thickness;
    description.jaw_throat = assembly.wrench.jaw_depth;
    description.jaw_tip = assembly.wrench.jaw_tip;
    description.head_angle = assembly.wrench.head_angle;
    description.handle_length = assembly.wrench.handle_length;
    description.greatest_torque = greatest;
    description.click_swing = assembly.wrench.click_swing;
    description.click_accuracy = assembly.wrench.click_accuracy;
    description.limits = limits;
    description.seed = seed;
    description.dt = dt;
    return servo::make_setup(description);
}

Status pretighten(const content::Assembly& assembly, const servo::Setup& setup, servo::State& state) {
    constexpr double speed = to_radians(120.0);
    constexpr int longest = 4'000'000;
    for (const std::size_t i : assembly.passes.back().order) {
        const double target = assembly.joints[i].spec.torque.target;
        joint::JointState& joint = state.joints[i];
        int steps = 0;
        // Into yield as the specification has it: where the yield stage begins, and not on to a torque.
        const bool into_yield = assembly.joints[i].spec.strategy == content::Strategy::yield;
        const auto tight = [&] {
            return joint.torque >= target || (into_yield && joint.stage == joint::Stage::yield);
        };
        while (!tight() && joint.condition == joint::Condition::sound && ++steps < longest) {
            const bool near = joint.stage != joint::Stage::navigation;
            const double step = (near ? 0.1 : 1.0) * speed * setup.dt;
            joint::turn_nut(setup.group, state.joints, i, joint.nut.angle + step, 1.0, setup.dt);
        }
        if (!tight())
            return fail(ErrorCode::bad_content,
                        fmt::format("joint {} cannot be tightened to {:.1f} N·m: it is {}",
                                    assembly.joints[i].design.id, target, joint::name(joint.condition)));
        joint.nut.speed = 0.0;
    }
    for (double rest = 0.0; rest < 10.0; rest += setup.dt)
        joint::step_group(setup.group, state.joints, -1, joint::Handle{}, setup.dt);
    return {};
}

namespace {

session::Header header_of(const Prepared& at, const CourseOptions& options) {
    const content::Assembly& assembly = at.assembly;
    session::Header header;
    header.guide = options.guide && options.mode == lesson::Mode::guided ? "on" : "off";
    header.view_help = options.view_help;
    header.obstacles = at.obstacles;
    header.obstacle_names = at.obstacle_names;
    header.device = session::text_of(options.device);
    header.servo = options.servo;
    header.assembly = assembly.name;
    header.assembly_file = assembly.file;
    header.assembly_text = assembly.text;
    header.variant = assembly.variant;
    header.tool = assembly.tool;
    header.law = joint::name(options.law);
    header.mode = lesson::name(options.mode);
    header.task = lesson::name(options.task);
    header.operator_name = options.operator_name;
    header.trainee = options.trainee;
    header.hand = options.hand;

    header.seed = options.seed;
    header.dt = options.dt;
    header.program = "boltwright " BOLTWRIGHT_VERSION;
    return header;
}

Result<std::optional<TouchModels>> obstacles_of(const content::Assembly& assembly, const servo::Setup& setup,
                                                Obstacles wanted) {
    if (wanted == Obstacles::none) return std::nullopt;
    Result<std::optional<TouchModels>> models = load_touch_models(assembly, setup);
    if (models && !models->has_value() && wanted == Obstacles::required)
        return fail(*missing_contact_model(assembly));
    return models;
}

// Compares all bits of the outputs, also those that the session file does not store.
bool same(const servo::Input& input, const servo::Output& a, const servo::Output& b) {
    return session::same_output(session::make_record(input, a), session::make_record(input, b)) &&
           std::memcmp(&a.tool, &b.tool, sizeof a.tool) == 0 && a.slipped == b.slipped &&
           a.clicked == b.clicked && a.undone == b.undone &&
           std::memcmp(&a.rounded, &b.rounded, sizeof a.rounded) == 0;
}

}  // namespace

void follow(LessonTracker& tracker, const servo::State& state, const servo::Output& output) {
    lesson::Lesson& lesson = tracker.lesson;
    lesson::observe(lesson, state, output);
    for (const lesson::Event& event : lesson.events) tracker.begun += event.kind == "step_begin" ? 1U : 0U;
    if (output.undone == 0) return;
    const std::uint32_t unmarked = tracker.begun - (state.checkpoint_count + output.undone - 1U);
    // The last checkpoint belongs to the due step, or to the last step once all are done.
    const std::uint32_t done = lesson.due() == nullptr ? 1U : 0U;
    (void)lesson::back(lesson, state, output.undone - 1U + unmarked + done);
    tracker.begun = state.checkpoint_count;  // the step it returned to has its checkpoint
}

Course::~Course() = default;

Result<Prepared> prepare(const content::Assembly& given, const CourseOptions& options) {
    Prepared at;
    at.assembly = lesson::under_law(given, options.law);
    at.setup = make_setup(at.assembly, options.law, options.device, options.seed, options.dt);
    at.state = servo::initial_state(at.setup);
    if (options.task == lesson::Task::loosen) {
        BOLT_TRY(pretighten(at.assembly, at.setup, at.state));
    }
    BOLT_TRY_ASSIGN(auto models, obstacles_of(at.assembly, at.setup, options.obstacles));
    if (!models.has_value()) return at;
    at.obstacles = models->files;
    at.obstacle_names = std::move(models->names);
    at.state.tool_contact = std::move(models->tool_contact);
    return at;
}

void use_device(const CourseOptions& options, Prepared& at) {
    at.setup = make_setup(at.assembly, options.law, options.device, options.seed, options.dt);
    if (at.state.tool_contact) servo::set_coupling(at.setup, *at.state.tool_contact);
}

Result<std::unique_ptr<Course>> Course::begin(const content::Assembly& given, const CourseOptions& options,
                                              const std::filesystem::path& file) {
    BOLT_TRY_ASSIGN(auto prepared, prepare(given, options));
    return begin(std::move(prepared), options, file);
}

Result<std::unique_ptr<Course>> Course::begin(Prepared prepared, const CourseOptions& options,
                                              const std::filesystem::path& file) {
    std::unique_ptr<Course> course(new Course);
    Course& c = *course;
    c.at_ = std::move(prepared);
    BOLT_TRY_ASSIGN(auto created, session::Writer::create(file, header_of(c.at_, options)));
    c.writer_.emplace(std::move(created));

    lesson::Lesson& lesson = c.tracker_.lesson;
    lesson = lesson::begin(c.at_.assembly, options.mode, options.task);
    lesson.guides = lesson.guides && options.guide;
    for (std::size_t i = 0; i < lesson.joints.size(); ++i) {
        BOLT_TRY(c.writer_->update(lesson::judge_joint(lesson, i, c.at_.state)));
    }
    return course;
}

Status Course::keep_events() {
    for (const lesson::Event& event : events_) {
        BOLT_TRY(writer_->add(event));
        if (event.kind != "step_end" && event.kind != "release") continue;
        const auto joint = static_cast<std::size_t>(event.joint);
        BOLT_TRY(writer_->update(lesson::judge_joint(lesson(), joint, at_.state)));
    }
    return {};
}

Result<servo::Output> Course::step(const servo::Input& given, std::vector<lesson::Event> noticed) {
    servo::Input input = given;
    const auto back = std::exchange(back_, std::nullopt);
    input.undo = marks() != kept_ ? servo::save_checkpoint : back ? undo_by(*back) : std::uint8_t{0};
    input.setting = static_cast<float>(lesson::setting(lesson()));
    return tick(input, std::move(noticed));
}

std::uint8_t Course::undo_by(std::size_t steps) const {
    const lesson::Lesson& l = lesson();
    const std::size_t marks = steps + (over() ? 0 : 1);  // as in follow()
    const bool may =
        l.mode != lesson::Mode::assessment && marks <= servo::max_checkpoints && steps <= l.current;
    return may ? static_cast<std::uint8_t>(marks) : std::uint8_t{0};
}

Status Course::take(const servo::Input& input, const servo::Output& output,
                    std::vector<lesson::Event> noticed) {
    BOLT_TRY_ASSIGN(const auto again, tick(input, std::move(noticed)));
    if (same(input, again, output)) return {};
    return fail(ErrorCode::failed,
                fmt::format("at {:.3f} s the servo and the lesson got different outputs from the same inputs",
                            time()),
                "equal bits; the recording until then is kept");
}

Result<servo::Output> Course::tick(const servo::Input& input, std::vector<lesson::Event>&& noticed) {
    const servo::Output output = servo::tick(at_.setup, at_.state, input);
    kept_ += input.undo == servo::save_checkpoint ? 1U : 0U;
    follow(tracker_, at_.state, output);
    events_.clear();
    std::swap(events_, tracker_.lesson.events);
    for (lesson::Event& seen : noticed) events_.push_back(std::move(seen));
    BOLT_TRY(writer_->append(session::make_record(input, output)));
    BOLT_TRY(keep_events());
    return output;
}

Played Course::judged() const {
    return {lesson::judge(lesson(), at_.state, at_.setup.dt), at_.state.tool_contact.has_value()};
}

Result<Played> Course::finish() {
    Played played = judged();
    BOLT_TRY(writer_->finish(played.result));
    return played;
}

}  // namespace bolt::session
