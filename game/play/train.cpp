#include "game/play/train.hpp"

#include <cmath>

#include "game/operators/operator.hpp"
#include "game/play/servo_setup.hpp"
#include "game/play/touch_models.hpp"
#include "game/record/device_text.hpp"
#include "game/record/session.hpp"

namespace bolt::play {

namespace {

record::Header header_of(const content::Assembly& assembly, const TrainOptions& options,
                         const force::OutputLimits& device, const std::optional<TouchModels>& models) {
    record::Header header;
    header.guide = options.guide && options.mode == lesson::Mode::guided ? "on" : "off";
    header.obstacles = models ? models->files : "none";
    if (models) header.obstacle_names = models->names;
    header.device = record::text_of(device);
    header.servo = "virtual time";
    header.assembly = assembly.name;
    header.assembly_file = assembly.file;
    header.assembly_text = assembly.text;
    header.variant = assembly.variant;
    header.law = joint::name(options.law);
    header.mode = lesson::name(options.mode);
    header.task = lesson::name(options.task);
    header.operator_name = options.trainee.name;
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

// What the lesson said in this tick goes to the file and to whoever watches.
Status pass_on_events(lesson::Lesson& lesson, const servo::State& state, record::Writer& writer,
                      Progress& progress, const std::function<bool(const Progress&)>& watch, bool& go_on) {
    for (const lesson::Event& event : lesson.events) {
        if (Status added = writer.add(event); !added) return added;
        if (event.kind == "step_end" || event.kind == "release") {
            const auto joint = static_cast<std::size_t>(event.joint);
            if (Status kept = writer.update(lesson::judge_joint(lesson, joint, state)); !kept) return kept;
        }
        progress.event = &event;
        go_on = watch(progress) && go_on;
        progress.event = nullptr;
    }
    lesson.events.clear();
    return {};
}

}  // namespace

Result<Played> train(const content::Assembly& given, const TrainOptions& options,
                     const std::filesystem::path& file, const std::function<bool(const Progress&)>& watch) {
    const content::Assembly assembly = lesson::under_law(given, options.law);
    const force::OutputLimits device;  // the simulated device: what a 6-DoF arm of the Virtuose class renders
    const servo::Setup setup = make_setup(assembly, options.law, device, options.seed, options.dt);
    servo::State state = servo::initial_state(setup);
    if (options.task == lesson::Task::loosen)
        if (Status tight = pretighten(assembly, setup, state); !tight) return fail(tight.error());

    Result<std::optional<TouchModels>> models = obstacles_of(assembly, setup, options.obstacles);
    if (!models) return fail(models.error());
    Result<record::Writer> created =
        record::Writer::create(file, header_of(assembly, options, device, *models));
    if (!created) return fail(created.error());
    if (models->has_value()) state.touch = std::move((*models)->touch);
    record::Writer& writer = *created;

    lesson::Lesson lesson = lesson::begin(assembly, options.mode, options.task);
    lesson.guides = lesson.guides && options.guide;
    for (std::size_t i = 0; i < lesson.joints.size(); ++i)
        if (Status kept = writer.update(lesson::judge_joint(lesson, i, state)); !kept)
            return fail(kept.error());

    operators::Operator trainee(options.trainee, options.seed, setup);
    const auto second = static_cast<std::uint64_t>(std::lround(1.0 / options.dt));
    const auto last = static_cast<std::uint64_t>(options.longest / options.dt);
    const auto patience = static_cast<std::uint64_t>(options.patience / options.dt);
    std::size_t step = lesson.current;
    std::uint64_t since = 0;
    bool go_on = true;
    while (go_on && state.tick - since < patience && lesson.due() != nullptr && state.tick < last) {
        const servo::Input input = trainee.act(setup, state, lesson);
        const servo::Output output = servo::tick(setup, state, input);
        lesson::observe(lesson, state, output);
        for (lesson::Event& seen : trainee.take_noticed()) lesson.events.push_back(std::move(seen));
        if (Status kept = writer.append(record::make_record(input, output)); !kept) return fail(kept.error());
        Progress progress{static_cast<double>(state.tick) * options.dt, lesson.current, lesson.steps.size(),
                          nullptr};
        if (!lesson.events.empty())
            if (Status kept = pass_on_events(lesson, state, writer, progress, watch, go_on); !kept)
                return fail(kept.error());
        if (lesson.current != step) {
            step = lesson.current;
            since = state.tick;
        }
        if (state.tick % second == 0) go_on = watch(progress) && go_on;
    }
    Played played{lesson::judge(lesson, state, options.dt), state.touch.has_value()};
    if (Status finished = writer.finish(played.result); !finished) return fail(finished.error());
    return played;
}

}  // namespace bolt::play
