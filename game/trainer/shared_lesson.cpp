#include "game/trainer/shared_lesson.hpp"

#include <utility>

#include "content/format/assembly.hpp"
#include "game/trainer/room_state.hpp"

namespace bolt::trainer {

namespace {

view::StreamedModels streamed(const scene::GpuLessonModels& models) {
    view::StreamedModels streamed{
        {&models.workpiece, &models.workshop, &models.hand, &models.arrows, &models.dial}, &models.light};
    for (const render::GpuModel& tool : models.tools) streamed.models.push_back(&tool);
    for (const auto& [size, wrench] : models.second_wrenches) streamed.models.push_back(&wrench);
    return streamed;
}

Error unknown_scene() {
    return {ErrorCode::failed, "the lesson that another process sent cannot be shown",
            "the same program in all processes"};
}

}  // namespace

render::Scene empty_room() {
    render::Scene scene;
    scene.background = {0.02F, 0.025F, 0.035F, 1.0F};
    return scene;
}

void LessonSender::write(cluster::MessageWriter& message, cluster::MessageWriter& bulk,
                         const SharedFrame& frame) {
    const std::uint32_t lesson = frame.models != nullptr ? frame.lesson : 0;
    message.put(lesson);
    const bool is_new_lesson = lesson != lesson_;
    // After a new upload the models have other addresses, so the scene cannot be compared with the last one.
    if (is_new_lesson || frame.on_gpu != on_gpu_) scene_.restart();
    lesson_ = lesson;
    on_gpu_ = frame.on_gpu;
    message.put(is_new_lesson);
    if (is_new_lesson && frame.models != nullptr) {
        for (const std::string* text : {&frame.models->assembly, &frame.models->variant, &frame.models->tool})
            message.put_text(*text);
        message.put(frame.models->side);
    }
    message.put_pose(frame.scene_in_room);
    message.put(frame.panel.has_value());
    if (frame.panel) {
        message.put_pose(*frame.panel);
        message.put(frame.panel_point_size);
        message.put(panel.write(bulk));
    }
    message.put(frame.ray.has_value());
    if (frame.ray)
        for (const Vec3& end : {frame.ray->from, frame.ray->to}) message.put_pose({end});
    if (frame.ray) message.put(frame.ray->pressed);
    if (lesson == 0) return;
    cluster::MessageWriter scene;
    scene_.write(scene, *frame.scene, streamed(*frame.on_gpu));
    const bool is_large = scene.size() > max_scene_change;
    message.put(is_large);
    (is_large ? bulk : message).put_all(std::span<const std::byte>(scene.message()));
}

Status FollowedLesson::start(view::GpuContext& gpu_context) {
    gpu_ = &gpu_context;
    scene_ = empty_room();
    return {};
}

void FollowedLesson::release() {
    if (gpu_ != nullptr && gpu_->device) (void)gpu_->device->idle();
    scene_ = empty_room();
    panel_.release();
    ray_model_.reset();
    models_.reset();
    lesson_ = 0;
}

// If this computer does not have the assembly's folder at that path, loads the assembly of the same name.
Status FollowedLesson::load(const SharedModels& shared) {
    const std::filesystem::path sent(shared.assembly);
    std::error_code ignored;
    const std::filesystem::path folder =
        std::filesystem::exists(sent, ignored) ? sent : content::assembly_folder(sent.filename().string());
    content::LoadedAssembly loaded = content::load_assembly(folder, shared.variant);
    if (!loaded.ok()) return fail(loaded.errors.front());
    BOLT_TRY(content::choose_tool(loaded.assembly, shared.tool));
    BOLT_TRY_ASSIGN(const auto models, scene::load_lesson_models(loaded.assembly, shared.side));
    BOLT_TRY(gpu_->device->idle());
    BOLT_TRY_ASSIGN(auto uploaded, scene::upload(*gpu_->device, models));
    models_ = std::move(uploaded);
    return {};
}

Status FollowedLesson::follow(cluster::MessageReader& message, cluster::MessageReader& bulk) {
    const auto lesson = message.get<std::uint32_t>();
    const bool is_new_lesson = message.get<bool>();
    if (is_new_lesson || lesson != lesson_) scene_ = empty_room();
    if (is_new_lesson && lesson != 0) {
        SharedModels shared;
        for (std::string* text : {&shared.assembly, &shared.variant, &shared.tool})
            *text = message.get_text();
        shared.side = message.get<hand::Side>();
        if (!message.ok() || shared.side > hand::Side::right) return fail(unknown_scene());
        BOLT_TRY(load(shared));
        lesson_ = lesson;
    }
    if (lesson == 0) lesson_ = 0;
    if (lesson != lesson_) return fail(unknown_scene());
    scene_in_room_ = message.get_pose();
    panel_pose_.reset();
    if (message.get<bool>()) {
        panel_pose_ = message.get_pose();
        panel_point_ = message.get<double>();
        if (message.get<bool>()) BOLT_TRY(panel_.read(bulk));
    }
    ray_.reset();
    if (message.get<bool>()) {
        ray_.emplace();
        for (Vec3* end : {&ray_->from, &ray_->to}) *end = message.get_pose().position;
        ray_->pressed = message.get<bool>();
    }
    if (lesson == 0) return message.ok() ? Status{} : fail(unknown_scene());
    const cluster::Message sent = (message.get<bool>() ? bulk : message).get_all<std::byte>();
    cluster::MessageReader scene(sent);
    return view::read_scene(scene, streamed(*models_), scene_);
}

Status FollowedLesson::draw(gpu::FrameContext& frame, const view::WindowFrame& window) {
    BOLT_TRY(panel_.draw(*gpu_->device, frame));
    scene_.panels.clear();
    if (panel_pose_ && panel_.picture() != nullptr)
        scene_.panels.push_back(
            panel_in_scene({*panel_pose_, panel_point_}, scene_in_room_, panel_.picture()->image()));
    if (!ray_) return draw_in_room(*gpu_->renderer, frame, scene_, scene_in_room_, *window.immersive);
    if (!ray_model_) {
        BOLT_TRY_ASSIGN(auto model, load_ray(*gpu_->device));
        ray_model_.emplace(std::move(model));
    }
    render::Scene scene = scene_;
    add_ray(scene, *ray_model_, *ray_, inverse(scene_in_room_));
    return draw_in_room(*gpu_->renderer, frame, scene, scene_in_room_, *window.immersive);
}

}  // namespace bolt::trainer
