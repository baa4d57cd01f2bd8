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

}  // namespace

struct Film::GpuResources {
    std::optional<gpu::Instance> instance;
    view::GpuContext gpu_context;
    std::unique_ptr<scene::GpuLessonModels> models;
    ~GpuResources() {
        if (gpu_context.device) (void)gpu_context.device->idle();
    }
};

Film::~Film() = default;

Result<std::unique_ptr<Film>> Film::create(const session::SessionSetup& start, const FilmOptions& options) {
    std::unique_ptr<Film> film(new Film);
    film->options_ = options;
    film->assembly_ = start.assembly;
    film->gpu_ = std::make_unique<GpuResources>();
    GpuResources& gpu = *film->gpu_;
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
    film->workplace_ = std::move(*workplace);
    film->scene_ = scene::make_lit_scene(film->workplace_, gpu.models->light);
    film->postures_ =
        scene::make_postures(start.state.tool_contact ? &start.state.tool_contact->wrench : nullptr,
                             start.setup.wrench.handle_length, options.hand, scene::widest_nut(start.setup));
    film->workplace_.world.only<world::WorkingHand>().rest =
        scene::wrench_rest_pose(film->workplace_.machine, start.assembly.wrench.head_thickness, options.hand);
    if (options.view.empty() && models->machine.views.empty())
        first = view::default_viewpoint(
            film->workplace_.machine, view::default_fov,
            static_cast<float>(options.size.width) / static_cast<float>(options.size.height));
    film->camera_.jump(view::orbit_of(first));
    return film;
}

// Moves the camera to the active joint when it changes.
void Film::update_camera(const session::ReplayTick& tick) {
    const auto joint = active_joint(workplace_.world, tick.lesson);
    if (!options_.view.empty() || !joint || followed_joint_ == joint) return;
    const view::ViewTarget of{tick.setup, tick.state.tool_contact ? &*tick.state.tool_contact : nullptr,
                              *joint, world::nut_centre(workplace_.world, tick.setup, *joint), std::nullopt};
    camera_.glide_to(view::find_view(of, visibility_, camera_.goal));
    followed_joint_ = joint;
}

Result<render::Picture> Film::draw(const session::ReplayTick& tick, double seconds) {
    const world::WorkingHand& hand = workplace_.world.only<world::WorkingHand>();
    scene::ToolAndHand held;
    held.tool = workplace_.world.only<world::HeldTool>().pose;
    held.wrench = hand.wrench;
    held.rest = hand.rest;
    held.pinches = hand.pinches;
    const Vec3 shoulder = scene::shoulder_position(workplace_.machine, {options_.hand, std::nullopt});
    held.fingers = scene::frame_towards(held.tool, shoulder, 0.0);
    held.grip = scene::natural_grip(postures_, held.tool, Vec3(0, 1, 0), shoulder);
    held.effort = std::abs(scene::relative_torque(tick.setup, workplace_.world));
    held.seconds = seconds;
    held.solids = tick.state.tool_contact ? &tick.state.tool_contact->world : nullptr;
    scene::place_nuts(workplace_.world, tick.setup);
    scene::place_tool(workplace_.world, held);
    scene::place_hand(workplace_.world, postures_, held);
    scene_.cut_away.strength = 0.0F;
    if (const std::int16_t held_joint = workplace_.world.only<world::ContactState>().joint; held_joint >= 0)
        scene::fade_occluders(workplace_.world, scene_, tick.setup, static_cast<std::size_t>(held_joint));
    update_camera(tick);
    (void)camera_.advance(seconds);
    scene::fade_near_arms(workplace_.world, Vec3(view::viewpoint_of(camera_.shown).eye));
    scene::collect_objects(workplace_.world, scene_);

    scene_.labels.clear();
    if (const auto label = scene::work_label(options_.words, tick.lesson, tick.setup, workplace_.world))
        scene_.labels.push_back(*label);
    const float aspect = static_cast<float>(options_.size.width) / static_cast<float>(options_.size.height);
    std::vector<render::Eye> eyes;
    for (const float aside : view::eye_offsets(options_.stereo))
        eyes.push_back(view::eye_of(camera_.shown, render::bounds(scene_), aspect, aside));

    GpuResources& gpu = *gpu_;
    auto pictures = render::take_pictures(*gpu.gpu_context.device, *gpu.gpu_context.frames,
                                          *gpu.gpu_context.renderer, scene_, eyes, options_.size);
    if (!pictures) return fail(pictures.error());
    return view::side_by_side(*pictures);
}

Status Film::check_validation() const {
    const std::vector<std::string>& messages = gpu_->instance->log().messages;
    if (messages.empty()) return {};
    return fail(ErrorCode::failed, messages.front());
}

}  // namespace bolt::film
