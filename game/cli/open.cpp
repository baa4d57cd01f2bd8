// boltwright open: shows a recorded session in a window.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "engine/base/process.hpp"
#include "game/cli/commands.hpp"
#include "game/view/pictures.hpp"
#include "game/viewer/viewer.hpp"

namespace bolt::cli {

namespace {

struct OpenArguments {
    std::string session, language, size = "1280x720", gpu;
    double at = 0.0;
    bool full_screen = false, validate = false;
};

// Runs `boltwright replay`, which draws the film in a process of its own.
Status make_film(const std::string& session, const std::string& language, const std::filesystem::path& file,
                 const std::string& view) {
    std::vector<std::string> command{"/proc/self/exe", "replay", session, "--video", file.string()};
    if (!view.empty()) command.insert(command.end(), {"--view", view});
    if (!language.empty()) command.insert(command.end(), {"--language", language});
    BOLT_TRY_ASSIGN(const auto done, run_program(command, Capture::output_and_errors));
    return done.exit_code == 0 ? Status() : fail(ErrorCode::failed, done.output, "a film");
}

Status run_open(const OpenArguments& options) {
    BOLT_TRY_ASSIGN(const auto session, session::SessionReader::open(options.session));
    const std::filesystem::path folder = words::words_folder();
    const std::string language =
        options.language.empty() ? words::language_of_desktop(words::languages(folder)) : options.language;
    words::LoadedWords loaded = words::load_words(folder, language);
    if (!loaded.ok()) return fail(loaded.errors.front());
    BOLT_TRY_ASSIGN(auto recording, viewer::replay_session(session));

    viewer::ViewerOptions viewer_options;
    viewer_options.session = options.session;
    viewer_options.words = std::move(loaded.words);
    viewer_options.hand = session.header().hand.value_or(hand::Side::right);
    viewer_options.at = options.at;
    viewer_options.make_film = [&](const std::filesystem::path& file, const std::string& view) {
        return make_film(options.session, options.language, file, view);
    };
    BOLT_TRY_ASSIGN(auto viewer, viewer::Viewer::create(std::move(recording), std::move(viewer_options)));

    BOLT_TRY_ASSIGN(auto desktop, platform::Desktop::open());
    BOLT_TRY_ASSIGN(const auto extensions, desktop.vulkan_extensions());
    BOLT_TRY_ASSIGN(const auto size, view::parse_size(options.size));
    const std::string title = std::filesystem::path(options.session).filename().string() + " – Boltwright";
    BOLT_TRY_ASSIGN(auto window,
                    platform::Window::open(desktop, {title, size.width, size.height, options.full_screen}));
    gpu::InstanceOptions instance_options;
    instance_options.validation = options.validate;
    instance_options.extensions = extensions;
    BOLT_TRY_ASSIGN(auto instance, gpu::Instance::create(instance_options));
    catch_interruption();
    BOLT_TRY(view::run_in_window(*viewer, window, instance,
                                 {.gpu = options.gpu, .stop = [] { return interrupted(); }}));
    return instance.log().messages.empty() ? Status()
                                           : fail(ErrorCode::failed, instance.log().messages.front(),
                                                  "no message of the validation layer");
}

}  // namespace

void add_open(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<OpenArguments>();
    CLI::App* open =
        app.add_subcommand("open", "Show a recorded session in a window, at any moment and from any side");
    open->add_option("session", options->session, "Session file")->required();
    open->add_option("--at", options->at, "Time in the lesson at which to begin, s")
        ->check(CLI::NonNegativeNumber);
    open->add_option("--language", options->language,
                     "Code of a language in content/words, such as en; default: the desktop's");
    open->add_option("--size", options->size, "WIDTHxHEIGHT of the window")->capture_default_str();
    open->add_flag("--full-screen", options->full_screen, "Use the full screen");
    open->add_option("--gpu", options->gpu, "Part of the name of the GPU to use");
    open->add_flag("--validate", options->validate,
                   "Run under the Vulkan validation layers; any message is an error");
    open->callback([options, &exit_code] {
        const Status done = run_open(*options);
        exit_code = done ? 0 : report_error(done.error());
    });
}

}  // namespace bolt::cli
