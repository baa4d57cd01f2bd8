// boltwright report, export and compare: the commands that read recorded sessions.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <memory>

#include "content/trainee/people.hpp"
#include "engine/base/file.hpp"
#include "engine/base/math.hpp"
#include "engine/base/result.hpp"
#include "game/analysis/comparison.hpp"
#include "game/analysis/same_joint.hpp"
#include "game/analysis/session_data.hpp"
#include "game/cli/commands.hpp"
#include "game/measure/fit.hpp"
#include "game/report/report.hpp"
#include "game/session/export.hpp"
#include "game/session/session_file.hpp"

namespace bolt::cli {

namespace {

// The names of the people of this computer. If they cannot be read, sessions show what they recorded.
report::TraineeNames trainee_names(bool show) {
    report::TraineeNames names;
    names.show = show;
    const auto folder = content::people_folder();
    if (!folder) return names;
    if (auto people = content::list_people(*folder))
        names.people = std::move(*people);
    else
        (void)print_error(people.error());
    return names;
}

int run_report(const std::vector<std::string>& files, const std::string& html, bool overview, bool names) {
    std::vector<session::SessionReader> readers;
    for (const std::string& file : files) {
        if (Status different = require_different_files(file, html); !different)
            return print_error(different.error());
        Result<session::SessionReader> reader = session::SessionReader::open(file);
        if (!reader) return print_error(reader.error());
        if (!reader->complete())
            (void)std::fputs(
                fmt::format("{}: this session was cut short; the report shows the recorded part\n", file)
                    .c_str(),
                stderr);
        readers.push_back(std::move(*reader));
    }
    std::vector<const session::SessionReader*> sessions;
    sessions.reserve(readers.size());
    for (const session::SessionReader& reader : readers) sessions.push_back(&reader);
    Result<std::string> page = report::make_report(
        sessions, overview ? report::ReportExtent::overview : report::ReportExtent::everything,
        trainee_names(names));
    if (!page) return print_error(page.error());
    if (Status written = write_file(html, *page); !written) return print_error(written.error());
    const Status printed = print(html + "\n");
    return printed ? 0 : print_error(printed.error());
}

int run_export(const std::string& file, const std::string& csv, std::uint64_t every) {
    if (Status different = require_different_files(file, csv); !different)
        return print_error(different.error());
    Result<session::SessionReader> reader = session::SessionReader::open(file);
    if (!reader) return print_error(reader.error());
    (void)std::signal(SIGPIPE, SIG_IGN);  // a closed pipe is an error that we report
    session::CsvOptions options;
    options.every_n = every;
    if (csv == "-") {
        const Status written = session::export_csv(*reader, stdout, options);
        return written ? 0 : print_error(written.error());
    }
    std::FILE* out = std::fopen(csv.c_str(), "wb");
    Error error;
    error.file = csv;
    error.expected = "a path that this user may write to, and free space";
    if (out == nullptr) {
        error.what = std::string("cannot be written: ") + std::strerror(errno);
        return print_error(error);
    }
    options.out_name = csv;
    const Status written = session::export_csv(*reader, out, options);
    const bool closed = std::fclose(out) == 0;
    if (!written) return print_error(written.error());
    if (!closed) {
        error.what = std::string("cannot be written: ") + std::strerror(errno);
        return print_error(error);
    }
    return 0;
}

}  // namespace

void add_report(CLI::App& app, int& exit_code) {
    struct ReportOptions {
        std::vector<std::string> sessions;
        std::string html;
        bool overview = false, names = false;
    };
    auto options = std::make_shared<ReportOptions>();
    CLI::App* report =
        app.add_subcommand("report", "Write a page about one session, or a comparison of several attempts");
    report->add_option("session", options->sessions, "Session files, oldest first")->required();
    report->add_option("--html", options->html, "HTML page to write")->required();
    report->add_flag("--overview", options->overview, "Write only the comparison of several sessions");
    report->add_flag("--names", options->names,
                     "Show the names of this computer's trainees beside their codes; without it the page can "
                     "be passed on");
    report->callback([options, &exit_code] {
        exit_code = run_report(options->sessions, options->html, options->overview, options->names);
    });
}

void add_export(CLI::App& app, int& exit_code) {
    struct ExportOptions {
        std::string session;
        std::string csv;
        std::uint64_t every = 1;
    };
    auto options = std::make_shared<ExportOptions>();
    CLI::App* exporter = app.add_subcommand("export", "Export the ticks of a session as CSV");
    exporter->add_option("session", options->session, "Session file")->required();
    exporter->add_option("--csv", options->csv, "CSV file to write, - for stdout")->required();
    exporter->add_option("--every", options->every, "Write every n-th tick only")
        ->check(CLI::Range(1, 1'000'000))
        ->capture_default_str();
    exporter->callback(
        [options, &exit_code] { exit_code = run_export(options->session, options->csv, options->every); });
}

namespace {

struct CompareOptions {
    std::string session, measured, joint, html = "out/compare.html", fit;
    std::vector<std::string> runs;
    bool same_joint = false;
};

// Fails if the runs of a record differ as those of several joints do.
Status check_same_slopes(const CompareOptions& options, const analysis::Comparison& comparison,
                         const std::vector<measure::Landmarks>& runs) {
    std::size_t least = runs.size(), most = runs.size();
    for (std::size_t i = 0; i < runs.size(); ++i) {
        if (!runs[i].linear) continue;
        if (least == runs.size() || runs[i].linear->slope < runs[least].linear->slope) least = i;
        if (most == runs.size() || runs[i].linear->slope > runs[most].linear->slope) most = i;
    }
    if (least == runs.size()) return {};
    const double low = runs[least].linear->slope, high = runs[most].linear->slope;
    if (high <= analysis::largest_slope_ratio * low) return {};
    return fail(ErrorCode::usage,
                fmt::format("{}: the slopes of its runs differ by a factor of {:.2f} (\"{}\" {:.3g} N·m/°, "
                            "\"{}\" {:.3g} N·m/°), as those of several joints do",
                            options.measured, high / low, comparison.measured[least].name, to_radians(low),
                            comparison.measured[most].name, to_radians(high)),
                "the runs of one joint, with --run, or --same-joint");
}

// Fits the mechanistic law to the record, from the design of the compared joint, and writes the joint type.
Status fit_measured(const CompareOptions& options, const session::SessionReader& session,
                    const analysis::Comparison& comparison) {
    if (comparison.joints.size() != 1)
        return fail(ErrorCode::usage,
                    fmt::format("--fit is given, but {} joints are compared", comparison.joints.size()),
                    "--joint with the id of one joint");
    const analysis::JointComparison& compared = comparison.joints.front();
    if (!compared.mismatch_reason.empty())
        return fail(ErrorCode::usage,
                    fmt::format("{} cannot be fitted: {}", compared.joint, compared.mismatch_reason),
                    "a record of this joint, or --same-joint if only the torques differ");
    BOLT_TRY_ASSIGN(const auto assembly, analysis::stored_assembly(session));
    const content::AssemblyJoint* joint = nullptr;
    for (const content::AssemblyJoint& j : assembly.joints)
        if (j.design.id == compared.joint) joint = &j;
    if (joint == nullptr)
        return fail(ErrorCode::failed, "the session has no joint " + compared.joint, "its assembly");
    std::vector<measure::Landmarks> runs;
    for (const analysis::MeasuredCurve& run : comparison.measured)
        runs.push_back(measure::find_landmarks(run.curve));
    if (!options.same_joint) BOLT_TRY(check_same_slopes(options, comparison, runs));
    BOLT_TRY_ASSIGN(const auto fit, measure::fit_joint(joint->design, runs, comparison.direction));
    BOLT_TRY(write_file(options.fit,
                        measure::joint_type_json(fit, joint->type + "-measured", joint->spec.torque.target)));
    return print(measure::fit_text(fit) + options.fit + "\n");
}

int run_compare(const CompareOptions& options) {
    for (const std::string& input : {options.session, options.measured})
        for (const std::string& output : {options.html, options.fit})
            if (Status different = require_different_files(input, output); !different)
                return print_error(different.error());
    Result<session::SessionReader> reader = session::SessionReader::open(options.session);
    if (!reader) return print_error(reader.error());
    Result<analysis::MeasuredRecord> measured = analysis::read_measured(options.measured);
    if (!measured) return print_error(measured.error());
    if (Status selected = analysis::select_runs(*measured, options.runs); !selected)
        return print_error(selected.error());
    analysis::ComparisonOptions comparing;
    comparing.same_joint = options.same_joint;
    Result<analysis::Comparison> comparison = analysis::compare(*reader, *measured, options.joint, comparing);
    if (!comparison) return print_error(comparison.error());
    if (Status printed = print(report::console_text(*comparison)); !printed)
        return print_error(printed.error());

    const std::filesystem::path page(options.html);
    std::error_code ignored;  // write_file reports the error
    if (page.has_parent_path()) std::filesystem::create_directories(page.parent_path(), ignored);
    if (Status written = write_file(page, report::comparison_page(*comparison)); !written)
        return print_error(written.error());
    if (Status printed = print(page.string() + "\n"); !printed) return print_error(printed.error());
    if (options.fit.empty()) return 0;
    const Status fitted = fit_measured(options, *reader, *comparison);
    return fitted ? 0 : print_error(fitted.error());
}

}  // namespace

void add_compare(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<CompareOptions>();
    CLI::App* compare =
        app.add_subcommand("compare", "Compare a session with a measured torque-angle record");
    compare->add_option("session", options->session, "Session file")->required();
    compare->add_option("measured", options->measured, "CSV with angle_deg, torque_Nm and optionally cycle")
        ->required();
    compare->add_option("--joint", options->joint,
                        "Id of one joint; default: all joints turned in the measured direction");
    compare
        ->add_option("--run", options->runs,
                     "Name of a run of the record, as in its column cycle; may be given for several; "
                     "default: all runs")
        ->allow_extra_args(false);
    compare->add_option("--fit", options->fit,
                        "Fit friction, compliance and yield to the record, and write the joint type as JSON");
    compare->add_flag("--same-joint", options->same_joint,
                      "Compare although the curves say that the record is of another joint");
    compare->add_option("--html", options->html, "HTML page to write")->capture_default_str();
    compare->callback([options, &exit_code] { exit_code = run_compare(*options); });
}

}  // namespace bolt::cli
