#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "content/format/load.hpp"
#include "content/format/new_assembly.hpp"
#include "engine/base/console.hpp"
#include "tools/author/commands.hpp"

namespace bolt::author {

namespace {

int run_new(const std::string& given, const std::string& title) {
    const std::filesystem::path folder = std::filesystem::path(given).lexically_normal();
    const std::filesystem::path last =
        folder.has_filename() ? folder.filename() : folder.parent_path().filename();
    const std::string name = title.empty() ? last.string() : title;
    if (Status made = content::create_assembly(folder, name); !made) return complain(made.error());
    const Status said = say(fmt::format("{}\nCheck it with: bolt-author validate {}\n",
                                        (folder / "assembly.json").string(), given));
    return said ? 0 : complain(said.error());
}

int run_validate(const std::vector<std::string>& assemblies, const std::string& variant) {
    int worst = 0;
    for (const std::string& where : assemblies) {
        const content::Loaded loaded = content::load_assembly(where, variant);
        if (!loaded.ok()) {
            worst = std::max(worst, complain(loaded.errors));
            continue;
        }
        const Status said =
            say(fmt::format("{}: {} joints, {} passes, variant {}: no mistakes\n", loaded.assembly.file,
                            loaded.assembly.joints.size(), loaded.assembly.passes.size(),
                            loaded.assembly.variant.empty() ? "-" : loaded.assembly.variant));
        if (!said) return complain(said.error());
    }
    return worst;
}

}  // namespace

void add_new(CLI::App& app, int& exit_code) {
    struct Options {
        std::string folder, title;
    };
    auto options = std::make_shared<Options>();
    CLI::App* make =
        app.add_subcommand("new", "Make a folder with a small assembly that is valid and ready to change");
    make->add_option("folder", options->folder, "Folder to make")->required();
    make->add_option("--title", options->title, "Title; the folder's name if not given");
    make->callback([options, &exit_code] { exit_code = run_new(options->folder, options->title); });
}

void add_validate(CLI::App& app, int& exit_code) {
    struct Options {
        std::vector<std::string> assemblies;
        std::string variant;
    };
    auto options = std::make_shared<Options>();
    CLI::App* validate = app.add_subcommand("validate", "Say everything that is wrong with assemblies");
    validate->add_option("assembly", options->assemblies, "Folders, files, or names under content/assemblies")
        ->required();
    validate->add_option("--variant", options->variant, "Material variant; the default if not given");
    validate->callback(
        [options, &exit_code] { exit_code = run_validate(options->assemblies, options->variant); });
}

}  // namespace bolt::author
