// boltwright measure: brings measurements of a test rig into the form that `compare` reads.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/file.hpp"
#include "engine/base/result.hpp"
#include "game/cli/commands.hpp"
#include "game/measure/import.hpp"

namespace bolt::cli {

namespace {

struct ImportOptions {
    std::string rig;
    std::vector<std::string> files;
    std::string out;
};

int run_measure_import(const ImportOptions& options) {
    const measure::LoadedRig loaded = measure::load_rig(options.rig);
    if (!loaded.ok()) return print_error(loaded.errors);
    std::vector<measure::RigRun> runs;
    for (const std::string& file : options.files) {
        if (Status different = require_different_files(file, options.out); !different)
            return print_error(different.error());
        Result<std::vector<measure::RigRun>> imported = measure::import_file(loaded.rig, file);
        if (!imported) return print_error(imported.error());
        for (measure::RigRun& run : *imported) runs.push_back(std::move(run));
    }
    measure::name_uniquely(runs);
    if (Status written = write_file(options.out, measure::record_csv(loaded.rig, runs)); !written)
        return print_error(written.error());
    const Status printed = print(measure::summary_text(loaded.rig, runs) + options.out + "\n");
    return printed ? 0 : print_error(printed.error());
}

void add_measure_import(CLI::App& measure, int& exit_code) {
    auto options = std::make_shared<ImportOptions>();
    CLI::App* command = measure.add_subcommand(
        "import", "Compute torque over angle from the files of a test rig, with uncertainty and landmarks");
    command->add_option("rig", options->rig, "Description of the rig's channels (docs/measurement.md)")
        ->required();
    command->add_option("files", options->files, "CSV files of the runs, all in one direction")->required();
    command->add_option("--out", options->out, "CSV record to write, for boltwright compare")->required();
    command->callback([options, &exit_code] { exit_code = run_measure_import(*options); });
}

}  // namespace

void add_measure(CLI::App& app, int& exit_code) {
    CLI::App* measure = app.add_subcommand("measure", "Measurements of a test rig");
    measure->require_subcommand(1);
    add_measure_import(*measure, exit_code);
}

}  // namespace bolt::cli
