#include "game/trainer/backdrop.hpp"

#include <chrono>

namespace bolt::trainer {

namespace {

constexpr std::uint32_t view_group = 2;  // of the renderer's pictures; group 1 is the close-up
constexpr glm::vec4 background{0.035F, 0.04F, 0.045F, 1.0F};
// Closer than the view that shows everything, because the menu covers the middle.
constexpr float distance_factor = 0.7F;
constexpr float exposure = 0.55F;         // dim, so that the menu stays legible
constexpr std::uint32_t light_size = 32;  // texels; small, because the user waits for the filtering

// Prefers the coarse model.
view::ModelLoadResult load(const std::string& assembly) {
    view::ModelLoadResult far = view::load_model(assembly, view::DetailLevel::far);
    return far.ok() ? std::move(far) : view::load_model(assembly);
}

}  // namespace

void Backdrop::select(const std::string& assembly) {
    selected_ = assembly;
    if (loading_.valid() || uploaded_ == selected_ || loading_name_ == selected_) return;
    loading_name_ = assembly;
    loading_ = std::async(std::launch::async, load, assembly);
}

Status Backdrop::upload(gpu::Device& device, const view::LoadedModel& model) {
    BOLT_TRY(device.idle());
    if (light_.levels.get() == VK_NULL_HANDLE) {
        BOLT_TRY_ASSIGN(auto light,
                        render::upload_environment(device, shading::studio_environment(), light_size));
        light_ = std::move(light);
    }
    BOLT_TRY_ASSIGN(auto shown, view::show_model(device, model, light_));
    model_ = std::move(shown);
    model_->scene.background = background;
    model_->scene.exposure = exposure;
    viewpoint_ = model.views.empty() ? view::Viewpoint{} : model.views.front();
    uploaded_ = loading_name_;
    drawn_size_ = {};
    return {};
}

Status Backdrop::draw(gpu::Device& device, render::Renderer& renderer, gpu::FrameContext& frame,
                      VkExtent2D size) {
    using namespace std::chrono_literals;
    if (loading_.valid() && loading_.wait_for(0s) == std::future_status::ready) {
        const view::ModelLoadResult loaded = loading_.get();
        if (loaded.ok()) BOLT_TRY(upload(device, loaded.model));
    }
    if (!model_ || (drawn_size_.width == size.width && drawn_size_.height == size.height)) return {};
    const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
    view::Viewpoint at =
        viewpoint_.fov > 0.0F ? viewpoint_ : view::default_viewpoint(model_->box, view::default_fov, aspect);
    at.eye = glm::mix(at.target, at.eye, distance_factor);
    const render::Eye eye =
        render::make_eye(at.eye, at.target, view::lens(model_->box, at.eye, at.target, at.fov, aspect));
    BOLT_TRY(renderer.render(frame, model_->scene, {&eye, 1}, size, view_group));
    drawn_size_ = size;
    return {};
}

std::optional<render::ImageLayer> Backdrop::picture(const render::Renderer& renderer) const {
    if (uploaded_ != selected_ || drawn_size_.width == 0) return std::nullopt;
    return renderer.picture(0, view_group);
}

void Backdrop::release() {
    model_.reset();
    light_ = {};
    uploaded_.clear();
    loading_name_.clear();
    drawn_size_ = {};
}

}  // namespace bolt::trainer
