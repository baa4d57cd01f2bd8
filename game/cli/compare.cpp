#include "game/analysis/compare.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "engine/base/console.hpp"
#include "engine/base/file.hpp"
#include "game/cli/commands.hpp"
#include "game/report/comparison.hpp"

namespace bolt::cli {

namespace {

struct CompareOptions {
    std::string session, measured, joint, html = "out/compare.html";
};

int run_compare(const CompareOptions& options) {
    for (const std::string& input : {options.session, options.measured})
        if (Status apart = require_different_files(input, options.html); !apart)
            return print_error(apart.error());
    Result<session::Reader> reader = session::Reader::open(options.session);
    if (!reader) return print_error(reader.error());
    Result<analysis::Measured> measured = analysis::read_measured(options.measured);
    if (!measured) return print_error(measured.error());
    Result<analysis::Comparison> comparison = analysis::compare(*reader, *measured, options.joint);
    if (!comparison) return print_error(comparison.error());
    if (Status said = print(report::console_text(*comparison)); !said) return print_error(said.error());

    const std::filesystem::path page(options.html);
    std::error_code ignored;  // a folder that cannot be made shows as a page that cannot be written
    if (page.has_parent_path()) std::filesystem::create_directories(page.parent_path(), ignored);
    if (Status kept = write_file(page, report::comparison_page(*comparison)); !kept)
        return print_error(kept.error());
    const Status said = print(page.string() + "\n");
    return said ? 0 : print_error(said.error());
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
