#include "game/play/course.hpp"

#include <fmt/format.h>

#include <cstring>
#include <utility>

#include "game/play/servo_setup.hpp"
#include "game/record/device_text.hpp"

namespace bolt::play {

namespace {

record::Header header_of(const Prepared& at, const CourseOptions& options) {
    const content::Assembly& assembly = at.assembly;
    record::Header header;
    header.guide = options.guide && options.mode == lesson::Mode::guided ? "on" : "off";
    header.view_help = options.view_help;
    header.obstacles = at.obstacles;
    header.obstacle_names = at.obstacle_names;
    header.device = record::text_of(options.device);
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
    if (models && !models->has_value() && wanted == Obstacles::required) {
        Error none;
        none.code = ErrorCode::bad_content;
        none.what = "the assembly names no contact model, or its tool no model";
        none.expected = "expected both: they are the obstacles and what meets them";
        none.file = assembly.file;
        return fail(none);
    }
    return models;
}

// To the bit, also what no session keeps.
bool same(const servo::Input& input, const servo::Output& a, const servo::Output& b) {
    return record::same_output(record::make_record(input, a), record::make_record(input, b)) &&
           std::memcmp(&a.tool, &b.tool, sizeof a.tool) == 0 && a.slipped == b.slipped &&
           a.clicked == b.clicked && a.undone == b.undone &&
           std::memcmp(&a.rounded, &b.rounded, sizeof a.rounded) == 0;
}

}  // namespace

void follow(Following& following, const servo::State& state, const servo::Output& output) {
    lesson::Lesson& lesson = following.lesson;
    lesson::observe(lesson, state, output);
    for (const lesson::Event& event : lesson.events) following.begun += event.kind == "step_begin" ? 1U : 0U;
    if (output.undone == 0) return;
    const std::uint32_t unmarked = following.begun - (state.marked + output.undone - 1U);
    // The last mark is the due step's, or, once all is done, the last step's.
    const std::uint32_t done = lesson.due() == nullptr ? 1U : 0U;
    (void)lesson::back(lesson, state, output.undone - 1U + unmarked + done);
    following.begun = state.marked;  // what it has gone back to has its mark
}

Course::~Course() = default;

Result<Prepared> prepare(const content::Assembly& given, const CourseOptions& options) {
    Prepared at;
    at.assembly = lesson::under_law(given, options.law);
    at.setup = make_setup(at.assembly, options.law, options.device, options.seed, options.dt);
    at.state = servo::initial_state(at.setup);
    if (options.task == lesson::Task::loosen)
        if (Status tight = pretighten(at.assembly, at.setup, at.state); !tight) return fail(tight.error());
    Result<std::optional<TouchModels>> models = obstacles_of(at.assembly, at.setup, options.obstacles);
    if (!models) return fail(models.error());
    if (!models->has_value()) return at;
    at.obstacles = (*models)->files;
    at.obstacle_names = std::move((*models)->names);
    at.state.touch = std::move((*models)->touch);
    return at;
}

void use_device(const CourseOptions& options, Prepared& at) {
    at.setup = make_setup(at.assembly, options.law, options.device, options.seed, options.dt);
    if (at.state.touch) servo::set_coupling(at.setup, *at.state.touch);
}

Result<std::unique_ptr<Course>> Course::begin(const content::Assembly& given, const CourseOptions& options,
                                              const std::filesystem::path& file) {
    Result<Prepared> prepared = prepare(given, options);
    if (!prepared) return fail(prepared.error());
    return begin(std::move(*prepared), options, file);
}

Result<std::unique_ptr<Course>> Course::begin(Prepared prepared, const CourseOptions& options,
                                              const std::filesystem::path& file) {
    std::unique_ptr<Course> course(new Course);
    Course& c = *course;
    c.at_ = std::move(prepared);
    Result<record::Writer> created = record::Writer::create(file, header_of(c.at_, options));
    if (!created) return fail(created.error());
    c.writer_.emplace(std::move(*created));

    lesson::Lesson& lesson = c.following_.lesson;
    lesson = lesson::begin(c.at_.assembly, options.mode, options.task);
    lesson.guides = lesson.guides && options.guide;
    for (std::size_t i = 0; i < lesson.joints.size(); ++i)
        if (Status kept = c.writer_->update(lesson::judge_joint(lesson, i, c.at_.state)); !kept)
            return fail(kept.error());
    return course;
}

Status Course::keep_events() {
    for (const lesson::Event& event : events_) {
        if (Status added = writer_->add(event); !added) return added;
        if (event.kind != "step_end" && event.kind != "release") continue;
        const auto joint = static_cast<std::size_t>(event.joint);
        if (Status kept = writer_->update(lesson::judge_joint(lesson(), joint, at_.state)); !kept)
            return kept;
    }
    return {};
}

Result<servo::Output> Course::step(const servo::Input& given, std::vector<lesson::Event> noticed) {
    servo::Input input = given;
    const auto back = std::exchange(back_, std::nullopt);
    input.undo = marks() != kept_ ? servo::keep_mark : back ? undo_by(*back) : std::uint8_t{0};
    input.setting = static_cast<float>(lesson::setting(lesson()));
    return tick(input, std::move(noticed));
}

std::uint8_t Course::undo_by(std::size_t steps) const {
    const lesson::Lesson& l = lesson();
    const std::size_t marks = steps + (over() ? 0 : 1);  // as in follow()
    const bool may = l.mode != lesson::Mode::assessment && marks <= servo::most_marks && steps <= l.current;
    return may ? static_cast<std::uint8_t>(marks) : std::uint8_t{0};
}

Status Course::take(const servo::Input& input, const servo::Output& output,
                    std::vector<lesson::Event> noticed) {
    const Result<servo::Output> again = tick(input, std::move(noticed));
    if (!again) return fail(again.error());
    if (same(input, *again, output)) return {};
    return fail(ErrorCode::failed,
                fmt::format("at {:.3f} s the servo came to something else than the lesson did with the same "
                            "inputs",
                            time()),
                "the same to the bit; what was recorded until then is kept");
}

Result<servo::Output> Course::tick(const servo::Input& input, std::vector<lesson::Event>&& noticed) {
    const servo::Output output = servo::tick(at_.setup, at_.state, input);
    kept_ += input.undo == servo::keep_mark ? 1U : 0U;
    follow(following_, at_.state, output);
    events_.clear();
    std::swap(events_, following_.lesson.events);
    for (lesson::Event& seen : noticed) events_.push_back(std::move(seen));
    if (Status kept = writer_->append(record::make_record(input, output)); !kept) return fail(kept.error());
    if (Status kept = keep_events(); !kept) return fail(kept.error());
    return output;
}

Played Course::judged() const {
    return {lesson::judge(lesson(), at_.state, at_.setup.dt), at_.state.touch.has_value()};
}

Result<Played> Course::finish() {
    Played played = judged();
    if (Status finished = writer_->finish(played.result); !finished) return fail(finished.error());
    return played;
}

}  // namespace bolt::play
