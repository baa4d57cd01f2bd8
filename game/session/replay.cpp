#include "game/session/replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>

#include "content/format/assembly.hpp"
#include "game/session/session_file.hpp"

namespace bolt::session {

namespace {

Error cannot(const session::Reader& session, std::string what, std::string expected = {}) {
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

// The text is the session's; the models that it names lie where the assembly is now. A session in which
// nothing was bumped into needs no model, so its assembly may be gone.
Result<content::Assembly> assembly_of(const session::Header& header) {
    const bool there = std::filesystem::exists(header.assembly_file);
    content::Loaded now =
        content::load_assembly(there ? header.assembly_file : header.assembly, header.variant);
    if (!now.ok() && header.obstacles != "none") return fail(now.errors.front());
    if (now.ok() && now.assembly.text == header.assembly_text) return std::move(now.assembly);
    content::Loaded then =
        content::parse_assembly(header.assembly_text, header.assembly_file, header.variant);
    if (!then.ok()) return fail(then.errors.front());
    then.assembly.name = header.assembly;
    if (!now.ok()) return std::move(then.assembly);
    then.assembly.models = now.assembly.models;
    for (content::Tool& tool : then.assembly.tools)
        for (const content::Tool& there_now : now.assembly.tools)
            if (there_now.name == tool.name) tool.wrench.model = there_now.wrench.model;
    return std::move(then.assembly);
}

lesson::Lesson begin_again(const session::Reader& session, const Prepared& at) {
    const session::Header& header = session.header();
    lesson::Lesson lesson =
        lesson::begin(at.assembly, named(modes, header.mode).value_or(lesson::Mode::guided),
                      named(tasks, header.task).value_or(lesson::Task::tighten));
    lesson.guides = header.guide == "on";
    return lesson;
}

}  // namespace

Result<Prepared> prepare_again(const session::Reader& session) {
    const session::Header& header = session.header();
    const auto device = session::limits_of(header.device);
    const auto mode = named(modes, header.mode);
    const auto task = named(tasks, header.task);
    if (!device || !mode || !task)
        return fail(cannot(session, "the session does not record its device, mode or task",
                           "a session of format 2 or later"));
    BOLT_TRY_ASSIGN(auto assembly, assembly_of(header));
    BOLT_TRY(content::choose_tool(assembly, header.tool));
    CourseOptions options;
    options.mode = *mode;
    options.task = *task;
    options.law =
        header.law == joint::name(joint::Law::published) ? joint::Law::published : joint::Law::mechanistic;
    options.seed = header.seed;
    options.dt = header.dt;
    options.device = *device;
    options.obstacles = header.obstacles == "none" ? Obstacles::none : Obstacles::required;
    Result<Prepared> at = prepare(assembly, options);
    if (!at) return at;
    if (at->obstacles != header.obstacles)
        return fail(cannot(session,
                           fmt::format("the contact models have changed: recorded with {}, found {}",
                                       header.obstacles, at->obstacles),
                           "the content that the session was recorded with"));
    return at;
}

Result<Replayed> replay(const session::Reader& session, Prepared at,
                        const std::function<bool(const Moment&)>& visit) {
    LessonTracker tracker{begin_again(session, at)};
    lesson::Lesson& lesson = tracker.lesson;
    Replayed replayed;
    bool go_on = true;
    BOLT_TRY(session.for_each_chunk([&](std::uint64_t, std::span<const session::TickRecord> chunk) {
        for (const session::TickRecord& recorded : chunk) {
            if (!go_on) return;
            const servo::Input input = session::input_of(recorded);
            const servo::Output output = servo::tick(at.setup, at.state, input);
            follow(tracker, at.state, output);
            if (!session::same_output(session::make_record(input, output), recorded) && replayed.wrong++ == 0)
                replayed.first_wrong = replayed.ticks;
            ++replayed.ticks;
            const double time = static_cast<double>(at.state.tick) * at.setup.dt;
            go_on = visit({at.setup, at.state, lesson, input, output, time});
            lesson.events.clear();
        }
    }));
    return replayed;
}

namespace {

struct Sample {
    servo::DeviceSample device;
    std::uint32_t buttons = 0;
    std::uint64_t tick = 0;
};

Pose recorded_pose(const servo::DeviceSample& s) {
    const Quat q(static_cast<double>(s.orientation[0]), static_cast<double>(s.orientation[1]),
                 static_cast<double>(s.orientation[2]), static_cast<double>(s.orientation[3]));
    return {Vec3(s.position[0], s.position[1], s.position[2]), glm::normalize(q)};
}

}  // namespace

Result<RecordedHand> replay_device(const Reader& session) {
    const auto samples = std::make_shared<std::vector<Sample>>();
    samples->reserve(session.tick_count());
    BOLT_TRY(session.for_each_chunk([&](std::uint64_t first, std::span<const TickRecord> ticks) {
        for (std::size_t i = 0; i < ticks.size(); ++i) {
            const TickRecord& tick = ticks[i];
            if ((tick.flags & flag_silent) != 0) continue;
            const std::uint32_t buttons = ((tick.flags & flag_enabled) != 0 ? button_held : 0) |
                                          ((tick.flags & flag_stop) != 0 ? button_stop : 0) |
                                          ((tick.flags & flag_reset) != 0 ? button_reset : 0);
            samples->push_back({tick.device, buttons, first + i});
        }
    }));
    if (samples->empty())
        return fail(ErrorCode::failed, session.file() + ": has no ticks with a fresh device sample",
                    "a session that was played");

    RecordedHand hand;
    device::Description& d = hand.description;
    d.name = "the hand of " + session.file();
    d.id = "recording";
    d.sensing = device::Sensing::pose;
    if (const auto limits = limits_of(session.header().device)) d.limits = *limits;
    for (std::size_t i = 0; i < 6; ++i) d.renders[i] = (i < 3 ? d.limits.force : d.limits.torque) > 0.0;
    d.rate = 1.0 / session.header().dt;
    d.buttons = 3;
    hand.first = recorded_pose(samples->front().device);
    hand.recording = [samples, dt = session.header().dt](std::size_t i) -> std::optional<device::Sample> {
        if (i >= samples->size()) return std::nullopt;
        const Sample& now = (*samples)[i];
        device::Sample sample;
        sample.pose = recorded_pose(now.device);
        sample.buttons = now.buttons;
        sample.time = static_cast<double>(now.tick) * dt;
        return sample;
    };
    return hand;
}

}  // namespace bolt::session
