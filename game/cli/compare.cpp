#include "game/compare/compare.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "engine/base/console.hpp"
#include "engine/base/file.hpp"
#include "game/cli/commands.hpp"
#include "game/compare/page.hpp"

namespace bolt::cli {

namespace {

struct CompareOptions {
    std::string session, measured, joint, html = "out/compare.html";
};

int run_compare(const CompareOptions& options) {
    for (const std::string& input : {options.session, options.measured})
        if (Status apart = keep_apart(input, options.html); !apart) return complain(apart.error());
    Result<record::Reader> reader = record::Reader::open(options.session);
    if (!reader) return complain(reader.error());
    Result<compare::Measured> measured = compare::read_measured(options.measured);
    if (!measured) return complain(measured.error());
    Result<compare::Comparison> comparison = compare::compare(*reader, *measured, options.joint);
    if (!comparison) return complain(comparison.error());
    if (Status said = say(compare::console_text(*comparison)); !said) return complain(said.error());

    const std::filesystem::path page(options.html);
    std::error_code ignored;  // a folder that cannot be made shows as a page that cannot be written
    if (page.has_parent_path()) std::filesystem::create_directories(page.parent_path(), ignored);
    if (Status kept = write_file(page, compare::comparison_page(*comparison)); !kept)
        return complain(kept.error());
    const Status said = say(page.string() + "\n");
    return said ? 0 : complain(said.error());
}

}  // namespace

void add_compare(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<CompareOptions>();
    CLI::App* compare =
        app.add_subcommand("compare", "Hold a session against a measured torque-angle record");
    compare->add_option("session", options->session, "Session file")->required();
    compare->add_option("measured", options->measured, "CSV with angle_deg, torque_Nm and perhaps cycle")
        ->required();
    compare->add_option("--joint", options->joint,
                        "Id of one joint; all that were turned that way if not given");
    compare->add_option("--html", options->html, "Page with the plots to write")->capture_default_str();
    compare->callback([options, &exit_code] { exit_code = run_compare(*options); });
}

}  // namespace bolt::cli
