#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "content/format/assembly.hpp"
#include "engine/base/console.hpp"
#include "tools/author/commands.hpp"

namespace bolt::author {

namespace {

int run_new(const std::string& given, const std::string& title) {
    const std::filesystem::path folder = std::filesystem::path(given).lexically_normal();
    const std::filesystem::path last =
        folder.has_filename() ? folder.filename() : folder.parent_path().filename();
    const std::string name = title.empty() ? last.string() : title;
    if (Status made = content::create_assembly(folder, name); !made) return print_error(made.error());
    const Status said = print(fmt::format("{}\nCheck it with: bolt-author validate {}\n",
                                          (folder / "assembly.json").string(), given));
    return said ? 0 : print_error(said.error());
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

}  // namespace bolt::author
