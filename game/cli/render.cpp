// boltwright render: pictures of an assembly or of a glTF model, without a display.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "content/format/assembly.hpp"
#include "engine/assets/pose.hpp"
#include "engine/base/file.hpp"
#include "engine/base/math.hpp"
#include "engine/base/nearest.hpp"
#include "engine/base/result.hpp"
#include "engine/render/renderer.hpp"
#include "game/cli/commands.hpp"
#include "game/lesson/fastener_names.hpp"
#include "game/session/contact_models.hpp"
#include "game/session/lesson_session.hpp"
#include "game/view/gpu_context.hpp"
#include "game/view/labels.hpp"
#include "game/view/pictures.hpp"
#include "game/view/shown_model.hpp"

namespace bolt::cli {

namespace {

struct RenderOptions {
    std::string what, variant, png = "out/render.png", timings, light = "studio", gpu;
    std::vector<std::string> views;
    std::string joint;
    view::Highlights highlights;
    std::string inset, eye, target, size = "1280x720", animation;
    double at_s = 0.0;
    double fov_deg = 35.0, level_error_px = 0.0;
    int frames = 1;
    bool stereo = false, validate = false, no_key = false, labels = false;
};

Result<glm::vec3> parse_point(const std::string& text, const char* option) {
    glm::vec3 v(0.0F);
    char rest = 0;
    if (std::sscanf(text.c_str(), "%f,%f,%f%c", &v.x, &v.y, &v.z, &rest) != 3)
        return fail(ErrorCode::usage, fmt::format("{}: \"{}\" is not a point", option, text),
                    "X,Y,Z in metres");
    return v;
}

std::string file_of(const RenderOptions& options, const view::Viewpoint& view, std::size_t views) {
    if (views < 2) return options.png;
    const std::filesystem::path path(options.png);
    return (path.parent_path() /
            fmt::format("{}-{}{}", path.stem().string(), view.name, path.extension().string()))
        .string();
}

// Finds the animation by its name, or else by its index.
Result<const assets::Animation*> find_animation(const assets::Model& model, const RenderOptions& options) {
    const std::string& requested = options.animation;
    std::vector<std::string> names;
    for (const assets::Animation& animation : model.animations) {
        if (animation.name == requested) return &animation;
        if (!animation.name.empty()) names.push_back(animation.name);
    }
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(requested.data(), requested.data() + requested.size(), index);
    if (error == std::errc() && end == requested.data() + requested.size() && index < model.animations.size())
        return &model.animations[index];
    const std::string what = fmt::format("{} has no animation \"{}\"", options.what, requested);
    if (model.animations.empty()) return fail(ErrorCode::usage, what, "a model that has animations");
    const std::string near = nearest(requested, names);
    return fail(ErrorCode::usage, what,
                near.empty() ? fmt::format("a name or an index from 0 to {}", model.animations.size() - 1)
                             : fmt::format("did you mean \"{}\"?", near));
}

// The eye of a view, moved to the right by `offset` m.
render::Eye eye_of(const RenderOptions& options, const view::Viewpoint& view, const render::BoundingBox& box,
                   float aspect, float offset = 0.0F) {
    const float fov = view.fov > 0.0F ? view.fov : static_cast<float>(to_radians(options.fov_deg));
    const render::Perspective lens = view::perspective_for(box, view.eye, view.target, fov, aspect);
    const glm::vec3 right =
        glm::normalize(glm::vec3(glm::transpose(render::look_at(view.eye, view.target))[0]));
    render::Eye eye = render::make_eye(view.eye + offset * right, view.target + offset * right, lens);
    eye.clip_from_world =
        view::convergence_shear(offset, glm::distance(view.eye, view.target), lens) * eye.clip_from_world;
    return eye;
}

// Adds a label with its name at each joint; parts in front of it make it faint.
void add_joint_labels(const view::LoadedModel& model, render::Scene& scene) {
    for (const view::JointPosition& joint : model.joints) {
        render::Label label;
        label.text = joint.id;
        label.position = joint.position;
        label.occlusion_margin = 0.05F;  // so that its own bolt does not hide it
        label.offset_px = {0.0F, 26.0F};
        label.height = 14.0F;
        label.plate = {0.08F, 0.10F, 0.12F, 0.85F};
        label.occluded_visibility = 0.35F;
        scene.labels.push_back(label);
    }
}

// Sets the model's rest pose to its pose in options.animation at options.at_s.
Status pose(assets::Model& model, const RenderOptions& options) {
    BOLT_TRY_ASSIGN(auto animation, find_animation(model, options));
    assets::ModelPose pose = assets::rest_pose(model);
    assets::apply(*animation, static_cast<float>(options.at_s), pose);
    assets::set_rest(model, pose);
    return {};
}

// The views that --view names, or else the viewpoint of --eye and --target.
Result<std::vector<view::Viewpoint>> viewpoints(const RenderOptions& options, const view::LoadedModel& model,
                                                const render::BoundingBox& box, float aspect) {
    std::vector<view::Viewpoint> views;
    for (const std::string& name : options.views) {
        BOLT_TRY_ASSIGN(auto view, view::named_view(model, name));
        views.push_back(view);
    }
    if (!views.empty()) return views;
    view::Viewpoint view =
        view::default_viewpoint(box, static_cast<float>(to_radians(options.fov_deg)), aspect);
    for (const auto& [text, point, name] :
         {std::tuple{&options.target, &view.target, "--target"}, {&options.eye, &view.eye, "--eye"}}) {
        if (text->empty()) continue;
        BOLT_TRY_ASSIGN(auto given, parse_point(*text, name));
        *point = given;
    }
    return std::vector{view};
}

// The name of the view with the greatest visible area of the joint's nut.
Result<std::string> view_of_joint(const std::string& what, const std::string& variant,
                                  const std::string& id) {
    const content::LoadedAssembly loaded = content::load_assembly(what, variant);
    if (!loaded.ok()) return fail(loaded.errors.front());
    const content::Assembly& assembly = loaded.assembly;
    const auto joint =
        std::find_if(assembly.joints.begin(), assembly.joints.end(),
                     [&](const content::AssemblyJoint& candidate) { return candidate.design.id == id; });
    if (joint == assembly.joints.end()) {
        std::vector<std::string> ids;
        for (const content::AssemblyJoint& known : assembly.joints) ids.push_back(known.design.id);
        const std::string near = nearest(id, ids);
        return fail(ErrorCode::usage, fmt::format("{} has no joint \"{}\"", what, id),
                    near.empty() ? "the id of one of its joints" : fmt::format("did you mean \"{}\"?", near));
    }
    const servo::Setup setup = session::make_setup(assembly, assembly.law, {}, 1, 1e-3);
    BOLT_TRY_ASSIGN(auto contact, session::load_tool_contact(assembly, setup));
    const auto best =
        contact ? session::best_view(session::nut_views(
                      assembly, *contact, static_cast<std::size_t>(joint - assembly.joints.begin())))
                : std::nullopt;
    if (!best)
        return fail(ErrorCode::bad_content,
                    fmt::format("no view of {} shows the {} of joint {}", what,
                                lesson::fastener_name(joint->design), id),
                    "--view, or --eye and --target");
    return assembly.views[*best].name;
}

// Loads the model, and checks that it has what the options name; replaces a joint by the view that shows it.
Result<view::LoadedModel> load_subject(RenderOptions& options) {
    view::ModelLoadResult loaded = view::load_model(options.what, view::DetailLevel::near, options.variant);
    if (!loaded.ok()) return fail(loaded.errors.front());
    if (options.labels && loaded.model.without_assembly)
        return fail(ErrorCode::usage, "a bare model has no joints to label", "an assembly");
    if (!options.animation.empty()) BOLT_TRY(pose(loaded.model.model, options));
    if (!options.joint.empty()) {
        if (loaded.model.without_assembly)
            return fail(ErrorCode::usage, "a bare model has no joint to show", "an assembly");
        BOLT_TRY_ASSIGN(auto view, view_of_joint(options.what, options.variant, options.joint));
        options.views = {std::move(view)};
    }
    std::vector<std::string> names = options.views;
    if (!options.inset.empty()) names.push_back(options.inset);
    for (const std::string& name : names) BOLT_TRY(view::named_view(loaded.model, name));
    return std::move(loaded.model);
}

// The pictures of one call share all of this.
struct Drawing {
    const RenderOptions& options;
    view::GpuContext& gpu;
    view::ShownModel& shown;
    VkExtent2D extent;
    float aspect;  // width / height
    std::vector<render::Label> labels;
    std::optional<text::Fonts> fonts;  // with labels
    std::vector<render::Inset> insets;
};

Result<Drawing> make_drawing(const RenderOptions& options, const view::LoadedModel& model,
                             view::GpuContext& gpu, view::ShownModel& shown) {
    BOLT_TRY_ASSIGN(const auto extent, view::parse_size(options.size));
    const float aspect = static_cast<float>(extent.width) / static_cast<float>(extent.height);
    Drawing drawing{options, gpu, shown, extent, aspect, {}, std::nullopt, {}};
    if (options.labels) add_joint_labels(model, shown.scene);
    drawing.labels = shown.scene.labels;
    if (!drawing.labels.empty()) {
        BOLT_TRY_ASSIGN(auto fonts, text::load_fonts());
        drawing.fonts = std::move(fonts);
    }
    if (!options.inset.empty()) {
        BOLT_TRY_ASSIGN(const auto view, view::named_view(model, options.inset));
        drawing.insets.push_back(
            {eye_of(options, view, shown.box, aspect), render::inset_rectangle(extent, 0.28F)});
    }
    return drawing;
}

struct TimedFrame {
    double milliseconds = 0.0;
    std::vector<gpu::PassTiming> passes;
};

std::string timings_json(const Drawing& drawing, const std::vector<TimedFrame>& times) {
    std::uint64_t triangles = 0, draws = 0;
    for (std::uint32_t group = 0; group <= drawing.insets.size(); ++group) {  // the view and its insets
        triangles += drawing.gpu.renderer->statistics(group).triangles;
        draws += drawing.gpu.renderer->statistics(group).draws;
    }
    nlohmann::ordered_json json{
        {"device", drawing.gpu.device->name()}, {"triangles", triangles}, {"draws", draws}};
    std::vector<double> sorted;
    for (const TimedFrame& time : times) {
        nlohmann::ordered_json passes = nlohmann::ordered_json::object();
        for (const gpu::PassTiming& pass : time.passes)  // a pass has one entry for each view
            passes[pass.name] = passes.value(pass.name, 0.0) + pass.milliseconds;
        json["frames"].push_back({{"ms", time.milliseconds}, {"gpu_ms", passes}});
        sorted.push_back(time.milliseconds);
    }
    std::sort(sorted.begin(), sorted.end());
    json["median_ms"] = sorted[sorted.size() / 2];
    return json.dump(1) + "\n";
}

// Draws one view as often as requested, and writes its picture and the times of its frames.
Status draw_view(Drawing& drawing, const view::Viewpoint& view, std::size_t view_count) {
    const RenderOptions& options = drawing.options;
    if (view.eye == view.target)
        return fail(ErrorCode::usage, "eye and target are the same point", "two different points");
    std::vector<render::Eye> eyes;
    for (const float offset : view::eye_offsets(options.stereo))
        eyes.push_back(eye_of(options, view, drawing.shown.box, drawing.aspect, offset));
    render::Scene& scene = drawing.shown.scene;
    scene.labels = drawing.labels;
    if (drawing.fonts)
        view::separate_labels(*drawing.fonts, scene.labels, eyes.front(),
                              {drawing.extent.width, drawing.extent.height});
    std::vector<render::Picture> pictures;
    std::vector<TimedFrame> times;
    for (int frame = 0; frame < options.frames; ++frame) {
        const auto start = std::chrono::steady_clock::now();
        BOLT_TRY_ASSIGN(auto taken,
                        render::take_pictures(*drawing.gpu.device, *drawing.gpu.frames, *drawing.gpu.renderer,
                                              scene, eyes, drawing.extent, drawing.insets));
        pictures = std::move(taken);
        const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
        times.push_back({spent.count(), drawing.gpu.frames->timings()});
    }
    BOLT_TRY(view::write_picture(view::side_by_side(pictures), file_of(options, view, view_count)));
    if (options.timings.empty()) return {};
    return write_file(options.timings, timings_json(drawing, times));
}

Status render_all(RenderOptions options) {
    BOLT_TRY(view::parse_size(options.size));
    BOLT_TRY_ASSIGN(const auto model, load_subject(options));
    BOLT_TRY_ASSIGN(const auto radiance, view::load_light(options.light));
    gpu::InstanceOptions instance_options;
    instance_options.validation = options.validate;
    Result<gpu::Instance> instance = gpu::Instance::create(instance_options);
    if (!instance) return fail(instance.error());
    render::RendererOptions renderer_options;
    renderer_options.level_error_px = static_cast<float>(options.level_error_px);
    BOLT_TRY_ASSIGN(auto gpu, view::make_gpu_context(*instance, {options.gpu}, renderer_options));
    BOLT_TRY_ASSIGN(auto light, render::upload_environment(*gpu.device, radiance));
    BOLT_TRY_ASSIGN(const auto shown, view::show_model(*gpu.device, model, light,
                                                       {!options.no_key, options.level_error_px > 0.0}));
    BOLT_TRY(view::highlight(*shown, model, options.highlights));
    BOLT_TRY_ASSIGN(auto drawing, make_drawing(options, model, gpu, *shown));
    BOLT_TRY_ASSIGN(const auto views, viewpoints(options, model, shown->box, drawing.aspect));
    for (const view::Viewpoint& view : views) BOLT_TRY(draw_view(drawing, view, views.size()));
    (void)gpu.renderer->save_pipelines();  // a failure only slows down the next start
    if (!instance->log().messages.empty())
        return fail(ErrorCode::failed, instance->log().messages.front(),
                    "no message of the validation layer");
    return {};
}

}  // namespace

void add_render(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<RenderOptions>();
    CLI::App* command =
        app.add_subcommand("render", "Draw an assembly or a .glb to a PNG file; needs no display");
    command->add_option("what", options->what, "Assembly (folder, file or name) or a .glb")->required();
    CLI::Option* views = command->add_option(
        "--view", options->views, "Named view of the assembly; may be given several times, one file each");
    command
        ->add_option("--joint", options->joint,
                     "Draw from the named view that shows most of this joint's nut")
        ->excludes(views);
    command->add_option("--variant", options->variant,
                        "Variant of the assembly; default: the assembly's own");
    command->add_option("--inset", options->inset, "Named view to draw small in the lower right corner");
    command->add_flag("--labels", options->labels, "Label the joints with their names");
    command->add_option("--eye", options->eye, "Position of the eye: X,Y,Z in metres");
    command->add_option("--target", options->target, "Point that the eye looks at: X,Y,Z in metres");
    command->add_option("--fov", options->fov_deg, "Vertical field of view, degrees")
        ->check(CLI::Range(1.0, 150.0));
    command->add_option("--size", options->size, "WIDTHxHEIGHT in pixels");
    command->add_flag("--stereo", options->stereo, "Both eyes, side by side");
    command
        ->add_option("--level-error", options->level_error_px,
                     "Use levels of detail with an error up to this many pixels; 0: full detail")
        ->check(CLI::Range(0.0, 100.0));
    CLI::Option* animation = command->add_option("--animation", options->animation,
                                                 "Animation that poses the model: name or index");
    command->add_option("--at", options->at_s, "Time in the animation, s")
        ->check(CLI::Range(0.0, 1e6))
        ->needs(animation);
    command->add_option("--frames", options->frames, "Number of times to draw each picture, for timings")
        ->check(CLI::Range(1, 100000));
    command->add_option("--timings", options->timings, "JSON file for the times of the frames");
    command->add_option("--outline", options->highlights.outlined, "Node to outline");
    command->add_option("--ghost", options->highlights.ghosts, "Node to draw transparent");
    command->add_option("--see", options->highlights.revealed, "Node to reveal; parts in front of it fade");
    command->add_option("--light", options->light, "Environment light: studio, or a Radiance .hdr file");
    command->add_flag("--no-key", options->no_key, "Do not add a key light to a model without lights");
    command->add_option("--gpu", options->gpu, "Part of the name of the GPU to use");
    command->add_flag("--validate", options->validate,
                      "Run under the Vulkan validation layers; any message is an error");
    command->add_option("--png", options->png, "PNG file to write; with several views NAME-VIEW.png");
    command->callback([options, &exit_code] {
        const Status done = render_all(*options);
        exit_code = done ? 0 : print_error(done.error());
    });
}

}  // namespace bolt::cli
