#include "game/trainer/lesson_start.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <utility>

#include "game/lesson/law.hpp"
#include "game/session/resume.hpp"
#include "game/station/frame_registration.hpp"
#include "game/station/station_setup.hpp"
#include "haptics/device/device.hpp"
#include "haptics/force/output_limits.hpp"

namespace bolt::trainer {

namespace {

// Starts the station, if the choice needs one, and copies its limits and rate into the options.
Status start_station_of(const LessonRequest& request, StartedLesson& lesson) {
    if (!request.choice.equipment.needs_station()) return {};
    session::LessonOptions& options = lesson.context.options;
    Equipment equipment = request.choice.equipment;
    equipment.force_scale = request.settings.force_scale;
    BOLT_TRY_ASSIGN(auto station, request.start_station(lesson.context.assembly, options, equipment,
                                                        request.choice.trainee, request.arm_dialog));
    lesson.active.station.emplace();
    lesson.active.station->link = std::move(station);
    const bool dragged = equipment.hand == HandMode::free || equipment.hand == HandMode::simulated_arm;
    if (dragged) lesson.active.station->dragged.emplace();
    if (equipment.hand == HandMode::tracked) lesson.active.station->tracked.emplace();
    options.device_limits = lesson.active.station->link->setup().limits;
    options.servo_rate = 1.0 / options.dt;
    return {};
}

// Repeats and records the ticks of the interrupted lesson, with the recorded limits of the devices: the
// station starts only afterwards (join_station).
Status resume_session(const LessonRequest& request, session::SessionSetup setup, StartedLesson& lesson) {
    session::LessonOptions& options = lesson.context.options;
    BOLT_TRY_ASSIGN(options.continues, session::read_interrupted(request.interrupted));
    const session::Header& recorded = options.continues->header;
    options.hand = recorded.hand;
    if (request.choice.equipment.needs_station()) {
        options.servo_rate = 1.0 / options.dt;
        options.device_limits = recorded.device_limits.value_or(options.device_limits);
        session::set_device_limits(options, setup);
    }
    scene::SceneWorld world;
    world::add_haptics(world, setup.state);
    BOLT_TRY_ASSIGN(lesson.active.session,
                    session::LessonSession::resume(std::move(setup), options,
                                                   request.folder / "session.boltwright", world));
    lesson.active.second_wrench = world.only<world::ToolState>().second_wrench;
    lesson.active.workplace.world = std::move(world);
    lesson.continued = true;
    return {};
}

Result<StartedLesson> begin_again(LessonRequest request, const Error& why) {
    request.interrupted.clear();
    BOLT_TRY_ASSIGN(auto lesson, start_lesson(request));
    lesson.why_begun_again = why;
    return lesson;
}

// Sets the station's counters to those of the repeated session. Fails if its limits of force are not those of
// the recording.
Status join_station(StartedLesson& lesson) {
    if (!lesson.active.station) return {};
    lesson.active.station->checkpoints_sent = lesson.active.session->checkpoints_saved();
    const session::LessonOptions& options = lesson.context.options;
    const session::InterruptedLesson& interrupted = *options.continues;
    if (session::limits_text(options.device_limits) ==
        session::limits_text(interrupted.header.device_limits.value_or(force::OutputLimits())))
        return {};
    Error error;
    error.file = interrupted.file.string();
    error.what = "has other limits of force than the device now";
    error.expected = "the device and the share of its force with which the lesson was recorded";
    return fail(std::move(error));
}

// The side of the glove, else that of the settings.
hand::Side working_side(const ActiveLesson& active, const content::TraineeSettings& settings) {
    if (active.station)
        if (const station::DisplayedHand* gloved = active.station->link->hand()) return gloved->side;
    if (active.station)
        if (const station_setup::WornFingers* worn = active.station->link->worn_fingers()) return worn->side;
    return settings.left_handed ? hand::Side::left : hand::Side::right;
}

// The registration of a glove and of what is fixed to it.
WristMount wrist_mount(const content::StationFile& station) {
    const auto wrist_in = [&](content::CoordinateFrame frame) -> std::optional<Pose> {
        const Result<content::Registration> found =
            station_setup::registration_from(station.registrations, content::CoordinateFrame::hand, frame);
        return found ? std::optional(found->pose) : std::nullopt;
    };
    return {station.wrist_tracker, wrist_in(content::CoordinateFrame::wrist_tracker),
            wrist_in(content::CoordinateFrame::controller)};
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

Result<std::unique_ptr<station_setup::LessonStation>> start_station(const content::Assembly& assembly,
                                                                    const session::LessonOptions& options,
                                                                    const Equipment& equipment,
                                                                    const std::string& trainee,
                                                                    const device::ArmDialog& dialog) {
    const device::Timer timer = device::steady_timer();
    const bool arm = equipment.hand == HandMode::simulated_arm;
    device::VirtualPuck puck({}, timer);
    device::SimulatedArm simulated_arm(device::simulated_arm_description(),
                                       device::simulated_arm_parameters(), timer);
    station_setup::StationRequest request;
    request.devices = equipment.devices;
    request.station = equipment.station;
    request.wheel_config_file = equipment.wheel_config_file;
    request.fallback_mover = arm ? simulated_arm.factory() : puck.factory();
    request.glove = equipment.glove;
    request.trainee = trainee;
    request.force_scale = equipment.force_scale;
    request.arm_dialog = dialog;
    if (!equipment.glove.empty() && trainee.empty())
        return fail(ErrorCode::no_device, "the wearer of the glove is not named",
                    "the trainee's name given to boltwright glove calibrate");
    Result<station_setup::PlannedStation> planned =
        station_setup::plan_lesson_station(assembly, options, request, {});
    if (!planned) return fail(planned.error());
    station::StationOptions& station_options = planned->options;
    station_options.controls.pause = true;
    station_setup::VirtualMover mover;
    if (!planned->devices.mover) station_options.mover_buttons = {1, 0, 0, 0};
    if (!planned->devices.mover && equipment.hand == HandMode::free)
        return station_setup::start_frame_stepped_station(station_options,
                                                          device::simulated_arm_description());
    if (!planned->devices.mover && equipment.hand == HandMode::tracked) {
        station_options.workspace.absolute = true;
        station_options.workspace.scale = 1.0;
        return station_setup::start_frame_stepped_station(station_options,
                                                          device::tracked_hand_description());
    }
    if (!planned->devices.mover && arm) mover = std::move(simulated_arm);
    if (!planned->devices.mover && !arm) mover = std::move(puck);
    return station_setup::start_threaded_station(std::move(station_options), std::move(mover),
                                                 dialog.permission);
}

Result<StartedLesson> start_lesson(const LessonRequest& request) {
    const LessonChoice& choice = request.choice;
    content::LoadedAssembly loaded = content::load_assembly(choice.assembly, choice.variant);
    if (!loaded.ok()) return fail(loaded.errors.front());
    BOLT_TRY(content::choose_tool(loaded.assembly, choice.tool));

    StartedLesson lesson;
    LessonContext& context = lesson.context;
    context.choice = choice;
    session::LessonOptions& options = context.options;
    options = request.options;
    options.law = effective_law(choice, request.settings, loaded.assembly.law);
    options.mode = choice.mode;
    options.task = choice.task;
    options.trainee_profile = "person";
    options.trainee = choice.trainee;
    options.device_limits = force::scaled(request.options.device_limits, request.settings.force_scale);
    context.assembly = lesson::apply_law(std::move(loaded.assembly), options.law);

    BOLT_TRY_ASSIGN(auto setup, session::prepare_session(context.assembly, options));
    if (!request.interrupted.empty())
        if (const Status resumed = resume_session(request, std::move(setup), lesson); !resumed)
            return begin_again(request, resumed.error());
    BOLT_TRY(start_station_of(request, lesson));
    if (lesson.continued) {
        if (const Status joined = join_station(lesson); !joined) {
            lesson.active = {};  // it holds the devices and the session file
            return begin_again(request, joined.error());
        }
    } else if (lesson.active.station) {
        session::set_device_limits(options, setup);
    }
    context.worker = {working_side(lesson.active, request.settings), request.settings.seated_eye_height};
    options.hand = context.worker.side;
    BOLT_TRY_ASSIGN(auto models, scene::load_lesson_models(context.assembly, context.worker.side));
    context.models = std::move(models);
    if (lesson.continued) return lesson;
    BOLT_TRY_ASSIGN(auto session, session::LessonSession::begin(std::move(setup), options,
                                                                request.folder / "session.boltwright"));
    lesson.active.session = std::move(session);
    return lesson;
}

LessonStartThread::LessonStartThread(LessonRequest request, std::unique_ptr<LessonStartThread> before)
    : before_(std::move(before)) {
    request.arm_dialog.permission = permission_;
    request.arm_dialog.on_preparation = [this](const device::Preparation& preparation) {
        return store(preparation);
    };
    thread_ = std::jthread([this, request = std::move(request)] {
        before_.reset();
        result_.emplace(given_up_ ? fail(ErrorCode::failed, "the start was cancelled", {})
                                  : start_lesson(request));
        done_ = true;
    });
}

LessonStartThread::~LessonStartThread() { give_up(); }

bool LessonStartThread::store(const device::Preparation& preparation) {
    const std::lock_guard lock(mutex_);
    preparation_ = preparation;
    return !given_up_;
}

std::optional<Result<StartedLesson>> LessonStartThread::take() {
    if (!done_ || !result_) return {};
    return std::exchange(result_, std::nullopt);
}

device::ArmNeeds LessonStartThread::needs() const {
    const std::lock_guard lock(mutex_);
    return {preparation_, permission_->active()};
}

void LessonStartThread::permit_move() { permission_->grant(); }
void LessonStartThread::give_up() { given_up_ = true; }

void place_trainee(ActiveLesson& active, const LessonContext& context, float aspect) {
    const servo::Setup& setup = active.session->setup();
    const servo::State& state = active.session->state();
    const render::BoundingBox& workpiece = active.workplace.workpiece;
    const scene::Worker& worker = context.worker;
    active.helped_hand =
        make_hand(scene::wrench_rest_pose(workpiece, collision::thickness(setup.wrench.head), worker.side),
                  worker.side);
    active.workplace.world.only<world::WorkingHand>() = hand_of(active.helped_hand);
    active.postures = scene::postures_of_tools(setup, state, worker.side);
    active.shoulder = scene::shoulder_position(workpiece, worker);
    if (active.station) {
        StationClient& station = *active.station;
        station.rest = hand_of(active).rest;
        station.home = hand_of(active).pose;
        if (station.tracked) station.tracked->side = worker.side;
        station.wrist_mount = wrist_mount(context.choice.equipment.station);
        const hand::Skeleton& open = active.postures.front().open;
        const Pose fingers = scene::frame_towards(station.home, active.shoulder, 0.0);
        station.empty_hand_wrist =
            inverse(station.home) * fingers * Pose{open.position[hand::wrist], open.rotation[hand::wrist]};
    }
    active.view.close_up.wanted = context.options.mode == lesson::Mode::guided;
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
