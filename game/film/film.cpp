#include "game/film/film.hpp"

#include <cmath>

#include "game/scene/annotations.hpp"
#include "game/scene/postures.hpp"
#include "game/scene/workplace.hpp"
#include "game/view/pictures.hpp"
#include "game/world/world.hpp"

namespace bolt::film {

namespace {

constexpr float level_error = 0.5F;  // px

std::optional<std::size_t> at_work(const scene::World& world, const lesson::Lesson& lesson) {
    if (const std::int16_t held = world.only<world::ToolContact>().joint; held >= 0)
        return static_cast<std::size_t>(held);
    const lesson::Step* due = lesson.due();
    return due != nullptr ? std::optional(due->joint) : std::nullopt;
}

}  // namespace

struct Film::OnGpu {
    std::optional<gpu::Instance> instance;
    view::Painter painter;
    std::unique_ptr<scene::GpuShelf> shelf;
    ~OnGpu() {
        if (painter.device) (void)painter.device->idle();
    }
};

Film::~Film() = default;

Result<std::unique_ptr<Film>> Film::create(const session::Prepared& at, const FilmOptions& options) {
    std::unique_ptr<Film> film(new Film);
    film->options_ = options;
    film->assembly_ = at.assembly;
    film->on_ = std::make_unique<OnGpu>();
    OnGpu& on = *film->on_;
    Result<scene::Shelf> shelf = scene::load_shelf(at.assembly, options.hand);
    if (!shelf) return fail(shelf.error());
    view::Viewpoint first = view::framed({}, view::usual_fov, 1.0F);
    if (!options.view.empty()) {
        const Result<view::Viewpoint> named = view::named_view(shelf->machine, options.view);
        if (!named) return fail(named.error());
        first = *named;
    } else if (!shelf->machine.views.empty()) {
        first = shelf->machine.views.front();
    }
    gpu::InstanceOptions instance_options;
    instance_options.validation = options.validate;
    Result<gpu::Instance> instance = gpu::Instance::create(instance_options);
    if (!instance) return fail(instance.error());
    on.instance.emplace(std::move(*instance));
    render::RendererOptions renderer;
    renderer.level_error_px = level_error;
    Result<view::Painter> painter = view::make_painter(*on.instance, {options.gpu}, renderer);
    if (!painter) return fail(painter.error());
    on.painter = std::move(*painter);
    Result<std::unique_ptr<scene::GpuShelf>> up = scene::upload(*on.painter.device, *shelf);
    if (!up) return fail(up.error());
    on.shelf = std::move(*up);
    scene::World world;
    world::add_haptics(world, at.state);
    Result<scene::Workplace> place =
        scene::make_workplace(std::move(world), *shelf, *on.shelf, at.assembly, at.setup);
    if (!place) return fail(place.error());
    film->place_ = std::move(*place);
    film->scene_ = scene::lit(film->place_, on.shelf->light);
    film->postures_ =
        scene::make_postures(at.state.tool_contact ? &at.state.tool_contact->wrench : nullptr,
                             at.setup.wrench.handle_length, options.hand, scene::widest_nut(at.setup));
    film->place_.world.only<world::Hand>().rest =
        scene::resting_place(film->place_.machine, at.assembly.wrench.head_thickness, options.hand);
    if (options.view.empty() && shelf->machine.views.empty())
        first =
            view::framed(film->place_.machine, view::usual_fov,
                         static_cast<float>(options.size.width) / static_cast<float>(options.size.height));
    film->camera_.jump(view::orbit_of(first));
    return film;
}

// When another joint has its turn the camera goes there.
void Film::follow(const session::Moment& moment) {
    const auto joint = at_work(place_.world, moment.lesson);
    if (!options_.view.empty() || !joint || followed_ == joint) return;
    const view::ViewOf of{moment.setup, moment.state.tool_contact ? &*moment.state.tool_contact : nullptr,
                          *joint, world::nut_centre(place_.world, moment.setup, *joint), std::nullopt};
    camera_.go(view::find_view(of, sight_, camera_.goal));
    followed_ = joint;
}

Result<render::Picture> Film::draw(const session::Moment& moment, double seconds) {
    const world::Hand& hand = place_.world.only<world::Hand>();
    scene::Held held;
    held.tool = place_.world.only<world::Tool>().pose;
    held.wrench = hand.wrench;
    held.rest = hand.rest;
    held.pinches = hand.pinches;
    const Vec3 shoulder = scene::shoulder_at(place_.machine, {options_.hand, std::nullopt});
    held.fingers = scene::towards(held.tool, shoulder, 0.0);
    held.grip = scene::natural_grip(postures_, held.tool, Vec3(0, 1, 0), shoulder);
    held.strain = std::abs(scene::effort(moment.setup, place_.world));
    held.seconds = seconds;
    held.solids = moment.state.tool_contact ? &moment.state.tool_contact->world : nullptr;
    scene::place_nuts(place_.world, moment.setup);
    scene::place_tool(place_.world, held);
    scene::place_hand(place_.world, postures_, held);
    scene_.cut_away.strength = 0.0F;
    if (const std::int16_t held_joint = place_.world.only<world::ToolContact>().joint; held_joint >= 0)
        scene::keep_in_sight(place_.world, scene_, moment.setup, static_cast<std::size_t>(held_joint));
    follow(moment);
    (void)camera_.advance(seconds);
    scene::thin_near_arms(place_.world, Vec3(view::viewpoint_of(camera_.shown).eye));
    scene::present(place_.world, scene_);

    scene_.labels.clear();
    if (const auto label = scene::work_label(options_.words, moment.lesson, moment.setup, place_.world))
        scene_.labels.push_back(*label);
    const float aspect = static_cast<float>(options_.size.width) / static_cast<float>(options_.size.height);
    std::vector<render::Eye> eyes;
    for (const float aside : view::eyes_aside(options_.stereo))
        eyes.push_back(view::eye_of(camera_.shown, render::bounds(scene_), aspect, aside));

    OnGpu& on = *on_;
    auto pictures = render::take_pictures(*on.painter.device, *on.painter.frames, *on.painter.renderer,
                                          scene_, eyes, options_.size);
    if (!pictures) return fail(pictures.error());
    return view::side_by_side(*pictures);
}

Status Film::no_messages() const {
    const std::vector<std::string>& messages = on_->instance->log().messages;
    if (messages.empty()) return {};
    return fail(ErrorCode::failed, messages.front());
}

}  // namespace bolt::film
