#include "game/view/result_pictures.hpp"

#include "engine/render/picture.hpp"
#include "game/view/gpu_context.hpp"
#include "game/view/label_places.hpp"
#include "game/view/marks.hpp"
#include "game/view/palette.hpp"
#include "game/view/picture_file.hpp"

#include <fmt/format.h>

#include <glm/common.hpp>

namespace bolt::view {

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
