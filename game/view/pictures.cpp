#include "game/view/pictures.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <glm/common.hpp>

#include "engine/assets/image.hpp"
#include "engine/base/file.hpp"
#include "engine/base/result.hpp"
#include "engine/render/renderer.hpp"
#include "game/view/gpu_context.hpp"
#include "game/view/labels.hpp"
#include "game/view/shown_model.hpp"

namespace bolt::view {

Result<VkExtent2D> parse_size(const std::string& text) {
    unsigned width = 0, height = 0;
    char rest = 0;
    const bool read = std::sscanf(text.c_str(), "%ux%u%c", &width, &height, &rest) == 2;
    if (!read || width < 1 || height < 1 || width > 8192 || height > 8192)
        return fail(ErrorCode::usage, fmt::format("--size: \"{}\" is not a size", text),
                    "WIDTHxHEIGHT, up to 8192x8192");
    return VkExtent2D{width, height};
}

std::vector<float> eye_offsets(bool stereo) {
    if (!stereo) return {0.0F};
    return {-0.5F * mean_eye_separation, 0.5F * mean_eye_separation};
}

glm::mat4 convergence_shear(float offset, float distance, const render::Perspective& lens) {
    glm::mat4 shear(1.0F);
    shear[3][0] = offset / (distance * std::tan(0.5F * lens.fov) * lens.aspect);  // adds this · w to x
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
    std::error_code ignored;  // write_file reports the error
    if (const auto folder = file.parent_path(); !folder.empty())
        std::filesystem::create_directories(folder, ignored);
    BOLT_TRY(write_file(file, png));
    return print(file.string() + "\n");
}

namespace {

// Outlines the joint and labels it with its name, verdict and torque.
Status add_joint(ShownModel& shown, const LoadedModel& model, const std::string& node,
                 const lesson::JointResult& joint) {
    const glm::vec4 color = verdict_color(joint);
    BOLT_TRY(outline(shown, model, node, color));
    BOLT_TRY_ASSIGN(const auto box, box_of(shown, model, node));
    if (box.empty() || color.w == 0.0F) return {};
    render::Label label;
    label.text = fmt::format(
        "{} {} {:.0f} N·m", joint.id,
        joint.condition == joint::JointCondition::intact ? lesson::name(joint.overall) : "DAMAGED",
        joint.torque);
    label.position = {0.5F * (box.low.x + box.high.x), box.high.y, 0.5F * (box.low.z + box.high.z)};
    label.height = 15.0F;
    label.anchor = {0.5F, 0.0F};
    label.offset_px = {0.0F, 10.0F};
    label.plate = {0.08F, 0.09F, 0.1F, 0.85F};
    label.color = glm::vec4(glm::mix(glm::vec3(color), glm::vec3(1.0F), 0.35F), 1.0F);
    label.occluded_visibility = 1.0F;
    shown.scene.labels.push_back(label);
    return {};
}

}  // namespace

glm::vec4 verdict_color(const lesson::JointResult& joint) { return color_of({}, verdict_of(joint)); }

Status draw_result(const content::Assembly& assembly, const lesson::LessonResult& result,
                   const std::filesystem::path& folder, VkExtent2D size) {
    if (assembly.models.model.empty() || assembly.views.empty()) return {};
    ModelLoadResult loaded = load_model(assembly.file, DetailLevel::near, assembly.variant);
    if (!loaded.ok()) return fail(loaded.errors.front());
    BOLT_TRY_ASSIGN(const auto radiance, load_light("studio"));
    BOLT_TRY_ASSIGN(auto instance, gpu::Instance::create({}));
    BOLT_TRY_ASSIGN(auto gpu_context, make_gpu_context(instance, {}));
    BOLT_TRY_ASSIGN(auto light, render::upload_environment(*gpu_context.device, radiance));
    BOLT_TRY_ASSIGN(const auto shown, show_model(*gpu_context.device, loaded.model, light));
    for (std::size_t i = 0; i < assembly.joints.size() && i < result.joints.size(); ++i) {
        if (assembly.joints[i].node.empty()) continue;
        const std::string& node = assembly.joints[i].node;
        BOLT_TRY(add_joint(*shown, loaded.model, node, result.joints[i]));
    }
    BOLT_TRY_ASSIGN(const auto fonts, text::load_fonts());
    const std::vector<render::Label> labels = shown->scene.labels;
    const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
    for (const Viewpoint& view : loaded.model.views) {
        const float fov = view.fov > 0.0F ? view.fov : default_fov;
        const render::Eye eye = render::make_eye(
            view.eye, view.target, perspective_for(shown->box, view.eye, view.target, fov, aspect));
        shown->scene.labels = labels;
        separate_labels(fonts, shown->scene.labels, eye, {size.width, size.height});
        BOLT_TRY_ASSIGN(const auto pictures,
                        render::take_pictures(*gpu_context.device, *gpu_context.frames, *gpu_context.renderer,
                                              shown->scene, {&eye, 1}, size));
        BOLT_TRY(write_picture(pictures.front(), folder / ("view-" + view.name + ".png")));
    }
    (void)gpu_context.renderer->save_pipelines();  // a failure only slows down the next start
    return {};
}

}  // namespace bolt::view
