#include "haptics/joint/group.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "content/format/assembly.hpp"
#include "engine/base/console.hpp"
#include "engine/base/file.hpp"
#include "engine/base/nearest.hpp"
#include "tools/author/commands.hpp"
#include "tools/author/curve_plot.hpp"

namespace bolt::author {

namespace {

struct CurveOptions {
    std::string assembly, variant, joint, law, direction = "tighten", csv, svg;
};

Result<std::size_t> find_joint(const content::Assembly& assembly, const std::string& id) {
    std::vector<std::string> ids;
    for (std::size_t i = 0; i < assembly.joints.size(); ++i) {
        if (assembly.joints[i].design.id == id) return i;
        ids.push_back(assembly.joints[i].design.id);
    }
    const std::string best = nearest(id, ids);
    return fail(ErrorCode::usage, fmt::format("{} has no joint \"{}\"", assembly.name, id),
                best.empty() ? fmt::format("one of {}", fmt::join(ids, ", "))
                             : fmt::format("did you mean {}?", best));
}

int run_curve(const CurveOptions& options) {
    if (options.csv.empty() && options.svg.empty()) {
        Error error;
        error.code = ErrorCode::usage;
        error.what = "there is nothing to write";
        error.expected = "--csv FILE or --svg FILE";
        return print_error(error);
    }
    const content::Loaded loaded = content::load_assembly(options.assembly, options.variant);
    if (!loaded.ok()) return print_error(loaded.errors);
    const content::Assembly& assembly = loaded.assembly;
    Result<std::size_t> joint = find_joint(assembly, options.joint);
    if (!joint) return print_error(joint.error());

    const joint::Law law = options.law.empty()          ? assembly.law
                           : options.law == "published" ? joint::Law::published
                                                        : joint::Law::mechanistic;
    joint::JointDesign design = assembly.joints[*joint].design;
    design.friction.scatter = 0.0;  // the nominal joint
    const joint::GroupParameters group = law == joint::Law::mechanistic
                                             ? joint::make_group({&design, 1}, nullptr, 0)
                                             : joint::make_published_group(assembly.published);
    joint::CurveOptions curve;
    curve.direction = options.direction == "loosen" ? joint::Direction::loosen : joint::Direction::tighten;
    curve.torque = assembly.joints[*joint].spec.torque.target;

    const std::vector<joint::CurveSample> run = joint::torque_angle_curve(group, curve);
    if (!options.svg.empty()) {
        const std::string title =
            fmt::format("{} {}, law {}, {}", assembly.name, options.joint, name(law), options.direction);
        const Status kept =
            write_file(options.svg, curve_svg(assembly.joints[*joint], run, curve.direction, title));
        if (!kept) return print_error(kept.error());
    }
    if (options.csv.empty()) return 0;
    std::string text = "angle_deg,stage,torque_Nm,clamp_N\n";
    for (const joint::CurveSample& s : run)
        fmt::format_to(std::back_inserter(text), "{:.4f},{},{:.7g},{:.6g}\n", to_degrees(s.angle),
                       name(s.stage), s.torque, s.clamp);
    if (options.csv != "-") {
        const Status kept = write_file(options.csv, text);
        return kept ? 0 : print_error(kept.error());
    }
    const Status said = print(text);
    return said ? 0 : print_error(said.error());
}

}  // namespace

void add_curve(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<CurveOptions>();
    CLI::App* curve =
        app.add_subcommand("curve", "The torque-angle curve of a joint, turned at 30 degrees a second");
    curve->add_option("assembly", options->assembly, "Folder, file, or name under content/assemblies")
        ->required();
    curve->add_option("--joint", options->joint, "Id of the joint")->required();
    curve->add_option("--variant", options->variant, "Material variant; the assembly's default if not given");
    curve->add_option("--law", options->law, "Torque law; the assembly's own if not given")
        ->check(CLI::IsMember({"published", "mechanistic"}));
    curve->add_option("--direction", options->direction)
        ->check(CLI::IsMember({"tighten", "loosen"}))
        ->capture_default_str();
    curve->add_option("--csv", options->csv, "CSV file to write, - for stdout");
    curve->add_option("--svg", options->svg, "Drawing to write");
    curve->callback([options, &exit_code] { exit_code = run_curve(*options); });
}

}  // namespace bolt::author
