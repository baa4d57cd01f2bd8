#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <memory>

#include "engine/base/file.hpp"
#include "engine/base/result.hpp"
#include "game/analysis/comparison.hpp"
#include "game/cli/commands.hpp"
#include "game/report/comparison.hpp"
#include "game/report/report.hpp"
#include "game/session/export.hpp"
#include "game/session/session_file.hpp"

namespace bolt::cli {

namespace {

int run_report(const std::vector<std::string>& files, const std::string& html, bool overview) {
    std::vector<session::Reader> readers;
    for (const std::string& file : files) {
        if (Status apart = require_different_files(file, html); !apart) return print_error(apart.error());
        Result<session::Reader> reader = session::Reader::open(file);
        if (!reader) return print_error(reader.error());
        if (!reader->complete())
            (void)std::fputs(
                fmt::format("{}: this session was cut short; the report shows what was kept\n", file).c_str(),
                stderr);
        readers.push_back(std::move(*reader));
    }
    std::vector<const session::Reader*> sessions;
    sessions.reserve(readers.size());
    for (const session::Reader& reader : readers) sessions.push_back(&reader);
    Result<std::string> page =
        report::make_report(sessions, overview ? report::Extent::overview : report::Extent::everything);
    if (!page) return print_error(page.error());
    if (Status kept = write_file(html, *page); !kept) return print_error(kept.error());
    const Status said = print(html + "\n");
    return said ? 0 : print_error(said.error());
}

int run_export(const std::string& file, const std::string& csv, std::uint64_t every) {
    if (Status apart = require_different_files(file, csv); !apart) return print_error(apart.error());
    Result<session::Reader> reader = session::Reader::open(file);
    if (!reader) return print_error(reader.error());
    (void)std::signal(SIGPIPE, SIG_IGN);  // a closed pipe is an error that we report
    session::CsvOptions options;
    options.every_n = every;
    if (csv == "-") {
        const Status kept = session::export_csv(*reader, stdout, options);
        return kept ? 0 : print_error(kept.error());
    }
    std::FILE* out = std::fopen(csv.c_str(), "wb");
    Error error;
    error.file = csv;
    if (out == nullptr) {
        error.what = std::string("cannot be written: ") + std::strerror(errno);
        return print_error(error);
    }
    options.out_name = csv;
    const Status kept = session::export_csv(*reader, out, options);
    const bool closed = std::fclose(out) == 0;
    if (!kept) return print_error(kept.error());
    if (!closed) {
        error.what = std::string("cannot be written: ") + std::strerror(errno);
        return print_error(error);
    }
    return 0;
}

}  // namespace

void add_report(CLI::App& app, int& exit_code) {
    struct Options {
        std::vector<std::string> sessions;
        std::string html;
        bool overview = false;
    };
    auto options = std::make_shared<Options>();
    CLI::App* report =
        app.add_subcommand("report", "A page that shows one session, or how several attempts compare");
    report->add_option("session", options->sessions, "Session files, oldest first")->required();
    report->add_option("--html", options->html, "Page to write")->required();
    report->add_flag("--overview", options->overview, "Of several sessions only how they compare");
    report->callback([options, &exit_code] {
        exit_code = run_report(options->sessions, options->html, options->overview);
    });
}

void add_export(CLI::App& app, int& exit_code) {
    struct Options {
        std::string session;
        std::string csv;
        std::uint64_t every = 1;
    };
    auto options = std::make_shared<Options>();
    CLI::App* exporter = app.add_subcommand("export", "A session's ticks for other programs");
    exporter->add_option("session", options->session, "Session file")->required();
    exporter->add_option("--csv", options->csv, "CSV file to write, - for stdout")->required();
    exporter->add_option("--every", options->every, "One row for so many ticks")
        ->check(CLI::Range(1, 1'000'000))
        ->capture_default_str();
    exporter->callback(
        [options, &exit_code] { exit_code = run_export(options->session, options->csv, options->every); });
}

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
