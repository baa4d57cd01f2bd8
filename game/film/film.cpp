#include "game/film/film.hpp"

#include <cmath>

#include "game/scene/angle_dial.hpp"
#include "game/scene/annotations.hpp"
#include "game/scene/postures.hpp"
#include "game/scene/workplace.hpp"
#include "game/view/gpu_context.hpp"
#include "game/view/pictures.hpp"
#include "game/world/world.hpp"

namespace bolt::film {

namespace {

constexpr float level_error = 0.5F;  // px, allowed error of a model's level of detail

struct GpuResources {
    std::optional<gpu::Instance> instance;
    view::GpuContext gpu_context;
    std::optional<ReplayScene> replay;

    GpuResources() = default;
    GpuResources(const GpuResources&) = delete;
    GpuResources& operator=(const GpuResources&) = delete;
    ~GpuResources() {
        if (gpu_context.device) (void)gpu_context.device->idle();
    }
};

}  // namespace

std::optional<std::size_t> active_joint(const scene::SceneWorld& world, const lesson::Lesson& lesson) {
    if (const std::int16_t held = world.only<world::ToolState>().joint; held >= 0)
        return static_cast<std::size_t>(held);
    const lesson::LessonStep* due = lesson.due();
    return due != nullptr ? std::optional(due->joint) : std::nullopt;
}

Result<ReplayScene> make_replay_scene(gpu::Device& device, const scene::LessonModels& models,
                                      const session::SessionSetup& start, hand::Side hand) {
    ReplayScene replay;
    BOLT_TRY_ASSIGN(auto uploaded, scene::upload(device, models));
    replay.models = std::move(uploaded);
    scene::SceneWorld world;
    world::add_haptics(world, start.state);
    BOLT_TRY_ASSIGN(auto workplace, scene::make_workplace(std::move(world), models, *replay.models,
                                                          start.assembly, start.setup));
    replay.workplace = std::move(workplace);
    replay.scene = scene::make_lit_scene(replay.workplace, replay.models->light);
    replay.postures = scene::postures_of_tools(start.setup, start.state, hand);
    replay.workplace.world.only<world::WorkingHand>().rest = scene::wrench_rest_pose(
        replay.workplace.workpiece, collision::thickness(start.setup.wrench.head), hand);
    replay.shoulder = scene::shoulder_position(replay.workplace.workpiece, {hand, std::nullopt});
    return replay;
}

void update_poses(ReplayScene& replay, const ReplayMoment& moment) {
    scene::SceneWorld& world = replay.workplace.world;
    const scene::Postures& postures = replay.postures[moment.setup.tool];
    const std::size_t posture = scene::natural_handle_posture(
        postures, world.only<world::ConstrainedTool>().pose, Vec3(0, 1, 0), replay.shoulder);
    scene::placement_system(world,
                            {moment.setup, postures, replay.shoulder, posture,
                             std::abs(scene::relative_torque(moment.setup, world)), 0.0, moment.seconds,
                             moment.contact != nullptr ? &moment.contact->world : nullptr});
    replay.scene.cut_away.strength = 0.0F;
    if (const std::int16_t held = world.only<world::ToolState>().joint; held >= 0)
        scene::fade_occluders(world, replay.scene, moment.setup, static_cast<std::size_t>(held));
}

void collect_frame(ReplayScene& replay, const ReplayMoment& moment, const Vec3& eye) {
    scene::SceneWorld& world = replay.workplace.world;
    scene::fade_near_arms(world, eye);
    replay.scene.labels.clear();
    if (const auto label = scene::work_label(moment.words, moment.lesson, moment.setup, world))
        replay.scene.labels.push_back(*label);
    scene::show_dial(world, scene::dial_of(moment.lesson, moment.setup, world));
    scene::appearance_system(world);
    view::collect_objects(world, replay.scene);
}

struct FilmState {
    FilmOptions options;
    GpuResources gpu;
    view::CameraGlide camera;
    motion::VisibilityModel visibility;
    std::optional<std::size_t> followed_joint;
};

namespace {

// Moves the camera to the active joint when it changes.
void follow_work(FilmState& film, const session::ReplayTick& tick, double seconds) {
    const scene::SceneWorld& world = film.gpu.replay->workplace.world;
    const auto joint = active_joint(world, tick.lesson);
    if (film.options.view.empty() && joint && film.followed_joint != joint) {
        const view::ViewTarget target{tick.setup,
                                      tick.state.tool_contact ? &*tick.state.tool_contact : nullptr, *joint,
                                      world::nut_centre(world, tick.setup, *joint), std::nullopt};
        film.camera.glide_to(view::find_view(target, film.visibility, film.camera.goal));
        film.followed_joint = joint;
    }
    (void)film.camera.advance(seconds);
}

}  // namespace

Film::Film(std::unique_ptr<FilmState> state) : state_(std::move(state)) {}
Film::~Film() = default;

scene::SceneWorld& Film::world() { return state_->gpu.replay->workplace.world; }

Result<std::unique_ptr<Film>> Film::create(const session::SessionSetup& start, const FilmOptions& options) {
    auto film = std::make_unique<FilmState>();
    film->options = options;
    GpuResources& gpu = film->gpu;
    Result<scene::LessonModels> models = scene::load_lesson_models(start.assembly, options.hand);
    if (!models) return fail(models.error());
    view::Viewpoint first = view::default_viewpoint({}, view::default_fov, 1.0F);
    if (!options.view.empty()) {
        const Result<view::Viewpoint> named = view::named_view(models->workpiece, options.view);
        if (!named) return fail(named.error());
        first = *named;
    } else if (!models->workpiece.views.empty()) {
        first = models->workpiece.views.front();
    }
    gpu::InstanceOptions instance_options;
    instance_options.validation = options.validate;
    Result<gpu::Instance> instance = gpu::Instance::create(instance_options);
    if (!instance) return fail(instance.error());
    gpu.instance.emplace(std::move(*instance));
    render::RendererOptions renderer;
    renderer.level_error_px = level_error;
    Result<view::GpuContext> gpu_context = view::make_gpu_context(*gpu.instance, {options.gpu}, renderer);
    if (!gpu_context) return fail(gpu_context.error());
    gpu.gpu_context = std::move(*gpu_context);
    BOLT_TRY_ASSIGN(auto replay, make_replay_scene(*gpu.gpu_context.device, *models, start, options.hand));
    gpu.replay.emplace(std::move(replay));
    if (options.view.empty() && models->workpiece.views.empty())
        first = view::default_viewpoint(
            gpu.replay->workplace.workpiece, view::default_fov,
            static_cast<float>(options.size.width) / static_cast<float>(options.size.height));
    film->camera.jump(view::orbit_of(first));
    return std::unique_ptr<Film>(new Film(std::move(film)));
}

Result<render::Picture> Film::draw(const session::ReplayTick& tick, double seconds) {
    FilmState& film = *state_;
    ReplayScene& replay = *film.gpu.replay;
    const ReplayMoment moment{tick.setup, tick.lesson,
                              tick.state.tool_contact ? &*tick.state.tool_contact : nullptr,
                              film.options.words, seconds};
    update_poses(replay, moment);
    follow_work(film, tick, seconds);
    collect_frame(replay, moment, Vec3(view::viewpoint_of(film.camera.shown).eye));
    const VkExtent2D size = film.options.size;
    const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
    std::vector<render::Eye> eyes;
    for (const float aside : view::eye_offsets(film.options.stereo))
        eyes.push_back(view::eye_of(film.camera.shown, render::bounds(replay.scene), aspect, aside));
    const view::GpuContext& gpu = film.gpu.gpu_context;
    BOLT_TRY_ASSIGN(const auto pictures,
                    render::take_pictures(*gpu.device, *gpu.frames, *gpu.renderer, replay.scene, eyes, size));
    return view::side_by_side(pictures);
}

Status Film::check_validation() const {
    const std::vector<std::string>& messages = state_->gpu.instance->log().messages;
    if (messages.empty()) return {};
    return fail(ErrorCode::failed, messages.front(), "no message of the validation layer");
}

}  // namespace bolt::film
