#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>

#include "content/format/assembly.hpp"
#include "engine/base/console.hpp"
#include "tools/author/commands.hpp"
#include "tools/author/geometry/check.hpp"
#include "tools/author/gltf_validator.hpp"

namespace bolt::author {

namespace {

std::vector<std::string> models_of(const content::Assembly& assembly) {
    std::vector<std::string> files;
    for (const std::string& file :
         {assembly.models.model, assembly.models.far_level, assembly.models.contact, assembly.wrench.model})
        if (!file.empty() && std::find(files.begin(), files.end(), file) == files.end())
            files.push_back(file);
    return files;
}

// What is said of an assembly that loads: its mistakes, and what an author should know although it is none.
struct Verdict {
    std::vector<Error> errors;
    std::string remarks;  // a line each
};

Verdict judge(const content::Assembly& assembly) {
    Verdict verdict;
    geometry::Findings findings = geometry::check_geometry(assembly);
    verdict.errors = std::move(findings.errors);
    for (const Error& note : findings.notes) verdict.remarks += fmt::format("note: {}\n", note.message());
    const std::vector<std::string> files = models_of(assembly);
    if (assembly.models.model.empty())
        verdict.remarks += fmt::format(
            "note: {}: no model is named, so nodes and room for the wrench are not checked\n", assembly.file);
    if (files.empty()) return verdict;
    const std::filesystem::path script = gltf_validator();
    if (script.empty()) {
        verdict.remarks +=
            "note: the Khronos glTF validator is not installed, so its checks are left out "
            "(tools/install-node-tools.sh installs it)\n";
        return verdict;
    }
    auto said = run_gltf_validator(script, files);
    if (said)
        verdict.errors.insert(verdict.errors.end(), said->begin(), said->end());
    else
        verdict.errors.push_back(said.error());
    return verdict;
}

int run_validate(const std::vector<std::string>& assemblies, const std::string& variant) {
    int worst = 0;
    for (const std::string& where : assemblies) {
        const content::Loaded loaded = content::load_assembly(where, variant);
        if (!loaded.ok()) {
            worst = std::max(worst, print_error(loaded.errors));
            continue;
        }
        const Verdict verdict = judge(loaded.assembly);
        std::string text = verdict.remarks;
        if (verdict.errors.empty())
            text += fmt::format("{}: {} joints, {} passes, variant {}: no mistakes\n", loaded.assembly.file,
                                loaded.assembly.joints.size(), loaded.assembly.passes.size(),
                                loaded.assembly.variant.empty() ? "-" : loaded.assembly.variant);
        worst = std::max(worst, print_error(verdict.errors));
        if (const Status said = print(text); !said) return print_error(said.error());
    }
    return worst;
}

}  // namespace

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
