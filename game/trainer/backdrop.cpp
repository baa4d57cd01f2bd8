#include "game/trainer/backdrop.hpp"

#include <chrono>

namespace bolt::trainer {

namespace {

constexpr std::uint32_t group = 2;                     // of the renderer's pictures: 1 is the close-up
constexpr glm::vec4 dim{0.035F, 0.04F, 0.045F, 1.0F};  // behind it
constexpr float nearer = 0.7F;            // than to see all of it: the menu stands before its middle
constexpr float exposure = 0.55F;         // the menu is what is to be read
constexpr std::uint32_t light_size = 32;  // texels: less to filter, while somebody waits

// The coarse model is enough, where there is one.
view::LoadedSubject read(const std::string& assembly) {
    view::LoadedSubject far = view::load_subject(assembly, view::Level::far);
    return far.ok() ? std::move(far) : view::load_subject(assembly);
}

}  // namespace

void Backdrop::want(const std::string& assembly) {
    wanted_ = assembly;
    if (coming_.valid() || shown_ == wanted_ || coming_name_ == wanted_) return;
    coming_name_ = assembly;
    coming_ = std::async(std::launch::async, read, assembly);
}

Status Backdrop::put_up(gpu::Device& device, const view::Subject& subject) {
    BOLT_TRY(device.idle());
    if (light_.levels.get() == VK_NULL_HANDLE) {
        BOLT_TRY_ASSIGN(auto light, render::upload_environment(device, shading::studio(), light_size));
        light_ = std::move(light);
    }
    BOLT_TRY_ASSIGN(auto stage, view::set_stage(device, subject, light_));
    stage_ = std::move(stage);
    stage_->scene.background = dim;
    stage_->scene.exposure = exposure;
    from_ = subject.views.empty() ? view::Viewpoint{} : subject.views.front();
    shown_ = coming_name_;
    drawn_ = {};
    return {};
}

Status Backdrop::draw(gpu::Device& device, render::Renderer& renderer, gpu::FrameContext& frame,
                      VkExtent2D size) {
    using namespace std::chrono_literals;
    if (coming_.valid() && coming_.wait_for(0s) == std::future_status::ready) {
        const view::LoadedSubject loaded = coming_.get();
        // One that cannot be read is told of when its lesson is to begin.
        if (loaded.ok()) BOLT_TRY(put_up(device, loaded.subject));
    }
    if (!stage_ || (drawn_.width == size.width && drawn_.height == size.height)) return {};
    const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
    view::Viewpoint at = from_.fov > 0.0F ? from_ : view::framed(stage_->box, view::usual_fov, aspect);
    at.eye = glm::mix(at.target, at.eye, nearer);
    const render::Eye eye =
        render::make_eye(at.eye, at.target, view::lens(stage_->box, at.eye, at.target, at.fov, aspect));
    BOLT_TRY(renderer.render(frame, stage_->scene, {&eye, 1}, size, group));
    drawn_ = size;
    return {};
}

std::optional<render::ImageLayer> Backdrop::picture(const render::Renderer& renderer) const {
    if (shown_ != wanted_ || drawn_.width == 0) return std::nullopt;
    return renderer.picture(0, group);
}

void Backdrop::drop() {
    stage_.reset();
    light_ = {};
    shown_.clear();
    coming_name_.clear();
    drawn_ = {};
}

}  // namespace bolt::trainer
