// boltwright render: pictures of an assembly or of any .glb, without a display.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "content/format/load.hpp"
#include "engine/assets/gltf.hpp"
#include "engine/assets/image.hpp"
#include "engine/assets/radiance_file.hpp"
#include "engine/base/console.hpp"
#include "engine/base/file.hpp"
#include "engine/base/nearest.hpp"
#include "engine/render/camera.hpp"
#include "engine/render/picture.hpp"
#include "game/cli/commands.hpp"

namespace bolt::cli {

namespace {

struct RenderOptions {
    std::string what, png = "out/render.png", timings, light = "studio", gpu;
    std::vector<std::string> views;
    std::string eye, target, size = "1280x720";
    double fov_deg = 35.0, level_error_px = 0.0;
    int frames = 1;
    bool stereo = false, validate = false, no_key = false;
};

struct Pose {
    std::string name;  // empty: the only one
    glm::vec3 eye{0.0F}, target{0.0F};
    float fov = 0.0F;
};

constexpr float eye_distance = 0.063F;  // m, the mean of adults

Result<glm::vec3> parse_point(const std::string& text, const char* option) {
    glm::vec3 v(0.0F);
    char rest = 0;
    if (std::sscanf(text.c_str(), "%f,%f,%f%c", &v.x, &v.y, &v.z, &rest) != 3)
        return fail(ErrorCode::usage, fmt::format("{} \"{}\" is no point", option, text), "X,Y,Z in metres");
    return v;
}

Result<VkExtent2D> parse_size(const std::string& text) {
    unsigned width = 0, height = 0;
    char rest = 0;
    const bool read = std::sscanf(text.c_str(), "%ux%u%c", &width, &height, &rest) == 2;
    if (!read || width < 1 || height < 1 || width > 8192 || height > 8192)
        return fail(ErrorCode::usage, fmt::format("--size \"{}\" is no size", text),
                    "WIDTHxHEIGHT, up to 8192x8192");
    return VkExtent2D{width, height};
}

bool is_model_file(const std::string& what) {
    const std::string extension = std::filesystem::path(what).extension().string();
    return extension == ".glb" || extension == ".gltf";
}

// The named view of the assembly.
Result<Pose> named_view(const content::Assembly& assembly, const std::string& name) {
    std::vector<std::string> names;
    for (const content::View& view : assembly.views) {
        if (view.name == name)
            return Pose{name, glm::vec3(view.eye), glm::vec3(view.target),
                        static_cast<float>(view.field_of_view)};
        names.push_back(view.name);
    }
    const std::string near = nearest(name, names);
    return fail(
        ErrorCode::usage, fmt::format("{} has no view \"{}\"", assembly.name, name),
        near.empty() ? fmt::format("one of its {} views", names.size()) : fmt::format("\"{}\"", near));
}

// A key light over the viewer's left shoulder, as a photographer sets it.
render::SceneLight key_light() {
    render::SceneLight key;
    key.light.direction = glm::vec4(glm::normalize(glm::vec3(0.45F, -1.0F, -0.55F)), 0.0F);
    key.light.color = glm::vec4(1.6F, 1.55F, 1.5F, 0.0F);
    key.casts_shadow = true;
    return key;
}

std::string file_of(const RenderOptions& options, const Pose& pose, std::size_t poses) {
    if (poses < 2) return options.png;
    const std::filesystem::path path(options.png);
    return (path.parent_path() /
            fmt::format("{}-{}{}", path.stem().string(), pose.name, path.extension().string()))
        .string();
}

// Pictures side by side.
render::Picture joined(const std::vector<render::Picture>& pictures) {
    render::Picture all{0, pictures.front().height, {}};
    for (const render::Picture& picture : pictures) all.width += picture.width;
    for (std::uint32_t y = 0; y < all.height; ++y)
        for (const render::Picture& picture : pictures) {
            const auto row =
                picture.rgba.begin() + static_cast<std::ptrdiff_t>(std::size_t{4} * picture.width * y);
            all.rgba.insert(all.rgba.end(), row,
                            row + static_cast<std::ptrdiff_t>(std::size_t{4} * picture.width));
        }
    return all;
}

// What is drawn, and from where.
struct Subject {
    assets::Model model;
    std::vector<Pose> poses;  // empty: framed by itself
};

Result<Subject> load_subject(const RenderOptions& options) {
    Subject subject;
    std::string file = options.what;
    if (!is_model_file(options.what)) {
        const content::Loaded loaded = content::load_assembly(options.what);
        if (!loaded.ok()) return fail(loaded.errors.front());
        file = loaded.assembly.models.model;
        if (file.empty())
            return fail(ErrorCode::bad_content,
                        fmt::format("{} names no model to draw", loaded.assembly.file),
                        "\"model\": \"NAME.glb\"");
        for (const std::string& name : options.views) {
            Result<Pose> pose = named_view(loaded.assembly, name);
            if (!pose) return fail(pose.error());
            subject.poses.push_back(*pose);
        }
    } else if (!options.views.empty()) {
        return fail(ErrorCode::usage, "a bare model has no named views", "--eye X,Y,Z --target X,Y,Z");
    }
    Result<assets::Model> model = assets::read_gltf(file);
    if (!model) return fail(model.error());
    subject.model = std::move(*model);
    return subject;
}

Result<shading::RadianceImage> load_light(const std::string& name) {
    if (name == "studio") return shading::studio();
    return assets::read_hdr(name);
}

struct FrameTime {
    double milliseconds = 0.0;
    std::vector<gpu::Timing> passes;
};

std::string timings_json(const std::string& device, const render::Statistics& statistics,
                         const std::vector<FrameTime>& times) {
    nlohmann::ordered_json json{
        {"device", device}, {"triangles", statistics.triangles}, {"draws", statistics.draws}};
    std::vector<double> sorted;
    for (const FrameTime& time : times) {
        nlohmann::ordered_json passes;
        for (const gpu::Timing& pass : time.passes) passes[pass.name] = pass.milliseconds;
        json["frames"].push_back({{"ms", time.milliseconds}, {"gpu_ms", passes}});
        sorted.push_back(time.milliseconds);
    }
    std::sort(sorted.begin(), sorted.end());
    json["median_ms"] = sorted[sorted.size() / 2];
    return json.dump(1) + "\n";
}

Status render_all(const RenderOptions& options) {
    const Result<VkExtent2D> extent = parse_size(options.size);
    if (!extent) return fail(extent.error());
    Result<Subject> subject = load_subject(options);
    if (!subject) return fail(subject.error());
    const Result<shading::RadianceImage> radiance = load_light(options.light);
    if (!radiance) return fail(radiance.error());

    gpu::InstanceOptions instance_options;
    instance_options.validation = options.validate;
    Result<gpu::Instance> instance = gpu::Instance::create(instance_options);
    if (!instance) return fail(instance.error());
    Result<std::unique_ptr<gpu::Device>> device = gpu::Device::create(*instance, {options.gpu});
    if (!device) return fail(device.error());
    Result<std::unique_ptr<gpu::Frames>> frames = gpu::Frames::create(**device);
    if (!frames) return fail(frames.error());
    render::RendererOptions renderer_options;
    renderer_options.level_error_px = static_cast<float>(options.level_error_px);
    Result<std::unique_ptr<render::Renderer>> renderer = render::Renderer::create(**device, renderer_options);
    if (!renderer) return fail(renderer.error());
    Result<render::GpuModel> model =
        render::upload_model(**device, subject->model, {options.level_error_px > 0.0});
    if (!model) return fail(model.error());
    Result<render::EnvironmentLight> light = render::upload_environment(**device, *radiance);
    if (!light) return fail(light.error());

    render::Scene scene;
    render::place(scene, subject->model, *model);
    if (scene.objects.empty())
        return fail(ErrorCode::bad_content, fmt::format("{}: nothing in it can be drawn", options.what),
                    "a mesh in the default scene");
    render::place_lights(scene, subject->model);
    if (scene.lights.empty() && !options.no_key) scene.lights.push_back(key_light());
    scene.environment = &*light;
    scene.background = {0.32F, 0.34F, 0.36F, 1.0F};

    const render::Box box = render::bounds(scene);
    scene.occlusion_radius = 0.04F * glm::distance(box.low, box.high);
    render::Perspective lens;
    lens.aspect = static_cast<float>(extent->width) / static_cast<float>(extent->height);
    lens.fov = static_cast<float>(to_radians(options.fov_deg));
    std::vector<Pose> poses = subject->poses;
    if (poses.empty()) {
        Pose pose;
        pose.target = 0.5F * (box.low + box.high);
        pose.eye = render::framing_eye(box, {0.55F, 0.5F, 1.0F}, lens);
        for (const auto& [text, point, name] :
             {std::tuple{&options.target, &pose.target, "--target"}, {&options.eye, &pose.eye, "--eye"}}) {
            if (text->empty()) continue;
            Result<glm::vec3> given = parse_point(*text, name);
            if (!given) return fail(given.error());
            *point = *given;
        }
        poses.push_back(pose);
    }
    for (const Pose& pose : poses) {
        if (pose.eye == pose.target) return fail(ErrorCode::usage, "eye and target are the same point");
        if (pose.fov > 0.0F) lens.fov = pose.fov;
        const float reach =
            glm::distance(pose.eye, 0.5F * (box.low + box.high)) + 0.5F * glm::distance(box.low, box.high);
        lens.zfar = 1.05F * reach;
        lens.znear = 0.005F * reach;
        const glm::vec3 right =
            glm::normalize(glm::vec3(glm::transpose(render::look_at(pose.eye, pose.target))[0]));
        std::vector<render::Eye> eyes;
        for (const float side : options.stereo ? std::vector{-0.5F, 0.5F} : std::vector{0.0F})
            eyes.push_back(render::make_eye(pose.eye + side * eye_distance * right,
                                            pose.target + side * eye_distance * right, lens));
        std::vector<render::Picture> pictures;
        std::vector<FrameTime> times;
        for (int frame = 0; frame < options.frames; ++frame) {
            const auto start = std::chrono::steady_clock::now();
            Result<std::vector<render::Picture>> taken =
                render::take_pictures(**device, **frames, **renderer, scene, eyes, *extent);
            if (!taken) return fail(taken.error());
            pictures = std::move(*taken);
            const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
            times.push_back({spent.count(), (*frames)->timings()});
        }
        const render::Picture picture = joined(pictures);
        const Result<std::string> png = assets::encode_png(static_cast<int>(picture.width),
                                                           static_cast<int>(picture.height), 4, picture.rgba);
        if (!png) return fail(png.error());
        const std::string file = file_of(options, pose, poses.size());
        std::error_code ignored;  // write_file says why
        if (const auto folder = std::filesystem::path(file).parent_path(); !folder.empty())
            std::filesystem::create_directories(folder, ignored);
        if (Status kept = write_file(file, *png); !kept) return kept;
        if (Status said = say(file + "\n"); !said) return said;
        if (!options.timings.empty())
            if (Status kept = write_file(options.timings,
                                         timings_json((*device)->name(), (*renderer)->statistics(), times));
                !kept)
                return kept;
    }
    if (!instance->log().messages.empty()) return fail(ErrorCode::failed, instance->log().messages.front());
    return {};
}

}  // namespace

void add_render(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<RenderOptions>();
    CLI::App* command =
        app.add_subcommand("render", "Draw an assembly or a .glb into a PNG; needs no display");
    command->add_option("what", options->what, "Assembly (folder, file or name) or a .glb")->required();
    command->add_option("--view", options->views, "Named view of the assembly; several give several files");
    command->add_option("--eye", options->eye, "Where to look from: X,Y,Z in metres");
    command->add_option("--target", options->target, "Where to look to: X,Y,Z in metres");
    command->add_option("--fov", options->fov_deg, "Vertical field of view, degrees")
        ->check(CLI::Range(1.0, 150.0));
    command->add_option("--size", options->size, "WIDTHxHEIGHT in pixels");
    command->add_flag("--stereo", options->stereo, "Both eyes, side by side");
    command
        ->add_option("--level-error", options->level_error_px,
                     "Coarser levels of detail that are this near, in pixels; 0: every triangle")
        ->check(CLI::Range(0.0, 100.0));
    command->add_option("--frames", options->frames, "Draw it this often")->check(CLI::Range(1, 100000));
    command->add_option("--timings", options->timings, "Write the frames' times to this JSON file");
    command->add_option("--light", options->light, "studio, or a Radiance .hdr file");
    command->add_flag("--no-key", options->no_key, "Without the lamp that is added to a model that has none");
    command->add_option("--gpu", options->gpu, "Part of the name of the GPU to use");
    command->add_flag("--validate", options->validate,
                      "Run under the Vulkan validation layers; any message is an error");
    command->add_option("--png", options->png, "The picture; with several views NAME-VIEW.png");
    command->callback([options, &exit_code] {
        const Status done = render_all(*options);
        exit_code = done ? 0 : complain(done.error());
    });
}

}  // namespace bolt::cli
