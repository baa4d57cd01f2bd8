#include "game/film/film.hpp"

#include <cmath>

#include "game/scene/labels.hpp"
#include "game/scene/resting_place.hpp"
#include "game/scene/strain.hpp"
#include "game/view/stereo.hpp"

namespace bolt::film {

namespace {

constexpr float level_error = 0.5F;  // px

std::optional<std::size_t> at_work(const play::Moment& moment) {
    if (moment.output.joint >= 0) return static_cast<std::size_t>(moment.output.joint);
    const lesson::Step* due = moment.lesson.due();
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

Result<std::unique_ptr<Film>> Film::create(const play::Prepared& at, const FilmOptions& options) {
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
    Result<scene::Workplace> place = scene::make_workplace(*shelf, *on.shelf, at.assembly, at.setup);
    if (!place) return fail(place.error());
    film->place_ = std::move(*place);
    film->scene_ = scene::lit(film->place_, on.shelf->light);
    film->postures_ = scene::make_postures(at.state.touch ? &at.state.touch->wrench : nullptr,
                                           at.setup.wrench.handle_length, options.hand);
    film->rest_ = scene::resting_place(film->place_.machine, at.assembly.wrench.head_thickness, options.hand);
    if (options.view.empty() && shelf->machine.views.empty())
        first =
            view::framed(film->place_.machine, view::usual_fov,
                         static_cast<float>(options.size.width) / static_cast<float>(options.size.height));
    film->camera_.jump(view::orbit_of(first));
    return film;
}

// When another joint has its turn the camera goes there.
void Film::follow(const play::Moment& moment) {
    const auto joint = at_work(moment);
    if (!options_.view.empty() || !joint || followed_ == joint) return;
    const scene::ViewOf of{
        moment.setup, moment.state.touch ? &*moment.state.touch : nullptr, *joint,
        servo::nut_centre(moment.setup.nuts[*joint], moment.state.joints[*joint].nut.angle), std::nullopt};
    camera_.go(scene::find_view(of, sight_, camera_.goal));
    followed_ = joint;
}

Result<render::Picture> Film::draw(const play::Moment& moment, double seconds) {
    const bool wrench = moment.input.grip == servo::Grip::wrench;
    scene::Held held;
    held.tool = moment.output.tool;
    held.wrench = wrench;
    held.rest = rest_;
    held.pinches = moment.input.grip == servo::Grip::fingers;
    const Vec3 shoulder = scene::shoulder_at(place_.machine, {options_.hand, std::nullopt});
    held.fingers = scene::towards(held.tool, shoulder, 0.0);
    held.grip = scene::natural_grip(postures_, held.tool, Vec3(0, 1, 0), shoulder);
    held.strain = std::abs(scene::effort(moment.output, moment.setup, wrench));
    held.seconds = seconds;
    scene::place_nuts(place_.world, moment.setup, moment.state.joints);
    scene::place_tool(place_.world, held);
    scene::place_hand(place_.world, postures_, held);
    scene_.cut_away.strength = 0.0F;
    if (const auto joint = at_work(moment); joint && moment.output.joint >= 0)
        scene::keep_in_sight(place_.world, scene_, moment.setup, moment.state, *joint);
    follow(moment);
    (void)camera_.advance(seconds);
    scene::thin_near_arms(place_.world, Vec3(view::viewpoint_of(camera_.shown).eye));
    scene::present(place_.world, scene_);

    scene_.labels.clear();
    if (const auto label = scene::work_label(options_.words, moment.lesson, moment.setup, moment.state,
                                             moment.output, wrench))
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
