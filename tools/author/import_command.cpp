// bolt-author import-step: makes the models and a draft of an assembly from a STEP file.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>

#include "engine/base/result.hpp"
#include "tools/author/commands.hpp"
#ifdef BOLT_WITH_STEP
#include "tools/author/import/guard.hpp"
#include "tools/author/import/import_step.hpp"
#endif

namespace bolt::author {

#ifdef BOLT_WITH_STEP

namespace {

// Prints the progress to stderr: one line that is overwritten on a terminal, otherwise one line every 10 %.
class ImportProgressLine {
  public:
    ImportProgressLine() : terminal_(isatty(STDERR_FILENO) == 1) {}

    void operator()(double fraction, const std::string& what) {
        const int percent = static_cast<int>(100.0 * fraction);
        if (terminal_) {
            if (percent == last_ && what == what_) return;
            write(fmt::format("\r\033[K{:3d} % {}", percent, what.substr(0, 70)));
            if (percent == 100) write("\r\033[K");
        } else if (percent / 10 > last_ / 10 || last_ < 0) {
            write(fmt::format("{:3d} % {}\n", percent, what));
        }
        last_ = percent;
        what_ = what;
    }

    void clear() const {
        if (terminal_ && last_ >= 0) write("\r\033[K");
    }

  private:
    bool terminal_;
    int last_ = -1;
    std::string what_;

    static void write(const std::string& text) {
        (void)std::fputs(text.c_str(), stderr);
        (void)std::fflush(stderr);
    }
};

struct ImportCommand {
    step_import::ImportOptions options;
    step_import::GuardLimits limits;
};

// Runs in the child process.
int import_into_channel(const step_import::ImportOptions& options, step_import::GuardChannel& channel) {
    ImportProgressLine line;
    const step_import::ImportResult imported =
        step_import::import_step(options, [&](double fraction, const std::string& what) {
            channel.set_phase(what);
            line(fraction, what);
        });
    line.clear();
    if (!imported.ok()) return print_error(imported.errors);
    if (channel.append_result(step_import::summary(imported.report))) return 0;
    Error error;
    error.what = "the summary cannot be stored";
    error.expected = "free memory";
    return print_error(error);
}

// Describes why a child process ended before its work was done.
Error describe_end(const ImportCommand& command, const step_import::GuardedRun& run) {
    using step_import::GuardOutcome;
    Error error;
    error.code = ErrorCode::bad_content;
    error.file = command.options.step.string();
    const std::string phase = run.phase.empty() ? "starting" : run.phase;
    switch (run.outcome) {
        case GuardOutcome::crashed:
            error.what = fmt::format("OpenCASCADE ended by signal {} while {}", run.code, phase);
            error.expected =
                "a STEP file that OpenCASCADE can read: this one may be damaged, export it from CAD again";
            break;
        case GuardOutcome::out_of_time:
            error.what = fmt::format("OpenCASCADE did not finish within {} s of processor time while {}",
                                     command.limits.processor_s, phase);
            error.expected =
                "a STEP file that is not damaged, or, if it is only large, a greater --time-limit or "
                "--deflection";
            break;
        case GuardOutcome::out_of_memory:
            error.what = fmt::format("OpenCASCADE needed more than {} MiB of memory while {}",
                                     command.limits.memory_mib, phase);
            error.expected =
                "a STEP file that is not damaged, or, if it is only large, a greater --memory-limit or "
                "--deflection";
            break;
        case GuardOutcome::killed:
            error.code = ErrorCode::failed;
            error.what =
                fmt::format("another program stopped the import (signal {}) while {}", run.code, phase);
            error.expected = "enough memory; a greater --deflection needs less";
            break;
        default:
            error.code = ErrorCode::failed;
            error.what = fmt::format("no process can be started: {}", std::strerror(run.code));
            break;
    }
    return error;
}

int import_guarded(ImportCommand command) {
    const step_import::GuardLimits limits = step_import::default_limits(command.options.step);
    if (command.limits.processor_s == 0) command.limits.processor_s = limits.processor_s;
    if (command.limits.memory_mib == 0) command.limits.memory_mib = limits.memory_mib;
    step_import::GuardedRun run;
    {
        auto staging = step_import::StagingFolder::create(command.options.folder);
        if (!staging) return print_error(staging.error());
        command.options.write_to = staging->path();
        run = step_import::run_guarded(command.limits, [&](step_import::GuardChannel& channel) {
            return import_into_channel(command.options, channel);
        });
        if (run.outcome == step_import::GuardOutcome::exited) {
            if (run.code != 0) return run.code;
            if (const Status published = staging->publish(); !published)
                return print_error(published.error());
            const Status printed = print(run.result);
            return printed ? 0 : print_error(printed.error());
        }
    }
    if (isatty(STDERR_FILENO) == 1) (void)std::fputs("\r\033[K", stderr);
    if (run.outcome != step_import::GuardOutcome::interrupted) return print_error(describe_end(command, run));
    (void)std::raise(run.code);  // ends this program as if the signal had not been blocked
    return 128 + run.code;
}

}  // namespace

void add_import_step(CLI::App& app, int& exit_code) {
    auto command = std::make_shared<ImportCommand>();
    command->limits = {0, 0};
    step_import::ImportOptions* options = &command->options;
    CLI::App* import = app.add_subcommand(
        "import-step", "Make the models of an assembly, and a draft of its file, from a STEP file");
    import->add_option("step", options->step, "STEP file (AP203, AP214, AP242)")->required();
    import->add_option("-o,--out", options->folder, "Folder for the files; a materials.json in it is used")
        ->required();
    import->add_option("--name", options->name, "Name of the files; the STEP file's if not given");
    import->add_option("--deflection", options->deflection_mm, "Largest distance of chord and surface, mm")
        ->check(CLI::Range(0.001, 50.0))
        ->capture_default_str();
    import->add_option("--angle", options->angle_deg, "Largest angle between neighbouring chords, degrees")
        ->check(CLI::Range(1.0, 60.0))
        ->capture_default_str();
    import
        ->add_option("--contact-deflection", options->contact_deflection_mm,
                     "Deflection of the contact model, mm; as --deflection if not given")
        ->check(CLI::Range(0.001, 50.0));
    import->add_flag("--lod", options->far_level, "Also write NAME.far.glb, the far level of detail");
    import->add_option("--far-triangles", options->far_triangles, "Triangles of the far level, all instances")
        ->check(CLI::Range(100, 10'000'000))
        ->capture_default_str();
    import
        ->add_option(
            "--turn-heads", options->turn_heads,
            "Ids of joints whose bolt is turned at its hexagon head instead of its nut, as J1,J2; or all")
        ->delimiter(',');
    import->add_flag("!--no-joints", options->joints, "Find no joints and draft no assembly.json");
    import
        ->add_option("--time-limit", command->limits.processor_s,
                     "Processor time after which the import is given up, s; by the file's size if not given")
        ->check(CLI::Range(1U, 1'000'000U));
    import
        ->add_option(
            "--memory-limit", command->limits.memory_mib,
            "Memory above which the import is given up, MiB; three quarters of the machine's if not given")
        ->check(CLI::Range(std::uint64_t{256}, std::uint64_t{1} << 30U));
    import->callback([command, &exit_code] { exit_code = import_guarded(*command);
});
}

#else

void add_import_step(CLI::App& app, int& exit_code) {
    auto ignored = std::make_shared<std::string>();
    CLI::App* import =
        app.add_subcommand("import-step", "Not in this build: it was made without OpenCASCADE");
    import->add_option("step", *ignored, "STEP file");
    import->allow_extras();
    import->callback([ignored, &exit_code] {
        Error error;
    error.code = ErrorCode::failed;
    error.what = "this bolt-author was built without OpenCASCADE, which reads STEP files";
    error.expected = "a build with libocct-data-exchange-dev installed";
    exit_code = print_error(error);
});
}

#endif

}  // namespace bolt::author
