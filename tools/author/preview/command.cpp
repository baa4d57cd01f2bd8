// bolt-author preview: an assembly or a model in a window that follows the files.
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

Status in_a_window(const PreviewOptions& options, Sources& sources) {
    Result<platform::Desktop> desktop = platform::Desktop::open();
    if (!desktop) {
        Error error = desktop.error();
        error.expected += "; --png FILE needs none";
        return fail(std::move(error));
    }
    BOLT_TRY_ASSIGN(const auto extensions, desktop->vulkan_extensions());
    BOLT_TRY_ASSIGN(auto window, platform::Window::open(*desktop, {sources.subject().name, options.size.width,
                                                                   options.size.height}));
    BOLT_TRY_ASSIGN(const auto instance, make_instance(options, extensions));
    return show_preview(options, sources, window, instance);
}

int run_preview(PreviewOptions options, const std::string& size) {
    const Result<VkExtent2D> extent = view::parse_size(size);
    if (!extent) return print_error(extent.error());
    options.size = *extent;
    Sources sources(options);
    view::LoadedSubject loaded = sources.read_subject(view::Level::near);
    if (!loaded.ok()) return print_error(loaded.errors);
    sources.keep(std::move(loaded.subject), view::Level::near);
    Result<shading::RadianceImage> light = sources.read_light();
    if (!light) return print_error(light.error());
    sources.keep(std::move(*light));
    if (!options.view.empty())
        if (const auto known = view::named_view(sources.subject(), options.view); !known)
            return print_error(known.error());
    if (options.png.empty()) {
        const Status shown = in_a_window(options, sources);
        return shown ? 0 : print_error(shown.error());
    }
    const Result<gpu::Instance> instance = make_instance(options, {});
    if (!instance) return print_error(instance.error());
    const Status drawn = draw_preview(options, sources, *instance);
    return drawn ? 0 : print_error(drawn.error());
}

}  // namespace

void add_preview(CLI::App& app, int& exit_code) {
    struct Given {
        PreviewOptions options;
        std::string size = "1280x720";
    };
    auto given = std::make_shared<Given>();
    PreviewOptions& options = given->options;
    CLI::App* command =
        app.add_subcommand("preview", "Show an assembly or a model in a window that follows its files");
    command->add_option("what", options.what, "Assembly (folder, file or name) or a .glb")->required();
    command->add_option("--size", given->size, "WIDTHxHEIGHT of the window or the picture");
    command->add_option("--view", options.view, "Named view of the assembly to begin with");
    command->add_option("--light", options.light, "studio, or a Radiance .hdr file");
    command->add_option("--png", options.png, "Draw into this file instead; needs no display");
    command->add_option("--shaders", options.shaders, "Use the GLSL in this folder, and follow it too");
    command->add_option("--gpu", options.gpu, "Part of the name of the GPU to use");
    command->add_flag("--validate", options.validate,
                      "Run under the Vulkan validation layers; any message is an error");
    command->callback([given, &exit_code] { exit_code = run_preview(given->options, given->size); });
}

}  // namespace bolt::author
