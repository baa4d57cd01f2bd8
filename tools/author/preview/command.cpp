// The subcommand bolt-author preview.
#include <CLI/CLI.hpp>
#include <memory>

#include "engine/base/result.hpp"
#include "game/view/pictures.hpp"
#include "tools/author/commands.hpp"
#include "tools/author/preview/preview.hpp"

namespace bolt::author {

namespace {

Result<gpu::Instance> make_instance(const PreviewOptions& options, std::span<const char* const> extensions) {
    gpu::InstanceOptions instance;
    instance.validation = options.validate;
    instance.extensions = extensions;
    return gpu::Instance::create(instance);
}

Status show_in_window(const PreviewOptions& options, PreviewSources& sources) {
    Result<platform::Desktop> desktop = platform::Desktop::open();
    if (!desktop) {
        Error error = desktop.error();
        error.expected += "; --png FILE needs none";
        return fail(std::move(error));
    }
    BOLT_TRY_ASSIGN(const auto extensions, desktop->vulkan_extensions());
    BOLT_TRY_ASSIGN(auto window, platform::Window::open(*desktop, {sources.model().name, options.size.width,
                                                                   options.size.height}));
    BOLT_TRY_ASSIGN(const auto instance, make_instance(options, extensions));
    return show_preview(options, sources, window, instance);
}

int run_preview(PreviewOptions options, const std::string& size) {
    const Result<VkExtent2D> extent = view::parse_size(size);
    if (!extent) return print_error(extent.error());
    options.size = *extent;
    PreviewSources sources(options);
    view::ModelLoadResult loaded = sources.read_model(view::DetailLevel::near, options.variant);
    if (!loaded.ok()) return print_error(loaded.errors);
    sources.set_shown(std::move(loaded.model), view::DetailLevel::near, options.variant);
    Result<shading::RadianceImage> light = sources.read_light();
    if (!light) return print_error(light.error());
    sources.set_shown(std::move(*light));
    if (!options.view.empty())
        if (const auto known = view::named_view(sources.model(), options.view); !known)
            return print_error(known.error());
    if (options.png.empty()) {
        const Status shown = show_in_window(options, sources);
        return shown ? 0 : print_error(shown.error());
    }
    const Result<gpu::Instance> instance = make_instance(options, {});
    if (!instance) return print_error(instance.error());
    const Status drawn = draw_preview(options, sources, *instance);
    return drawn ? 0 : print_error(drawn.error());
}

}  // namespace

void add_preview(CLI::App& app, int& exit_code) {
    struct PreviewArguments {
        PreviewOptions options;
        std::string size = "1280x720";
    };
    auto arguments = std::make_shared<PreviewArguments>();
    PreviewOptions& options = arguments->options;
    CLI::App* command = app.add_subcommand(
        "preview", "Show an assembly or a model in a window and reload its files when they change");
    command->add_option("what", options.source, "Assembly (folder, file or name) or a .glb")->required();
    command->add_option("--size", arguments->size, "WIDTHxHEIGHT of the window or the picture");
    command->add_option("--variant", options.variant,
                        "Variant of the assembly to begin with; its default if not given");
    command->add_option("--view", options.view, "Named view of the assembly to begin with");
    command->add_option("--light", options.light, "studio, or a Radiance .hdr file");
    command->add_option("--png", options.png, "Draw into this file instead; needs no display");
    command->add_option("--shaders", options.shaders,
                        "Use the GLSL in this folder, and reload it when it changes");
    command->add_option("--gpu", options.gpu, "Part of the name of the GPU to use");
    command->add_flag("--validate", options.validate,
                      "Run under the Vulkan validation layers; any message is an error");
    command->callback(
        [arguments, &exit_code] { exit_code = run_preview(arguments->options, arguments->size); });
}

}  // namespace bolt::author
