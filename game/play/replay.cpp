#include "game/play/replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "content/format/load.hpp"
#include "game/record/device_text.hpp"

namespace bolt::play {

namespace {

Error cannot(const record::Reader& session, std::string what, std::string expected = {}) {
    Error error;
    error.code = ErrorCode::bad_content;
    error.file = session.file();
    error.what = std::move(what);
    error.expected = std::move(expected);
    return error;
}

template <class Value, std::size_t count>
std::optional<Value> named(const std::array<Value, count>& values, const std::string& name_wanted) {
    for (const Value value : values)
        if (name(value) == name_wanted) return value;
    return std::nullopt;
}

constexpr std::array modes{lesson::Mode::guided, lesson::Mode::practice, lesson::Mode::assessment};
constexpr std::array tasks{lesson::Task::tighten, lesson::Task::loosen};

// The text is the session's; the models that it names lie where the assembly is now.
Result<content::Assembly> assembly_of(const record::Header& header) {
    const bool there = std::filesystem::exists(header.assembly_file);
    content::Loaded now =
        content::load_assembly(there ? header.assembly_file : header.assembly, header.variant);
    if (!now.ok()) return fail(now.errors.front());
    if (now.assembly.text == header.assembly_text) return std::move(now.assembly);
    content::Loaded then =
        content::parse_assembly(header.assembly_text, header.assembly_file, header.variant);
    if (!then.ok()) return fail(then.errors.front());
    then.assembly.name = header.assembly;
    then.assembly.models = now.assembly.models;
    for (content::Tool& tool : then.assembly.tools)
        for (const content::Tool& there_now : now.assembly.tools)
            if (there_now.name == tool.name) tool.wrench.model = there_now.wrench.model;
    return std::move(then.assembly);
}

lesson::Lesson begin_again(const record::Reader& session, const Prepared& at) {
    const record::Header& header = session.header();
    lesson::Lesson lesson =
        lesson::begin(at.assembly, named(modes, header.mode).value_or(lesson::Mode::guided),
                      named(tasks, header.task).value_or(lesson::Task::tighten));
    lesson.guides = header.guide == "on";
    return lesson;
}

}  // namespace

Result<Prepared> prepare_again(const record::Reader& session) {
    const record::Header& header = session.header();
    const auto device = record::limits_of(header.device);
    const auto mode = named(modes, header.mode);
    const auto task = named(tasks, header.task);
    if (!device || !mode || !task)
        return fail(cannot(session, "the session does not say what its device was, or how the lesson went",
                           "a session of format 2"));
    Result<content::Assembly> assembly = assembly_of(header);
    if (!assembly) return fail(assembly.error());
    if (Status chosen = content::choose_tool(*assembly, header.tool); !chosen) return fail(chosen.error());
    CourseOptions options;
    options.mode = *mode;
    options.task = *task;
    options.law =
        header.law == joint::name(joint::Law::published) ? joint::Law::published : joint::Law::mechanistic;
    options.seed = header.seed;
    options.dt = header.dt;
    options.device = *device;
    options.obstacles = header.obstacles == "none" ? Obstacles::none : Obstacles::required;
    Result<Prepared> at = prepare(*assembly, options);
    if (!at) return at;
    if (at->obstacles != header.obstacles)
        return fail(cannot(session,
                           fmt::format("the models are not those that were met: {}; now {}", header.obstacles,
                                       at->obstacles),
                           "the content that the session was recorded with"));
    return at;
}

Result<Replayed> replay(const record::Reader& session, Prepared at,
                        const std::function<bool(const Moment&)>& visit) {
    Following following{begin_again(session, at)};
    lesson::Lesson& lesson = following.lesson;
    Replayed replayed;
    bool go_on = true;
    const Status read = session.for_each_chunk([&](std::uint64_t, std::span<const record::TickRecord> chunk) {
        for (const record::TickRecord& recorded : chunk) {
            if (!go_on) return;
            const servo::Input input = record::input_of(recorded);
            const servo::Output output = servo::tick(at.setup, at.state, input);
            follow(following, at.state, output);
            if (!record::same_output(record::make_record(input, output), recorded) && replayed.wrong++ == 0)
                replayed.first_wrong = replayed.ticks;
            ++replayed.ticks;
            const double time = static_cast<double>(at.state.tick) * at.setup.dt;
            go_on = visit({at.setup, at.state, lesson, input, output, time});
            lesson.events.clear();
        }
    });
    if (!read) return fail(read.error());
    return replayed;
}

}  // namespace bolt::play
