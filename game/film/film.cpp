#include "game/film/film.hpp"

#include <cmath>

#include "game/scene/annotations.hpp"
#include "game/scene/postures.hpp"
#include "game/scene/workplace.hpp"
#include "game/view/pictures.hpp"
#include "game/world/world.hpp"

namespace bolt::film {

namespace {

constexpr float level_error = 0.5F;  // px, allowed error of a model's level of detail

std::optional<std::size_t> active_joint(const scene::SceneWorld& world, const lesson::Lesson& lesson) {
    if (const std::int16_t held = world.only<world::ContactState>().joint; held >= 0)
        return static_cast<std::size_t>(held);
    const lesson::LessonStep* due = lesson.due();
    return due != nullptr ? std::optional(due->joint) : std::nullopt;
}

struct GpuResources {
    std::optional<gpu::Instance> instance;
    view::GpuContext gpu_context;
    std::unique_ptr<scene::GpuLessonModels> models;

    GpuResources() = default;
    GpuResources(const GpuResources&) = delete;
    GpuResources& operator=(const GpuResources&) = delete;
    ~GpuResources() {
        if (gpu_context.device) (void)gpu_context.device->idle();
    }
};

}  // namespace

struct FilmState {
    FilmOptions options;
    GpuResources gpu;
    scene::Workplace workplace;
    scene::Postures postures;
    Vec3 shoulder{0.0};
    render::Scene scene;
    view::CameraGlide camera;
    motion::VisibilityModel visibility;
    std::optional<std::size_t> followed_joint;
};

namespace {

// Input of the systems of one picture.
struct FilmFrame {
    FilmState& film;
    const session::ReplayTick& tick;
    double seconds = 0.0;  // since the previous picture
};

void placement_system(scene::SceneWorld& world, FilmFrame& frame) {
    const FilmState& film = frame.film;
    const servo::State& state = frame.tick.state;
    const std::size_t grip =
        scene::natural_grip(film.postures, world.only<world::HeldTool>().pose, Vec3(0, 1, 0), film.shoulder);
    scene::placement_system(world,
                            {frame.tick.setup, film.postures, film.shoulder, grip,
                             std::abs(scene::relative_torque(frame.tick.setup, world)), 0.0, frame.seconds,
                             state.tool_contact ? &state.tool_contact->world : nullptr});
}

// Moves the camera to the active joint when it changes, and cuts away what hides a held nut.
void view_system(scene::SceneWorld& world, FilmFrame& frame) {
    FilmState& film = frame.film;
    const session::ReplayTick& tick = frame.tick;
    film.scene.cut_away.strength = 0.0F;
    if (const std::int16_t held = world.only<world::ContactState>().joint; held >= 0)
        scene::fade_occluders(world, film.scene, tick.setup, static_cast<std::size_t>(held));
    const auto joint = active_joint(world, tick.lesson);
    if (film.options.view.empty() && joint && film.followed_joint != joint) {
        const view::ViewTarget target{tick.setup,
                                      tick.state.tool_contact ? &*tick.state.tool_contact : nullptr, *joint,
                                      world::nut_centre(world, tick.setup, *joint), std::nullopt};
        film.camera.glide_to(view::find_view(target, film.visibility, film.camera.goal));
        film.followed_joint = joint;
    }
    (void)film.camera.advance(frame.seconds);
    scene::fade_near_arms(world, Vec3(view::viewpoint_of(film.camera.shown).eye));
}

void label_system(scene::SceneWorld& world, FilmFrame& frame) {
    FilmState& film = frame.film;
    film.scene.labels.clear();
    if (const auto label = scene::work_label(film.options.words, frame.tick.lesson, frame.tick.setup, world))
        film.scene.labels.push_back(*label);
}

void present_system(scene::SceneWorld& world, FilmFrame& frame) {
    scene::appearance_system(world);
    view::collect_objects(world, frame.film.scene);
}

// The systems of a picture, in the order in which they run: a film needs only these of the systems of a
// lesson (trainer::frame_systems).
constexpr ecs::System<scene::SceneWorld, FilmFrame> film_systems[] = {{"placement", placement_system},
                                                                      {"view", view_system},
                                                                      {"labels", label_system},
                                                                      {"present", present_system}};

}  // namespace

Film::Film(std::unique_ptr<FilmState> state) : state_(std::move(state)) {}
Film::~Film() = default;

scene::SceneWorld& Film::world() { return state_->workplace.world; }

Result<std::unique_ptr<Film>> Film::create(const session::SessionSetup& start, const FilmOptions& options) {
    auto film = std::make_unique<FilmState>();
    film->options = options;
    GpuResources& gpu = film->gpu;
    Result<scene::LessonModels> models = scene::load_lesson_models(start.assembly, options.hand);
    if (!models) return fail(models.error());
    view::Viewpoint first = view::default_viewpoint({}, view::default_fov, 1.0F);
    if (!options.view.empty()) {
        const Result<view::Viewpoint> named = view::named_view(models->machine, options.view);
        if (!named) return fail(named.error());
        first = *named;
    } else if (!models->machine.views.empty()) {
        first = models->machine.views.front();
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
    Result<std::unique_ptr<scene::GpuLessonModels>> uploaded =
        scene::upload(*gpu.gpu_context.device, *models);
    if (!uploaded) return fail(uploaded.error());
    gpu.models = std::move(*uploaded);
    scene::SceneWorld world;
    world::add_haptics(world, start.state);
    Result<scene::Workplace> workplace =
        scene::make_workplace(std::move(world), *models, *gpu.models, start.assembly, start.setup);
    if (!workplace) return fail(workplace.error());
    film->workplace = std::move(*workplace);
    film->scene = scene::make_lit_scene(film->workplace, gpu.models->light);
    film->postures =
        scene::make_postures(start.state.tool_contact ? &start.state.tool_contact->wrench : nullptr,
                             start.setup.wrench.handle_length, options.hand, scene::widest_nut(start.setup));
    film->workplace.world.only<world::WorkingHand>().rest =
        scene::wrench_rest_pose(film->workplace.machine, start.assembly.wrench.head_thickness, options.hand);
    if (options.view.empty() && models->machine.views.empty())
        first = view::default_viewpoint(
            film->workplace.machine, view::default_fov,
            static_cast<float>(options.size.width) / static_cast<float>(options.size.height));
    film->shoulder = scene::shoulder_position(film->workplace.machine, {options.hand, std::nullopt});
    film->camera.jump(view::orbit_of(first));
    return std::unique_ptr<Film>(new Film(std::move(film)));
}

Result<render::Picture> Film::draw(const session::ReplayTick& tick, double seconds) {
    FilmState& film = *state_;
    FilmFrame frame{film, tick, seconds};
    ecs::run(film_systems, film.workplace.world, frame);
    const VkExtent2D size = film.options.size;
    const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
    std::vector<render::Eye> eyes;
    for (const float aside : view::eye_offsets(film.options.stereo))
        eyes.push_back(view::eye_of(film.camera.shown, render::bounds(film.scene), aspect, aside));
    const view::GpuContext& gpu = film.gpu.gpu_context;
    BOLT_TRY_ASSIGN(const auto pictures,
                    render::take_pictures(*gpu.device, *gpu.frames, *gpu.renderer, film.scene, eyes, size));
    return view::side_by_side(pictures);
}

Status Film::check_validation() const {
    const std::vector<std::string>& messages = state_->gpu.instance->log().messages;
    if (messages.empty()) return {};
    return fail(ErrorCode::failed, messages.front());
}

}  // namespace bolt::film
