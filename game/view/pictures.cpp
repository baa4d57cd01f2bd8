#include "game/view/pictures.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <glm/common.hpp>

#include "engine/assets/image.hpp"
#include "engine/base/file.hpp"
#include "engine/base/result.hpp"
#include "engine/render/renderer.hpp"
#include "game/view/labels.hpp"
#include "game/view/stage.hpp"

namespace bolt::view {

Result<VkExtent2D> parse_size(const std::string& text) {
    unsigned width = 0, height = 0;
    char rest = 0;
    const bool read = std::sscanf(text.c_str(), "%ux%u%c", &width, &height, &rest) == 2;
    if (!read || width < 1 || height < 1 || width > 8192 || height > 8192)
        return fail(ErrorCode::usage, fmt::format("--size \"{}\" is no size", text),
                    "WIDTHxHEIGHT, up to 8192x8192");
    return VkExtent2D{width, height};
}

std::filesystem::path pipeline_file() {
    const auto folder = [](const char* variable) {
        const char* value = std::getenv(variable);
        return std::filesystem::path(value != nullptr ? value : "");
    };
    if (const auto cache = folder("XDG_CACHE_HOME"); cache.is_absolute())
        return cache / "boltwright" / "pipelines";
    if (const auto home = folder("HOME"); home.is_absolute())
        return home / ".cache" / "boltwright" / "pipelines";
    return {};
}

Result<Painter> make_painter(const gpu::Instance& instance, const gpu::DeviceOptions& on,
                             const render::RendererOptions& options) {
    Painter painter;
    BOLT_TRY_ASSIGN(auto device, gpu::Device::create(instance, on));
    painter.device = std::move(device);
    BOLT_TRY_ASSIGN(auto frames, gpu::Frames::create(*painter.device));
    painter.frames = std::move(frames);
    render::RendererOptions with_cache = options;
    if (with_cache.pipeline_cache.empty()) with_cache.pipeline_cache = pipeline_file();
    BOLT_TRY_ASSIGN(auto renderer, render::Renderer::create(*painter.device, with_cache));
    painter.renderer = std::move(renderer);
    return painter;
}

std::vector<float> eyes_aside(bool stereo) {
    if (!stereo) return {0.0F};
    return {-0.5F * eye_distance, 0.5F * eye_distance};
}

glm::mat4 converging(float aside, float distance, const render::Perspective& lens) {
    glm::mat4 shear(1.0F);
    shear[3][0] = aside / (distance * std::tan(0.5F * lens.fov) * lens.aspect);  // x + this · w
    return shear;
}

render::Picture side_by_side(std::span<const render::Picture> pictures) {
    render::Picture all{0, pictures.front().height, {}};
    for (const render::Picture& picture : pictures) all.width += picture.width;
    for (std::size_t y = 0; y < all.height; ++y)
        for (const render::Picture& picture : pictures) {
            const std::size_t row = std::size_t{4} * picture.width;
            const auto begin = picture.rgba.begin() + static_cast<std::ptrdiff_t>(row * y);
            all.rgba.insert(all.rgba.end(), begin, begin + static_cast<std::ptrdiff_t>(row));
        }
    return all;
}

Status write_picture(const render::Picture& picture, const std::filesystem::path& file) {
    BOLT_TRY_ASSIGN(const auto png, assets::encode_png(static_cast<int>(picture.width),
                                                       static_cast<int>(picture.height), 4, picture.rgba));
    std::error_code ignored;  // write_file says why
    if (const auto folder = file.parent_path(); !folder.empty())
        std::filesystem::create_directories(folder, ignored);
    BOLT_TRY(write_file(file, png));
    return print(file.string() + "\n");
}

namespace {

// Which joint it is and what became of it, above the joint: colour alone does not tell everybody.
Status add_joint(Stage& stage, const Subject& subject, const std::string& node,
                 const lesson::JointResult& joint) {
    const glm::vec4 color = verdict_color(joint);
    BOLT_TRY(outline(stage, subject, node, color));
    BOLT_TRY_ASSIGN(const auto box, box_of(stage, subject, node));
    if (box.empty() || color.w == 0.0F) return {};
    render::Label label;
    label.text = fmt::format(
        "{} {} {:.0f} N·m", joint.id,
        joint.condition == joint::Condition::sound ? lesson::name(joint.overall) : "DAMAGED", joint.torque);
    label.position = {0.5F * (box.low.x + box.high.x), box.high.y, 0.5F * (box.low.z + box.high.z)};
    label.height = 15.0F;
    label.anchor = {0.5F, 0.0F};
    label.moved_px = {0.0F, 10.0F};
    label.plate = {0.08F, 0.09F, 0.1F, 0.85F};
    label.color = glm::vec4(glm::mix(glm::vec3(color), glm::vec3(1.0F), 0.35F), 1.0F);
    label.through = 1.0F;
    stage.scene.labels.push_back(label);
    return {};
}

}  // namespace

glm::vec4 verdict_color(const lesson::JointResult& joint) { return color_of({}, verdict_of(joint)); }

Status draw_result(const content::Assembly& assembly, const lesson::LessonResult& result,
                   const std::filesystem::path& folder, VkExtent2D size) {
    if (assembly.models.model.empty() || assembly.views.empty()) return {};
    LoadedSubject loaded = load_subject(assembly.file);
    if (!loaded.ok()) return fail(loaded.errors.front());
    BOLT_TRY_ASSIGN(const auto radiance, load_light("studio"));
    BOLT_TRY_ASSIGN(auto instance, gpu::Instance::create({}));
    BOLT_TRY_ASSIGN(auto painter, make_painter(instance, {}));
    BOLT_TRY_ASSIGN(auto light, render::upload_environment(*painter.device, radiance));
    BOLT_TRY_ASSIGN(const auto stage, set_stage(*painter.device, loaded.subject, light));
    for (std::size_t i = 0; i < assembly.joints.size() && i < result.joints.size(); ++i) {
        if (assembly.joints[i].node.empty()) continue;
        const std::string& node = assembly.joints[i].node;
        BOLT_TRY(add_joint(*stage, loaded.subject, node, result.joints[i]));
    }
    BOLT_TRY_ASSIGN(const auto fonts, text::load_fonts());
    const std::vector<render::Label> labels = (stage)->scene.labels;
    const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
    for (const Viewpoint& view : loaded.subject.views) {
        const float fov = view.fov > 0.0F ? view.fov : usual_fov;
        const render::Eye eye =
            render::make_eye(view.eye, view.target, lens((stage)->box, view.eye, view.target, fov, aspect));
        (stage)->scene.labels = labels;
        move_apart(fonts, (stage)->scene.labels, eye, {size.width, size.height});
        BOLT_TRY_ASSIGN(const auto pictures,
                        render::take_pictures(*painter.device, *painter.frames, *painter.renderer,
                                              (stage)->scene, {&eye, 1}, size));
        BOLT_TRY(write_picture(pictures.front(), folder / ("view-" + view.name + ".png")));
    }
    (void)painter.renderer->save_pipelines();  // without them the next start is slower, no more
    return {};
}

}  // namespace bolt::view
