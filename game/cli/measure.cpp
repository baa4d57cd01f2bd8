// boltwright measure: brings measurements of a test rig into the form that `compare` reads.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "content/format/assembly.hpp"
#include "engine/base/file.hpp"
#include "engine/base/result.hpp"
#include "game/analysis/comparison.hpp"
#include "game/analysis/measured.hpp"
#include "game/cli/commands.hpp"
#include "game/measure/import.hpp"
#include "game/measure/simulated_rig.hpp"
#include "game/measure/validation.hpp"
#include "game/report/report.hpp"
#include "haptics/joint/group.hpp"

namespace bolt::cli {

namespace {

struct MeasureImportOptions {
    std::string rig;
    std::vector<std::string> files;
    std::string out;
};

int run_measure_import(const MeasureImportOptions& options) {
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
    auto options = std::make_shared<MeasureImportOptions>();
    CLI::App* command = measure.add_subcommand(
        "import", "Compute torque over angle from the files of a test rig, with uncertainty and landmarks");
    command->add_option("rig", options->rig, "Description of the rig's channels (docs/measurement.md)")
        ->required();
    command->add_option("files", options->files, "CSV files of the runs, all in one direction")->required();
    command->add_option("--out", options->out, "CSV record to write, for boltwright compare")->required();
    command->callback([options, &exit_code] { exit_code = run_measure_import(*options); });
}

struct SimulateOptions {
    std::string assembly = "zq350", out = "out/simulated";
    std::vector<std::string> variants;
    std::uint64_t seed = 1;
};

// The thread of all joints, as a rig names it; empty if they differ.
std::string common_thread(const content::Assembly& assembly) {
    const joint::ThreadSize& first = assembly.joints.front().design.thread;
    for (const content::AssemblyJoint& joint : assembly.joints)
        if (joint.design.thread.thread.d != first.thread.d ||
            joint.design.thread.thread.pitch != first.thread.pitch)
            return {};
    return joint::name(first);
}

// Writes the sensor data of one run for each joint, and imports it again from the disk, as a laboratory's
// data would be.
Result<analysis::MeasuredRecord> simulate_record(const content::Assembly& assembly,
                                                 const std::filesystem::path& folder, std::uint64_t seed) {
    std::error_code ignored;  // write_file reports the error
    std::filesystem::create_directories(folder, ignored);
    const measure::SensorModel model;
    const std::filesystem::path rig_file = folder / "rig.json", record_file = folder / "record.csv";
    const std::string title = fmt::format("Simulated rig, {} {}", assembly.name, assembly.variant);
    BOLT_TRY(write_file(rig_file, measure::simulated_rig_json(model, title, common_thread(assembly))));
    const measure::LoadedRig rig = measure::load_rig(rig_file);
    if (!rig.ok()) return fail(rig.errors.front());
    std::vector<measure::RigRun> runs;
    for (std::size_t i = 0; i < assembly.joints.size(); ++i) {
        const content::AssemblyJoint& joint = assembly.joints[i];
        const std::filesystem::path file = folder / (joint.design.id + ".csv");
        const auto rows =
            measure::simulate_run(joint.design, joint.spec.torque.target, seed * 1000 + i, model);
        BOLT_TRY(write_file(file, measure::sensor_csv(rows)));
        BOLT_TRY_ASSIGN(auto imported, measure::import_file(rig.rig, file));
        for (measure::RigRun& run : imported) runs.push_back(std::move(run));
    }
    measure::name_uniquely(runs);
    BOLT_TRY(write_file(record_file, measure::record_csv(rig.rig, runs)));
    BOLT_TRY(write_file(folder / "summary.txt", measure::summary_text(rig.rig, runs)));
    return analysis::read_measured(record_file);
}

// The published law of one joint type against the runs of its joints.
Result<analysis::Comparison> compare_published(const content::Assembly& assembly,
                                               const analysis::MeasuredRecord& record,
                                               const content::AssemblyJoint& type) {
    analysis::TorqueCurveBuilder builder(joint::Direction::tighten);
    for (const joint::CurveSample& s :
         joint::torque_angle_curve(joint::make_published_group({type.published.law}), {}))
        builder.add(s.angle, s.torque, s.stage);
    analysis::Comparison c;
    c.title = assembly.name;
    c.law = "published";
    c.variant = assembly.variant;
    c.measured_file = record.file;
    c.source = record.source;
    c.options.same_joint = true;      // the runs are of these joints; the laws differ
    c.options.mre_floor_share = 0.0;  // as in the paper's Table 2
    const std::vector<analysis::MeasuredCurve> all = analysis::measured_curves(record);
    for (std::size_t i = 0; i < all.size(); ++i)  // one run for each joint, in their order
        if (assembly.joints[i].type == type.type) c.measured.push_back(all[i]);
    BOLT_TRY_ASSIGN(auto joint, analysis::compare_joint(type.type, builder.finish(), c.measured, c.options));
    c.errors = joint.errors;
    c.joints.push_back(std::move(joint));
    return c;
}

Result<report::MaterialComparison> compare_material(const content::Assembly& assembly,
                                                    const analysis::MeasuredRecord& record) {
    report::MaterialComparison material;
    material.variant = assembly.variant;
    for (const content::AssemblyJoint& joint : assembly.joints) {
        const auto same = [&](const analysis::Comparison& c) { return c.joints.front().joint == joint.type; };
        if (std::any_of(material.types.begin(), material.types.end(), same)) continue;
        BOLT_TRY_ASSIGN(auto type, compare_published(assembly, record, joint));
        material.types.push_back(std::move(type));
    }
    return material;
}

// A variant may be a lesson about other joints, which have no counterpart in the table.
bool same_joints(const content::Assembly& a, const content::Assembly& b) {
    return std::equal(a.joints.begin(), a.joints.end(), b.joints.begin(), b.joints.end(),
                      [](const content::AssemblyJoint& x, const content::AssemblyJoint& y) {
                          return x.design.id == y.design.id;
                      });
}

int run_measure_simulate(SimulateOptions options) {
    if (options.variants.empty()) {
        const content::LoadedAssembly loaded = content::load_assembly(options.assembly);
        if (!loaded.ok()) return print_error(loaded.errors);
        for (const content::AssemblyVariant& v : loaded.assembly.variants)
            if (same_joints(loaded.assembly, content::load_assembly(options.assembly, v.name).assembly))
                options.variants.push_back(v.name);
        if (options.variants.empty()) options.variants.emplace_back();
    }
    const std::filesystem::path out(options.out);
    std::vector<report::MaterialComparison> materials;
    for (const std::string& variant : options.variants) {
        const content::LoadedAssembly loaded = content::load_assembly(options.assembly, variant);
        if (!loaded.ok()) return print_error(loaded.errors);
        const auto record = simulate_record(loaded.assembly, out / variant, options.seed);
        if (!record) return print_error(record.error());
        Result<report::MaterialComparison> comparison = compare_material(loaded.assembly, *record);
        if (!comparison) return print_error(comparison.error());
        materials.push_back(std::move(*comparison));
    }
    const std::filesystem::path page = out / "table2.html";
    if (Status written = write_file(page, report::paper_table_page(materials)); !written)
        return print_error(written.error());
    const Status printed = print(report::paper_table_text(materials) + "\n" + page.string() + "\n");
    return printed ? 0 : print_error(printed.error());
}

void add_measure_simulate(CLI::App& measure, int& exit_code) {
    auto options = std::make_shared<SimulateOptions>();
    CLI::App* command = measure.add_subcommand("simulate",
                                               "Simulate the sensor data of a rig with the mechanistic law, "
                                               "import it, and compare the published law");
    command->add_option("assembly", options->assembly, "Folder, file, or name under content/assemblies")
        ->capture_default_str();
    command->add_option("--variant", options->variants,
                        "Variants; default: all that work on the same joints as the default one");
    command->add_option("--seed", options->seed, "Seed of bolts, operator and sensors")
        ->check(CLI::Range(0, 1'000'000))
        ->capture_default_str();
    command->add_option("--out", options->out, "Folder to write into")->capture_default_str();
    command->callback([options, &exit_code] { exit_code = run_measure_simulate(*options); });
}

struct MeasureValidateOptions {
    std::string data, out = "out/validation";
};

constexpr std::size_t largest_validation_file = 4U << 20U;  // bytes

// Writes the page of a validation and returns its text.
Result<std::string> written_validation(const measure::Validation& validation,
                                       const std::filesystem::path& page) {
    report::SeriesPage shown{
        validation.title,   validation.source,  validation.verdict,     validation.x_label,
        validation.y_label, validation.caption, validation.is_sequence, {}};
    for (const measure::ValidationSeries& series : validation.series)
        shown.plots.push_back({series.name, series.x, series.measured, series.law});
    BOLT_TRY(write_file(page, report::series_page(shown)));
    return validation.text;
}

// The section of one joint; writes its comparison page.
Result<std::string> joint_validation(const content::AssemblyJoint& joint,
                                     const MeasureValidateOptions& options) {
    const std::filesystem::path file = std::filesystem::path(options.data) / (joint.design.id + ".csv");
    BOLT_TRY_ASSIGN(const auto text, read_file(file, largest_validation_file, ErrorCode::bad_content));
    const std::filesystem::path page = std::filesystem::path(options.out) / (joint.design.id + ".html");
    if (joint.design.id.starts_with("retightening")) {
        BOLT_TRY_ASSIGN(
            const auto validation,
            measure::validate_retightening(joint.design, joint.spec.torque.target, text, file.string()));
        return written_validation(validation, page);
    }
    BOLT_TRY_ASSIGN(const auto record, analysis::parse_measured(text, file.string()));
    BOLT_TRY_ASSIGN(const auto validation, measure::validate_loosening(joint.design, record));
    BOLT_TRY(write_file(page, report::comparison_page(validation.comparison)));
    return measure::loosening_text(validation);
}

Result<std::string> validation_text(const MeasureValidateOptions& options) {
    const std::filesystem::path data(options.data);
    std::vector<std::filesystem::path> assemblies;
    std::error_code problem;
    for (const auto& entry : std::filesystem::directory_iterator(data, problem))
        if (entry.path().extension() == ".json") assemblies.push_back(entry.path());
    std::sort(assemblies.begin(), assemblies.end());
    if (assemblies.empty())
        return fail(ErrorCode::usage, options.data + ": there are no joints in this folder",
                    "a folder with assembly files (.json) and a CSV for each of their joints");
    std::string out =
        "# The mechanistic law against published data\n\nMade by `boltwright measure validate "
        "docs/validation --out docs/validation`. The .json files describe the joints, with what is known and "
        "what is assumed about them.\n\n";
    for (const std::filesystem::path& file : assemblies) {
        const content::LoadedAssembly loaded = content::load_assembly(file);
        if (!loaded.ok()) return fail(loaded.errors.front());
        for (const content::AssemblyJoint& joint : loaded.assembly.joints) {
            BOLT_TRY_ASSIGN(const auto section, joint_validation(joint, options));
            out += section;
        }
    }
    const std::filesystem::path table = data / "vdi2230_a1.csv";
    BOLT_TRY_ASSIGN(const auto rows, read_file(table, largest_validation_file, ErrorCode::bad_content));
    BOLT_TRY_ASSIGN(const auto preloads, measure::validate_preload_table(rows, table.string()));
    BOLT_TRY_ASSIGN(const auto section,
                    written_validation(preloads, std::filesystem::path(options.out) / "vdi2230_a1.html"));
    return out + section;
}

int run_measure_validate(const MeasureValidateOptions& options) {
    std::error_code ignored;  // write_file reports the error
    std::filesystem::create_directories(options.out, ignored);
    Result<std::string> text = validation_text(options);
    if (!text) return print_error(text.error());
    text->pop_back();  // the blank line at the end
    const std::filesystem::path page = std::filesystem::path(options.out) / "README.md";
    if (Status written = write_file(page, *text); !written) return print_error(written.error());
    const Status printed = print(*text + "\n" + page.string() + "\n");
    return printed ? 0 : print_error(printed.error());
}

void add_measure_validate(CLI::App& measure, int& exit_code) {
    auto options = std::make_shared<MeasureValidateOptions>();
    CLI::App* command = measure.add_subcommand(
        "validate", "Compare the mechanistic law with published measurements and tables");
    command->add_option("data", options->data, "Folder with the data and its joints, such as docs/validation")
        ->required();
    command->add_option("--out", options->out, "Folder to write into")->capture_default_str();
    command->callback([options, &exit_code] { exit_code = run_measure_validate(*options); });
}

}  // namespace

void add_measure(CLI::App& app, int& exit_code) {
    CLI::App* measure = app.add_subcommand("measure", "Measurements of a test rig");
    measure->require_subcommand(1);
    add_measure_import(*measure, exit_code);
    add_measure_simulate(*measure, exit_code);
    add_measure_validate(*measure, exit_code);
}

}  // namespace bolt::cli
