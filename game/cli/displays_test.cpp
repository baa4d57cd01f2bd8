// boltwright displays test: shows the fitter's test pattern on projection walls.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "content/displays/check_displays.hpp"
#include "game/cli/commands.hpp"
#include "game/displays/head_source.hpp"
#include "game/view/pictures.hpp"
#include "game/view/wall_pattern.hpp"
#include "game/view/walls.hpp"

namespace bolt::cli {

namespace {

struct DisplaysTestOptions {
    std::string file, size = "480x270", gpu;
    bool validate = false, quiet = false;
};

Status show_pattern(const DisplaysTestOptions& options) {
    BOLT_TRY_ASSIGN(const auto size, view::parse_size(options.size));
    BOLT_TRY_ASSIGN(auto desktop, platform::Desktop::open());
    BOLT_TRY_ASSIGN(const auto walls, open_walls(options.file, desktop, options.quiet));
    BOLT_TRY_ASSIGN(const auto extensions, desktop.vulkan_extensions());
    platform::WindowOptions window_options;
    window_options.title = "Boltwright: test pattern";
    window_options.width = size.width;
    window_options.height = size.height;
    BOLT_TRY_ASSIGN(auto window, platform::Window::open(desktop, window_options));
    gpu::InstanceOptions instance_options;
    instance_options.validation = options.validate;
    instance_options.extensions = extensions;
    BOLT_TRY_ASSIGN(auto instance, gpu::Instance::create(instance_options));
    view::WallPattern pattern(walls->displays());
    catch_interruption();
    BOLT_TRY(view::run_in_window(
        pattern, window, instance,
        {.gpu = options.gpu, .stop = [] { return interrupted(); }, .walls = walls.get()}));
    return instance.log().messages.empty() ? Status()
                                           : fail(ErrorCode::failed, instance.log().messages.front());
}

}  // namespace

Result<std::unique_ptr<view::Walls>> open_walls(const std::string& file, const platform::Desktop& desktop,
                                                bool quiet) {
    content::LoadedDisplays loaded = content::load_displays(file);
    if (!loaded.ok()) {
        for (std::size_t i = 0; i + 1 < loaded.errors.size(); ++i) (void)print_error(loaded.errors[i]);
        return fail(loaded.errors.back());
    }
    const std::vector<content::DisplayFinding> findings =
        content::check_displays(loaded.displays, view::this_computer(desktop));
    const bool unusable = !findings.empty() && findings.front().prevents_use;
    if (!findings.empty() && (unusable || !quiet))
        (void)std::fputs(content::describe(findings, loaded).c_str(), stderr);
    if (unusable)
        return fail(ErrorCode::bad_content, fmt::format("{}: the walls cannot be shown", file),
                    "a display file without mistakes for these monitors");
    if (loaded.displays.head.tracker == content::HeadTracker::openxr)
        return fail(ErrorCode::no_device,
                    fmt::format("{}: the tracker \"openxr\" is not supported on walls", file),
                    "\"fixed\", \"dtrack\" or \"file\"");
    BOLT_TRY_ASSIGN(auto head, displays::HeadSource::open(loaded.displays.head,
                                                          std::filesystem::path(file).parent_path()));
    std::function<void(const std::string&)> log;
    if (!quiet) log = [](const std::string& line) { (void)std::fprintf(stderr, "%s\n", line.c_str()); };
    return view::Walls::open(desktop, std::move(loaded.displays), std::move(head), std::move(log));
}

void add_displays_test(CLI::App& displays, int& exit_code) {
    auto options = std::make_shared<DisplaysTestOptions>();
    CLI::App* test = displays.add_subcommand(
        "test",
        "Show a test pattern on the walls: borders, a scale to measure, eyes, the number of the frame");
    test->add_option("FILE", options->file, "The display file")->required();
    test->add_option("--size", options->size, "WIDTHxHEIGHT of the window beside the walls")
        ->capture_default_str();
    test->add_option("--gpu", options->gpu, "Part of the name of the GPU to use");
    test->add_flag("--validate", options->validate,
                   "Run under the Vulkan validation layers; any message is an error");
    test->add_flag("--quiet", options->quiet, "Do not print doubtful findings and the state of the tracker");
    test->callback([options, &exit_code] {
        const Status shown = show_pattern(*options);
        exit_code = shown ? 0 : print_error(shown.error());
    });
}

}  // namespace bolt::cli
