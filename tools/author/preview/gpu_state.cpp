#include "tools/author/preview/gpu_state.hpp"

namespace bolt::author {

float aspect_of(VkExtent2D size) {
    return size.height > 0 ? static_cast<float>(size.width) / static_cast<float>(size.height) : 1.0F;
}

Result<GpuState> upload(const PreviewOptions& options, const PreviewSources& sources,
                        const gpu::Instance& instance, const render::ShaderCode& shaders,
                        VkSurfaceKHR surface) {
    GpuState state;
    render::RendererOptions renderer;
    renderer.shaders = shaders;
    renderer.level_error_px = level_error;
    BOLT_TRY_ASSIGN(auto gpu_context, view::make_gpu_context(instance, {options.gpu, surface}, renderer));
    state.gpu_context = std::move(gpu_context);
    BOLT_TRY_ASSIGN(auto light, render::upload_environment(*state.gpu_context.device, sources.radiance()));
    state.light = std::make_unique<render::EnvironmentLight>(std::move(light));
    BOLT_TRY_ASSIGN(auto shown_model,
                    view::show_model(*state.gpu_context.device, sources.model(), *state.light, {true, true}));
    state.shown_model = std::move(shown_model);
    return state;
}

view::Orbit initial_camera(const PreviewOptions& options, const PreviewSources& sources,
                           const view::ShownModel& shown_model, VkExtent2D size) {
    if (const auto named = view::named_view(sources.model(), options.view); named)
        return view::orbit_of(*named);
    return view::orbit_of(view::default_viewpoint(shown_model.box, view::default_fov, aspect_of(size)));
}

Status check_messages(const gpu::Instance& instance) {
    if (instance.log().messages.empty()) return {};
    return fail(ErrorCode::failed, instance.log().messages.front(), "no message of the validation layer");
}

}  // namespace bolt::author
