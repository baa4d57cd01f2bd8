#include "game/trainer/assembly_pictures.hpp"

#include <algorithm>
#include <chrono>

#include "content/format/folders.hpp"
#include "game/view/camera.hpp"

namespace bolt::trainer {

namespace {

// Groups of the renderer's pictures; group 1 is the close-up.
constexpr std::uint32_t backdrop_group = 2, thumbnail_group = 3;
constexpr glm::vec4 backdrop_color{0.035F, 0.04F, 0.045F, 1.0F}, thumbnail_color{0.05F, 0.06F, 0.07F, 1.0F};
constexpr float backdrop_exposure = 0.75F;  // dim, so that text on it stays legible
constexpr std::uint32_t light_size = 32;    // texels; small, because the user waits for the filtering

// Prefers the coarse model.
view::ModelLoadResult load(const std::string& assembly) {
    const std::string source = content::assembly_folder(assembly).string();
    view::ModelLoadResult far = view::load_model(source, view::DetailLevel::far);
    return far.ok() ? std::move(far) : view::load_model(source);
}

bool same_size(const VkExtent2D& a, const VkExtent2D& b) {
    return a.width == b.width && a.height == b.height;
}

bool contains(const std::vector<std::string>& all, const std::string& one) {
    return std::find(all.begin(), all.end(), one) != all.end();
}

// Shows the whole box from the direction of the assembly's first view, else from the default one.
view::Orbit orbit_for(const view::Viewpoint& first, const render::BoundingBox& box, float aspect) {
    const view::Viewpoint from =
        first.fov > 0.0F ? first : view::default_viewpoint(box, view::default_fov, aspect);
    return view::fit_to_box(view::orbit_of(from), box, aspect);
}

}  // namespace

bool AssemblyPictures::needs_thumbnail(const std::string& assembly) const {
    const auto found = thumbnails_.find(assembly);
    return contains(request_.listed, assembly) && request_.thumbnail.width > 0 &&
           (found == thumbnails_.end() || !same_size(found->second.info().extent, request_.thumbnail));
}

// Empty if all pictures exist or cannot be made.
std::string AssemblyPictures::next_to_load() const {
    const Backdrop wanted{request_.selected, request_.size, request_.shift};
    if (drawn_ != wanted && !contains(failed_, request_.selected)) return request_.selected;
    for (const std::string& name : request_.listed)
        if (needs_thumbnail(name) && !contains(failed_, name)) return name;
    return {};
}

Status AssemblyPictures::upload(gpu::Device& device, const view::LoadedModel& model) {
    BOLT_TRY(device.idle());
    if (light_.levels.get() == VK_NULL_HANDLE) {
        BOLT_TRY_ASSIGN(auto light,
                        render::upload_environment(device, shading::studio_environment(), light_size));
        light_ = std::move(light);
    }
    BOLT_TRY_ASSIGN(auto shown, view::show_model(device, model, light_));
    model_ = std::move(shown);
    viewpoint_ = model.views.empty() ? view::Viewpoint{} : model.views.front();
    uploaded_ = loading_name_;
    return {};
}

Status AssemblyPictures::draw_backdrop(render::Renderer& renderer, gpu::FrameContext& frame) {
    const VkExtent2D size = request_.size;
    const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
    view::Orbit orbit = orbit_for(viewpoint_, model_->box, aspect);
    // The menu covers part of the picture: the distance is divided by the free share, so that the box fits
    // into the free area, and the target is moved, so that the box is in its middle.
    const glm::vec2 free = glm::vec2(1.0F) - glm::abs(request_.shift);
    orbit.distance /= static_cast<double>(std::max(std::min(free.x, free.y), 0.3F));
    view::pan(orbit, 0.5 * glm::dvec2(request_.shift.x * aspect, request_.shift.y));
    model_->scene.background = backdrop_color;
    model_->scene.exposure = backdrop_exposure;
    const render::Eye eye = view::eye_of(orbit, model_->box, aspect);
    BOLT_TRY(renderer.render(frame, model_->scene, {&eye, 1}, size, backdrop_group));
    drawn_ = Backdrop{uploaded_, size, request_.shift};
    return {};
}

// The renderer uses this picture for the next assembly too, so each thumbnail is a copy of it.
Status AssemblyPictures::draw_thumbnail(gpu::Device& device, render::Renderer& renderer,
                                        gpu::FrameContext& frame) {
    const VkExtent2D size = request_.thumbnail;
    const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
    model_->scene.background = thumbnail_color;
    model_->scene.exposure = 1.0F;
    const render::Eye eye = view::eye_of(orbit_for(viewpoint_, model_->box, aspect), model_->box, aspect);
    BOLT_TRY(renderer.render(frame, model_->scene, {&eye, 1}, size, thumbnail_group));
    const render::ImageLayer drawn = renderer.picture(0, thumbnail_group);
    gpu::ImageInfo info;
    info.format = drawn.image->info().format;
    info.extent = size;
    info.usage =
        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    info.array = true;
    BOLT_TRY_ASSIGN(auto copy, gpu::Image::create(device, info));
    VkImageCopy region{};
    region.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, drawn.layer, 1};
    region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.extent = {size.width, size.height, 1};
    gpu::image_barrier(frame.commands(), copy.get(), gpu::ResourceUse::undefined,
                       gpu::ResourceUse::transfer_to);
    vkCmdCopyImage(frame.commands(), drawn.image->get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, copy.get(),
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
    gpu::image_barrier(frame.commands(), copy.get(), gpu::ResourceUse::transfer_to,
                       gpu::ResourceUse::transfer_from);
    gpu::Image& kept = thumbnails_[uploaded_];
    if (kept.get() != VK_NULL_HANDLE) frame.retire(std::move(kept));
    kept = std::move(copy);
    return {};
}

Status AssemblyPictures::draw(gpu::Device& device, render::Renderer& renderer, gpu::FrameContext& frame,
                              const Request& request) {
    using namespace std::chrono_literals;
    request_ = request;
    if (loading_.valid() && loading_.wait_for(0s) == std::future_status::ready) {
        const view::ModelLoadResult loaded = loading_.get();
        const Status shown = loaded.ok() ? upload(device, loaded.model) : fail(loaded.errors.front());
        if (!shown && shown.error().lost) return shown;
        if (!shown) failed_.push_back(loading_name_);
    }
    const std::string next = next_to_load();
    if (!next.empty() && next != uploaded_ && !loading_.valid()) {
        loading_name_ = next;
        loading_ = std::async(std::launch::async, load, next);
    }
    if (!model_) return {};
    const bool selected = uploaded_ == request.selected;
    if (selected && drawn_ != Backdrop{uploaded_, request.size, request.shift})
        return draw_backdrop(renderer, frame);
    if (needs_thumbnail(uploaded_)) return draw_thumbnail(device, renderer, frame);
    return {};
}

std::optional<render::ImageLayer> AssemblyPictures::picture(const render::Renderer& renderer) const {
    if (!drawn_ || drawn_->assembly != request_.selected) return std::nullopt;
    return renderer.picture(0, backdrop_group);
}

std::optional<render::ImageLayer> AssemblyPictures::thumbnail(const std::string& assembly) const {
    const auto found = thumbnails_.find(assembly);
    if (found == thumbnails_.end()) return std::nullopt;
    return render::ImageLayer{&found->second, 0};
}

void AssemblyPictures::release() {
    model_.reset();
    light_ = {};
    thumbnails_.clear();
    uploaded_.clear();
    drawn_.reset();
}

}  // namespace bolt::trainer
