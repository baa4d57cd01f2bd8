#include "tools/author/preview/preview.hpp"

#include "engine/base/result.hpp"
#include "engine/base/steady_seconds.hpp"
#include "game/view/pictures.hpp"
#include "tools/author/preview/gpu_state.hpp"
#include "tools/author/preview/preview_session.hpp"

namespace bolt::author {

void PreviewSources::set_shown(view::LoadedModel model, view::DetailLevel level, std::string variant) {
    model_ = std::move(model);
    variant_ = std::move(variant);
    level_ = level;
    std::vector<std::filesystem::path> files = model_.files;
    files.emplace_back(light_);  // harmless for "studio", which is not a file
    watch_.watch(std::move(files));
}

PreviewSources::FileChanges PreviewSources::poll_changes(double now) {
    FileChanges changes;
    for (const std::filesystem::path& file : watch_.changed(now)) {
        if (file == light_)
            changes.light = true;
        else
            changes.model = true;
    }
    return changes;
}

Status show_preview(const PreviewOptions& options, PreviewSources& sources, platform::Window& window,
                    const gpu::Instance& instance) {
    return PreviewSession(options, sources, window, instance).run();
}

Status draw_preview(const PreviewOptions& options, const PreviewSources& sources,
                    const gpu::Instance& instance) {
    render::ShaderCode shaders;
    if (!options.shaders.empty()) {
        BOLT_TRY_ASSIGN(auto hot, render::HotShaders::open(options.shaders));
        std::optional<Result<render::ShaderCode>> code = hot.changed(steady_seconds());
        if (code && !*code) return fail(code->error());
        if (code) shaders = std::move(**code);
    }
    BOLT_TRY_ASSIGN(const auto state, upload(options, sources, instance, shaders, VK_NULL_HANDLE));
    const view::Orbit camera = initial_camera(options, sources, *state.shown_model, options.size);
    const render::Eye eye = view::eye_of(camera, state.shown_model->box, aspect_of(options.size));
    BOLT_TRY_ASSIGN(const auto pictures,
                    render::take_pictures(*state.gpu_context.device, *state.gpu_context.frames,
                                          *state.gpu_context.renderer, state.shown_model->scene,
                                          std::span(&eye, 1), options.size));
    BOLT_TRY(view::write_picture(pictures.front(), options.png));
    return check_messages(instance);
}

}  // namespace bolt::author
