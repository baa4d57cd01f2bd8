#include "game/session/replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>

#include "content/format/assembly.hpp"
#include "game/session/session_file.hpp"

namespace bolt::session {

namespace {

Error replay_error(const SessionReader& session, std::string what, std::string expected = {}) {
    Error error;
    error.code = ErrorCode::bad_content;
    error.file = session.file();
    error.what = std::move(what);
    error.expected = std::move(expected);
    return error;
}

// The assembly of the session's text, with the models of the present assembly. A session without obstacles
// needs no model, so the present assembly may be missing.
Result<content::Assembly> assembly_of(const Header& header) {
    const bool exists = std::filesystem::exists(header.assembly_file);
    content::LoadedAssembly present =
        content::load_assembly(exists ? header.assembly_file : header.assembly, header.variant);
    if (!present.ok() && !header.contact_models.value_or("").empty()) return fail(present.errors.front());
    if (present.ok() && present.assembly.text == header.assembly_text) return std::move(present.assembly);
    content::LoadedAssembly recorded =
        content::parse_assembly(header.assembly_text, header.assembly_file, header.variant);
    if (!recorded.ok()) return fail(recorded.errors.front());
    recorded.assembly.name = header.assembly;
    if (!present.ok()) return std::move(recorded.assembly);
    recorded.assembly.models = present.assembly.models;
    for (content::Tool& tool : recorded.assembly.tools)
        for (const content::Tool& present_tool : present.assembly.tools)
            if (present_tool.name == tool.name && !tool.wrench.model.empty())
                tool.wrench.model = present_tool.wrench.model;  // else generated, as when it was recorded
    return std::move(recorded.assembly);
}

lesson::Lesson restore_lesson(const SessionReader& session, const SessionSetup& start) {
    const Header& header = session.header();
    lesson::Lesson lesson = lesson::begin(start.assembly, header.mode, header.task);
    lesson.guides = header.guiding_force.value_or(false);
    if (!header.rules.judges_tool_choice) lesson.tool_faults.clear();
    return lesson;
}

}  // namespace

Result<SessionSetup> restore_setup(const SessionReader& session) {
    const Header& header = session.header();
    if (!header.device_limits || !header.contact_models)
        return fail(replay_error(session, "the session does not record its device and obstacles",
                                 "a session of format 2 or later"));
    BOLT_TRY_ASSIGN(auto assembly, assembly_of(header));
    BOLT_TRY(content::choose_tool(assembly, header.tool));
    LessonOptions options;
    options.mode = header.mode;
    options.task = header.task;
    options.law = header.law;
    options.rules = header.rules;
    options.seed = header.seed;
    options.dt = header.dt;
    options.device_limits = *header.device_limits;
    options.obstacles = header.contact_models->empty() ? ObstacleUse::none : ObstacleUse::required;
    Result<SessionSetup> start = prepare_session(assembly, options);
    if (!start) return start;
    if (start->contact_models != *header.contact_models)
        return fail(replay_error(session,
                                 fmt::format("the contact models have changed: recorded with {}, found {}",
                                             *header.contact_models, start->contact_models),
                                 "the content that the session was recorded with"));
    return start;
}

Result<ReplayResult> replay(const SessionReader& session, SessionSetup start, const VisitTick& visit) {
    world::World world;
    world::add_haptics(world, start.state);
    return replay(session, std::move(start), world, visit);
}

Result<ReplayResult> replay(const SessionReader& session, SessionSetup start,
                            const world::WriteHaptics& world, const VisitTick& visit) {
    LessonTracker tracker{restore_lesson(session, start)};
    lesson::Lesson& lesson = tracker.lesson;
    ReplayResult replayed;
    bool proceed = true;
    BOLT_TRY(session.for_each_chunk([&](std::uint64_t, std::span<const TickRecord> chunk) {
        for (const TickRecord& recorded : chunk) {
            if (!proceed) return;
            const servo::TickInput input = input_of(recorded);
            servo::change_tool(start.setup, start.state, input);
            const servo::Output output = servo::tick(start.setup, start.state, input);
            TickContext context{{start.state, input, output}, start.setup, tracker};
            ecs::run(tick_systems, world, context);
            if (!same_output(make_record(input, output), recorded) && replayed.mismatches++ == 0)
                replayed.first_mismatch = replayed.ticks;
            ++replayed.ticks;
            const double time = static_cast<double>(start.state.tick) * start.setup.dt;
            proceed = visit({start.setup, start.state, lesson, input, output, time});
            lesson.events.clear();
        }
    }));
    return replayed;
}

namespace {

struct RecordedSample {
    servo::CommandedTool commanded_tool;
    std::uint32_t buttons = 0;
    std::uint64_t tick = 0;
};

Pose recorded_pose(const servo::CommandedTool& commanded) {
    const Quat q(static_cast<double>(commanded.orientation[0]), static_cast<double>(commanded.orientation[1]),
                 static_cast<double>(commanded.orientation[2]),
                 static_cast<double>(commanded.orientation[3]));
    return {Vec3(commanded.position[0], commanded.position[1], commanded.position[2]), glm::normalize(q)};
}

}  // namespace

Result<RecordedHand> replay_device(const SessionReader& session) {
    const auto samples = std::make_shared<std::vector<RecordedSample>>();
    samples->reserve(session.tick_count());
    BOLT_TRY(session.for_each_chunk([&](std::uint64_t first, std::span<const TickRecord> ticks) {
        for (std::size_t i = 0; i < ticks.size(); ++i) {
            const TickRecord& tick = ticks[i];
            if ((tick.flags & flag_no_sample) != 0) continue;
            const std::uint32_t buttons = ((tick.flags & flag_dead_man) != 0 ? button_dead_man : 0) |
                                          ((tick.flags & flag_stop) != 0 ? button_stop : 0) |
                                          ((tick.flags & flag_reset) != 0 ? button_reset : 0);
            samples->push_back({tick.commanded_tool, buttons, first + i});
        }
    }));
    if (samples->empty())
        return fail(ErrorCode::failed, session.file() + ": has no tick with a fresh device sample",
                    "a session with device input");

    RecordedHand hand;
    device::Description& d = hand.description;
    d.name = "the hand of " + session.file();
    d.id = "recording";
    d.sensing = device::Sensing::pose;
    if (const auto& limits = session.header().device_limits) d.limits = *limits;
    for (std::size_t i = 0; i < 6; ++i) d.renders[i] = (i < 3 ? d.limits.force : d.limits.torque) > 0.0;
    d.rate = 1.0 / session.header().dt;
    d.buttons = 3;
    hand.first = recorded_pose(samples->front().commanded_tool);
    hand.recording = [samples, dt = session.header().dt](std::size_t i) -> std::optional<device::Sample> {
        if (i >= samples->size()) return std::nullopt;
        const RecordedSample& recorded = (*samples)[i];
        device::Sample sample;
        sample.pose = recorded_pose(recorded.commanded_tool);
        sample.buttons = recorded.buttons;
        sample.time = static_cast<double>(recorded.tick) * dt;
        return sample;
    };
    return hand;
}

}  // namespace bolt::session
