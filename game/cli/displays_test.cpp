// boltwright displays test: shows the installer's test pattern on projection walls.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "content/displays/check_displays.hpp"
#include "engine/base/hash.hpp"
#include "game/cli/commands.hpp"
#include "game/cli/opened_walls.hpp"
#include "game/head_tracking/head_source.hpp"
#include "game/view/pictures.hpp"
#include "game/view/wall_pattern.hpp"

namespace bolt::cli {

namespace {

struct DisplaysTestOptions {
    std::string file, size = "480x270", gpu;
    bool validate = false, quiet = false;
};

Result<gpu::Instance> make_instance(const platform::Desktop& desktop, bool validate) {
    BOLT_TRY_ASSIGN(const auto extensions, desktop.vulkan_extensions());
    gpu::InstanceOptions options;
    options.validation = validate;
    options.extensions = extensions;
    return gpu::Instance::create(options);
}

Status validation_status(const gpu::Instance& instance) {
    if (instance.log().messages.empty()) return {};
    return fail(ErrorCode::failed, instance.log().messages.front(), "no message of the validation layer");
}

Status show_pattern(const DisplaysTestOptions& options) {
    BOLT_TRY_ASSIGN(const auto size, view::parse_size(options.size));
    BOLT_TRY_ASSIGN(auto desktop, platform::Desktop::open());
    BOLT_TRY_ASSIGN(auto opened, open_walls(options.file, desktop, options.quiet));
    view::WallPattern pattern(opened.walls->displays());
    if (opened.follower)
        return follow_first_process(pattern, opened, desktop, {options.gpu, options.validate});
    platform::WindowOptions window_options;
    window_options.title = "Boltwright: test pattern";
    window_options.width = size.width;
    window_options.height = size.height;
    BOLT_TRY_ASSIGN(auto window, platform::Window::open(desktop, window_options));
    BOLT_TRY_ASSIGN(auto instance, make_instance(desktop, options.validate));
    catch_interruption();
    BOLT_TRY(view::run_in_window(
        pattern, window, instance,
        {.gpu = options.gpu, .stop = [] { return interrupted(); }, .walls = opened.walls.get()}));
    return validation_status(instance);
}

// Loads and checks the file, and opens the walls of this process.
Result<std::unique_ptr<view::Walls>> open_checked_walls(const std::string& file,
                                                        const platform::Desktop& desktop,
                                                        cluster::Cluster* cluster, bool quiet) {
    content::LoadedDisplays loaded = content::load_displays(file);
    if (!loaded.ok()) {
        for (std::size_t i = 0; i + 1 < loaded.errors.size(); ++i) (void)print_error(loaded.errors[i]);
        return fail(loaded.errors.back());
    }
    const std::vector<content::DisplayFinding> findings =
        content::check_displays(loaded.displays, view::this_host(desktop, cluster));
    const bool unusable = !findings.empty() && findings.front().prevents_use;
    const bool first = cluster == nullptr || cluster->process() == 0;
    if (!findings.empty() && (unusable || (first && !quiet)))
        (void)std::fputs(content::describe(findings, loaded).c_str(), stderr);
    if (unusable)
        return fail(ErrorCode::bad_content, fmt::format("{}: the walls cannot be shown", file),
                    "a display file without mistakes for these monitors");
    view::WallsOptions options;
    if (first) {
        BOLT_TRY_ASSIGN(auto head, head_tracking::HeadSource::open(
                                       loaded.displays.head, std::filesystem::path(file).parent_path()));
        options.head.emplace(std::move(head));
    }
    options.displays = std::move(loaded.displays);
    options.cluster = cluster;
    if (!quiet && first)
        options.log = [](const std::string& line) { (void)std::fprintf(stderr, "%s\n", line.c_str()); };
    return view::Walls::open(desktop, std::move(options));
}

// All processes must run the same version with the same display file.
std::uint64_t fingerprint_of(const content::DisplayFile& displays) {
    Fnv1a hash;
    hash.add(BOLTWRIGHT_VERSION);
    hash.add(content::displays_json(displays));
    return hash.value();
}

}  // namespace

Result<OpenedWalls> open_walls(const std::string& file, const platform::Desktop& desktop, bool quiet) {
    OpenedWalls opened;
    BOLT_TRY_ASSIGN(opened.cluster, cluster::Cluster::join());
    cluster::Cluster* cluster = opened.cluster.get();
    auto walls = open_checked_walls(file, desktop, cluster, quiet);
    if (cluster == nullptr) {
        if (!walls) return fail(walls.error());
        opened.walls = std::move(*walls);
        return opened;
    }
    catch_interruption();
    const view::StopWaiting stop = [] { return interrupted(); };
    const bool first = cluster->process() == 0;
    Status ready = walls ? Status{} : Status(fail(walls.error()));
    if (ready) {
        opened.walls = std::move(*walls);
        const std::uint64_t fingerprint = fingerprint_of(opened.walls->displays());
        if (first) {
            ready = opened.walls->wait_for_processes(fingerprint, stop);
        } else if (auto follower = view::WallFollower::begin(*cluster, fingerprint, stop)) {
            opened.follower.emplace(std::move(*follower));
        } else {
            ready = fail(follower.error());
        }
    }
    if (ready) return opened;
    if (first)
        view::WallLeader::end_others(*cluster, ready.error());
    else
        view::WallFollower::report(*cluster, ready.error());
    return fail(ready.error());
}

Status follow_first_process(view::WindowContent& content, OpenedWalls& opened,
                            const platform::Desktop& desktop, const FollowOptions& options) {
    const auto follow = [&]() -> Status {
        BOLT_TRY_ASSIGN(const auto instance, make_instance(desktop, options.validate));
        BOLT_TRY(view::follow_on_walls(content, *opened.walls, *opened.follower, instance, options.gpu));
        BOLT_TRY(validation_status(instance));
        if (interrupted()) return fail(ErrorCode::failed, "the process was interrupted", {});
        return {};
    };
    const Status done = follow();
    if (!done) view::WallFollower::report(*opened.cluster, done.error());
    return interrupted() ? Status{} : done;
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
