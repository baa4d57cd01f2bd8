#include "game/trainer/lesson_start.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <ctime>

#include "haptics/force/output_limits.hpp"

namespace bolt::trainer {

namespace {

// Starts the station, if the choice needs one, and takes its limits and rate over into the lesson.
Status start_station_of(const LessonStart& start, StartedLesson& lesson, session::SessionSetup& setup) {
    if (!start.choice.equipment.needs_station()) return {};
    session::LessonOptions& options = lesson.context.options;
    Equipment equipment = start.choice.equipment;
    equipment.force_scale = start.settings.force_scale;
    BOLT_TRY_ASSIGN(auto station, start.start_station(lesson.context.assembly, options, equipment,
                                                      start.choice.trainee, start.arm_dialog));
    lesson.active.station.emplace();
    lesson.active.station->link = std::move(station);
    const bool dragged = equipment.hand == HandMode::free || equipment.hand == HandMode::simulated_arm;
    if (dragged) lesson.active.station->dragged.emplace();
    if (equipment.hand == HandMode::tracked) lesson.active.station->tracked.emplace();
    options.device_limits = lesson.active.station->link->setup().limits;
    options.servo_rate = 1.0 / options.dt;
    session::set_device_limits(options, setup);
    return {};
}

// The side of the glove, else that of the settings.
hand::Side working_side(const ActiveLesson& active, const content::TraineeSettings& settings) {
    if (active.station)
        if (const station::DisplayedHand* gloved = active.station->link->hand()) return gloved->side;
    return settings.left_handed ? hand::Side::left : hand::Side::right;
}

// A view of the workpiece and the resting wrench, no higher than the eyes of a seated trainee.
view::Orbit first_view(const ActiveLesson& active, const LessonContext& context, float aspect) {
    const view::LoadedModel& model = context.models.workpiece;
    const render::BoundingBox& workpiece = active.workplace.workpiece;
    const view::Viewpoint viewpoint = model.views.empty()
                                          ? view::default_viewpoint(workpiece, view::default_fov, aspect)
                                          : model.views.front();
    render::BoundingBox all = workpiece;
    for (const double along : {-0.1, 1.2}) {
        const double x = along * active.session->setup().wrench.handle_length;
        const glm::vec3 end(hand_of(active).rest * Vec3(x, 0.0, 0.0));
        all.low = glm::min(all.low, end);
        all.high = glm::max(all.high, end);
    }
    const view::Orbit orbit = view::fit_to_box(view::orbit_of(viewpoint), all, aspect);
    const auto eyes = scene::eye_height(workpiece, context.worker);
    return eyes ? view::fit_to_box(view::limit_eye_height(orbit, *eyes), all, aspect) : orbit;
}

}  // namespace

Result<std::string> tool_of_station(const content::StationFile& station,
                                    std::span<const content::Tool> tools) {
    if (!station.arm || station.arm->tool.empty()) return std::string();
    const std::string& name = station.arm->tool;
    std::vector<std::string> names;
    for (const content::Tool& tool : tools) {
        if (tool.name == name) return names.empty() ? std::string() : name;
        names.push_back(tool.name);
    }
    return fail(ErrorCode::bad_content,
                fmt::format("the assembly does not have the tool of the station's arm, \"{}\"", name),
                fmt::format("one of its tools: {}", fmt::join(names, ", ")));
}

joint::Law effective_law(const LessonChoice& choice, const content::TraineeSettings& settings,
                         joint::Law assembly_law) {
    if (choice.law) return *choice.law;
    return joint::law_named(settings.law).value_or(assembly_law);
}

Result<StartedLesson> start_lesson(const LessonStart& start) {
    const LessonChoice& choice = start.choice;
    content::LoadedAssembly loaded = content::load_assembly(choice.assembly, choice.variant);
    if (!loaded.ok()) return fail(loaded.errors.front());
    BOLT_TRY(content::choose_tool(loaded.assembly, choice.tool));

    StartedLesson lesson;
    LessonContext& context = lesson.context;
    context.choice = choice;
    session::LessonOptions& options = context.options;
    options = start.options;
    options.law = effective_law(choice, start.settings, loaded.assembly.law);
    options.mode = choice.mode;
    options.task = choice.task;
    options.trainee_profile = "person";
    options.trainee = choice.trainee;
    options.device_limits = force::scaled(start.options.device_limits, start.settings.force_scale);
    context.assembly = lesson::apply_law(std::move(loaded.assembly), options.law);

    BOLT_TRY_ASSIGN(auto setup, session::prepare_session(context.assembly, options));
    BOLT_TRY(start_station_of(start, lesson, setup));
    context.worker = {working_side(lesson.active, start.settings), start.settings.seated_eye_height};
    options.hand = context.worker.side;
    BOLT_TRY_ASSIGN(auto models, scene::load_lesson_models(context.assembly, context.worker.side));
    context.models = std::move(models);
    BOLT_TRY_ASSIGN(auto session, session::LessonSession::begin(std::move(setup), options,
                                                                start.folder / "session.boltwright"));
    lesson.active.session = std::move(session);
    return lesson;
}

void place_trainee(ActiveLesson& active, const LessonContext& context, float aspect) {
    const servo::Setup& setup = active.session->setup();
    const servo::State& state = active.session->state();
    const render::BoundingBox& workpiece = active.workplace.workpiece;
    const scene::Worker& worker = context.worker;
    active.mouse = make_hand(
        scene::wrench_rest_pose(workpiece, context.assembly.wrench.head_thickness, worker.side), worker.side);
    active.workplace.world.only<world::WorkingHand>() = hand_of(active.mouse);
    active.postures = scene::make_postures(state.tool_contact ? &state.tool_contact->wrench : nullptr,
                                           setup.wrench.handle_length, worker.side, scene::widest_nut(setup));
    active.shoulder = scene::shoulder_position(workpiece, worker);
    if (active.station) {
        StationClient& station = *active.station;
        station.rest = hand_of(active).rest;
        station.home = hand_of(active).pose;
        if (station.tracked) station.tracked->side = worker.side;
        const hand::Skeleton& open = active.postures.open;
        const Pose fingers = scene::frame_towards(station.home, active.shoulder, 0.0);
        station.bare_wrist =
            inverse(station.home) * fingers * Pose{open.position[hand::wrist], open.rotation[hand::wrist]};
    }
    active.view.close_up.enabled = context.options.mode == lesson::Mode::guided;
    active.view.camera.jump(first_view(active, context, aspect));
}

Result<std::filesystem::path> make_lesson_folder(const std::filesystem::path& out, bool folder_per_lesson,
                                                 const std::string& assembly) {
    std::filesystem::path folder = out;
    if (folder_per_lesson) {
        const std::string name = fmt::format("{:%Y-%m-%d_%H-%M-%S}_{}", fmt::localtime(std::time(nullptr)),
                                             std::filesystem::path(assembly).filename().string());
        folder /= name;
        std::error_code ignored;
        for (int i = 2; std::filesystem::exists(folder, ignored); ++i)
            folder = out / fmt::format("{}_{}", name, i);
    }
    std::error_code problem;
    std::filesystem::create_directories(folder, problem);
    if (!problem) return folder;
    Error error;
    error.file = folder.string();
    error.what = "this folder cannot be created: " + problem.message();
    error.expected = "a folder that you may write to";
    return fail(error);
}

Status start_sound(ActiveLesson& active, bool audible) {
    active.sound.detector.surfaces =
        sound::struck_surfaces(active.session->assembly(), active.session->obstacle_names());
    if (!audible) return {};
    BOLT_TRY_ASSIGN(auto live,
                    sound::LiveSound::start(active.session->setup(), active.sound.detector.surfaces));
    active.sound.live = std::make_unique<sound::LiveSound>(std::move(live));
    return {};
}

}  // namespace bolt::trainer
