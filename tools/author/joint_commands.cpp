// The subcommands curve (torque–angle curve of a joint as CSV and SVG) and torque (preload and tightening
// torque).
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "content/format/assembly.hpp"
#include "content/format/read_joints.hpp"
#include "engine/base/file.hpp"
#include "engine/base/nearest.hpp"
#include "engine/base/result.hpp"
#include "game/lesson/law.hpp"
#include "game/lesson/lesson.hpp"
#include "game/plot/html.hpp"
#include "game/plot/plot.hpp"
#include "game/plot/svg.hpp"
#include "haptics/joint/design.hpp"
#include "haptics/joint/group.hpp"
#include "haptics/joint/nut.hpp"
#include "haptics/joint/tapped_thread.hpp"
#include "tools/author/commands.hpp"

namespace bolt::author {

namespace {

constexpr double lead_in = 20.0;  // degrees shown before the first contact

std::size_t first_contact(std::span<const joint::CurveSample> run) {
    const auto touches = [](const joint::CurveSample& s) { return s.stage != joint::Stage::navigation; };
    return static_cast<std::size_t>(std::find_if(run.begin(), run.end(), touches) - run.begin());
}

// Draws a torque–angle curve as an SVG file: shaded stages, target window, clamp force on a second axis.
// Angles are relative to the first contact (tightening) or to the start of the run (loosening).
std::string curve_svg(const content::AssemblyJoint& joint, std::span<const joint::CurveSample> run,
                      joint::Direction direction, std::string_view title) {
    const bool tighten = direction == joint::Direction::tighten;
    const std::size_t contact = tighten ? std::min(first_contact(run), run.size() - 1) : 0;
    const double zero = to_degrees(run[contact].angle);

    plot::Plot plot;
    plot.width = 760.0;
    plot.height = 400.0;
    plot.title = std::string(title);
    std::vector<plot::SvgPoint> torque, clamp;
    double highest_torque = 0.0, highest_clamp = 0.0;
    for (const joint::CurveSample& s : run) {
        const double x = to_degrees(s.angle) - zero;
        if (tighten && x < -lead_in) continue;
        torque.push_back({x, tighten ? s.torque : -s.torque});
        clamp.push_back({x, s.clamp / 1e3});
        highest_torque = std::max(highest_torque, torque.back().y);
        highest_clamp = std::max(highest_clamp, s.clamp / 1e3);
    }
    const plot::AxisRange shown{torque.front().x, torque.back().x};
    const char* const turned = joint.design.turned == joint::TurnedPart::head ? "head" : "nut";
    plot.x = {plot::degree_ticks(shown, 9),
              fmt::format("{} angle {}, °", turned, tighten ? "from first contact" : "turned back")};
    plot.y = {plot::covering_ticks(0.0, std::max(highest_torque, tighten ? joint.spec.torque.high : 0.0)),
              "torque, N·m"};
    plot.y2 = plot::PlotAxis{plot::covering_ticks(0.0, highest_clamp), "clamp, kN"};

    constexpr std::string_view stage_styles[] = {"s0", "s1", "s2", "s3"};
    for (std::size_t i = 0, begin = 0; i <= run.size(); ++i) {
        if (i < run.size() && run[i].stage == run[begin].stage) continue;
        const double low = std::max(to_degrees(run[begin].angle) - zero, shown.low);
        const double high = to_degrees(run[std::min(i, run.size() - 1)].angle) - zero;
        const auto stage = static_cast<std::size_t>(run[begin].stage);
        if (high > low)
            plot.bands.push_back(
                {{low, high}, stage_styles[stage], std::string(name(run[begin].stage)), false, false});
        begin = i;
    }
    if (tighten) {
        plot.bands.push_back({{joint.spec.torque.low, joint.spec.torque.high}, "win", {}, true, false});
        plot.reference_lines.push_back({joint.spec.torque.target, "tgt", "target", true});
    }
    const double column = (shown.high - shown.low) / 1500.0;
    plot.lines.push_back({plot::decimate(clamp, column), "ln cl", true});
    plot.lines.push_back({plot::decimate(torque, column), "ln p2", false});
    return plot::standalone(plot::draw(plot), plot::style_sheet());
}

// The sample at which a run that tightens first reaches a torque; null if it does not.
const joint::CurveSample* first_at_torque(std::span<const joint::CurveSample> run, double torque) {
    const auto found = std::find_if(
        run.begin(), run.end(), [&](const joint::CurveSample& sample) { return sample.torque >= torque; });
    return found == run.end() ? nullptr : &*found;
}

// The torque from which the angles of a joint count, N·m: the snug torque or, in a lesson with passes of kind
// turn, that of the last pass before them.
double start_of_angles(const content::Assembly& assembly, const content::Specification& spec) {
    double start = 0.0;
    for (const content::Pass& pass : assembly.passes) {
        if (pass.kind == content::PassKind::turn) return start > 0.0 ? start : spec.snug_torque;
        if (pass.kind == content::PassKind::tighten) start = pass.fraction * spec.torque.target;
    }
    return spec.snug_torque;
}

// The figures of a run that tightens, one a line.
std::string curve_figures(const content::AssemblyJoint& joint, double start_torque,
                          std::span<const joint::CurveSample> run) {
    const content::Specification& spec = joint.spec;
    std::string text;
    const auto add = [&](std::string_view name, std::string_view unit, double value) {
        text += fmt::format("{}_{} {:.1f}\n", name, unit, value);
    };
    const std::size_t contact = std::min(first_contact(run), run.size() - 1);
    add("first_contact", "deg", to_degrees(run[contact].angle));
    add("angles_count_from", "Nm", start_torque);
    const joint::CurveSample* const start = first_at_torque(run, start_torque);
    if (start == nullptr) return text + "note: this torque is not reached\n";
    const auto angle = [&](const joint::CurveSample& sample) {
        return to_degrees(sample.angle - start->angle);
    };
    add("first_contact_relative", "deg", angle(run[contact]));
    const content::ToleranceWindow& window = spec.torque;
    for (const auto& [name, torque] :
         {std::pair{"lowest_torque", window.low}, std::pair{"target_torque", window.target},
          std::pair{"highest_torque", window.high}}) {
        add(name, "Nm", torque);
        if (const joint::CurveSample* const sample = first_at_torque(run, torque)) {
            add(name, "deg", angle(*sample));
            add(name, "clamp_kN", sample->clamp / 1e3);
        } else {
            text += fmt::format("note: the curve does not reach the {}\n", name);
        }
    }
    const auto yields = std::find_if(run.begin(), run.end(), [](const joint::CurveSample& sample) {
        return sample.stage == joint::Stage::yield;
    });
    if (yields != run.end()) {
        add("yield_stage", "Nm", yields->torque);
        add("yield_stage", "deg", angle(*yields));
    }
    if (!spec.has_angle) return text;
    for (const auto& bound :
         {std::pair{"smallest_angle", spec.angle.low}, std::pair{"target_angle", spec.angle.target},
          std::pair{"largest_angle", spec.angle.high}}) {
        const auto& name = bound.first;
        const double turn = bound.second;
        add(name, "deg", to_degrees(turn));
        const auto found = std::find_if(run.begin(), run.end(), [&](const joint::CurveSample& sample) {
            return sample.angle >= start->angle + turn;
        });
        if (found == run.end())
            text += fmt::format("note: the curve ends before the {}\n", name);
        else
            add(name, "Nm", found->torque);
    }
    return text;
}

struct CurveCommandOptions {
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

int run_curve(const CurveCommandOptions& options) {
    const bool prints_figures = options.csv.empty() && options.svg.empty();
    if (prints_figures && options.direction == "loosen") {
        Error error;
        error.code = ErrorCode::usage;
        error.what = "there is nothing to write";
        error.expected = "--csv FILE or --svg FILE";
        return print_error(error);
    }
    const content::LoadedAssembly loaded = content::load_assembly(options.assembly, options.variant);
    if (!loaded.ok()) return print_error(loaded.errors);
    const content::Assembly& assembly = loaded.assembly;
    Result<std::size_t> index = find_joint(assembly, options.joint);
    if (!index) return print_error(index.error());

    const joint::Law law = joint::law_named(options.law).value_or(assembly.law);
    // The targets of a lesson. The curve is that of the file, because a lesson may start the nut at another
    // place on its thread.
    const content::AssemblyJoint target = lesson::apply_law(assembly, law).joints[*index];
    joint::JointDesign design = target.design;
    design.friction.scatter = 0.0;  // the nominal joint
    const joint::GroupParameters group =
        law == joint::Law::mechanistic ? joint::make_group({&design, 1}, nullptr, 0)
                                       : joint::make_published_group({assembly.joints[*index].published.law});
    joint::CurveOptions curve;
    curve.direction = options.direction == "loosen" ? joint::Direction::loosen : joint::Direction::tighten;
    curve.torque = target.spec.torque.target;

    const std::vector<joint::CurveSample> run = joint::torque_angle_curve(group, curve);
    if (prints_figures) {
        const Status printed =
            print(fmt::format("{} {}, law {}\n{}", options.joint, joint::name(design.thread), name(law),
                              curve_figures(target, start_of_angles(assembly, target.spec), run)));
        return printed ? 0 : print_error(printed.error());
    }
    if (!options.svg.empty()) {
        const std::string title =
            fmt::format("{} {}, law {}, {}", assembly.name, options.joint, name(law), options.direction);
        const Status written = write_file(options.svg, curve_svg(target, run, curve.direction, title));
        if (!written) return print_error(written.error());
    }
    if (options.csv.empty()) return 0;
    std::string text = "angle_deg,stage,torque_Nm,clamp_N\n";
    for (const joint::CurveSample& s : run)
        fmt::format_to(std::back_inserter(text), "{:.4f},{},{:.7g},{:.6g}\n", to_degrees(s.angle),
                       name(s.stage), s.torque, s.clamp);
    if (options.csv != "-") {
        const Status written = write_file(options.csv, text);
        return written ? 0 : print_error(written.error());
    }
    const Status printed = print(text);
    return printed ? 0 : print_error(printed.error());
}

}  // namespace

void add_curve(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<CurveCommandOptions>();
    CLI::App* curve =
        app.add_subcommand("curve",
                           "The torque-angle curve of a joint, turned at 30 degrees a second; without a file "
                           "to write, its figures");
    curve->add_option("assembly", options->assembly, "Folder, file, or name under content/assemblies")
        ->required();
    curve->add_option("--joint", options->joint, "Id of the joint")->required();
    curve->add_option("--variant", options->variant, "Variant; the assembly's default if not given");
    curve->add_option("--law", options->law, "Torque law; the assembly's own if not given")
        ->check(CLI::IsMember({"published", "mechanistic"}));
    curve->add_option("--direction", options->direction, "Direction in which the nut is turned")
        ->check(CLI::IsMember({"tighten", "loosen"}))
        ->capture_default_str();
    curve->add_option("--csv", options->csv, "CSV file to write, - for stdout");
    curve->add_option("--svg", options->svg, "Drawing to write");
    curve->callback([options, &exit_code] { exit_code = run_curve(*options); });
}

namespace {

struct TorqueOptions {
    std::string size, property_class;
    std::string head = "hexagon";
    std::string tapped;  // material of a tapped hole; empty: a nut
    double mu = 0.12;
    double pitch_mm = 0.0;
    double utilisation = 0.9;
    double engagement_mm = 0.0;
    double lever_mm = 0.0, adaptor_mm = 0.0, adaptor_angle_deg = 0.0;  // of a torque wrench; 0: no adaptor
    bool locking = false;
    bool json = false;
};

std::vector<std::string> head_names() {
    return {joint::head_shape_names.names.begin(), joint::head_shape_names.names.end()};
}

// A named value of the answer; the name contains the unit.
struct AnswerValue {
    std::string name;
    double value = 0.0;
};

// The joint that the options describe, without members.
Result<joint::JointDesign> joint_of(const TorqueOptions& options, const std::string& size_name) {
    joint::JointDesign design;
    BOLT_TRY_ASSIGN(design.thread, content::read_thread(size_name));
    BOLT_TRY_ASSIGN(design.bolt_class, joint::property_class(options.property_class, design.thread.size.d));
    const std::string_view size = design.thread.size.name;
    design.turned = joint::TurnedPart::head;  // table A1 of VDI 2230 has the bearing of a head
    design.head = joint::head_shape_named(options.head).value_or(design.head);
    if (design.head == joint::HeadShape::socket && !joint::socket_head(size))
        return fail(ErrorCode::usage, fmt::format("there is no socket head of {} in our table", size),
                    "M5, M6, M8, M10, M12, M16, M20 or M24");
    if (options.locking && !joint::locking_nut(size))
        return fail(ErrorCode::usage, fmt::format("there is no locking nut of {} in our table", size),
                    "M5, M6, M8, M10, M12, M16, M20 or M24");
    if (!options.tapped.empty()) {
        design.form = joint::JointForm::tapped_hole;
        BOLT_TRY_ASSIGN(design.hole.material, joint::tapped_material(options.tapped));
        design.hole.engagement = options.engagement_mm * mm;
    }
    return design;
}

std::vector<AnswerValue> torque_values(const TorqueOptions& options, const joint::JointDesign& design) {
    const joint::AssemblyPreload preload =
        joint::assembly_preload(design.thread.thread, design.bolt_class, options.mu, options.mu,
                                design.bearing_diameter(), options.utilisation);
    std::vector<AnswerValue> values = {{"preload_kN", preload.force / 1e3}, {"torque_Nm", preload.torque}};
    if (options.adaptor_mm > 0.0)
        values.push_back({"torque_wrench_set_to_Nm",
                          preload.torque / joint::adaptor_ratio(options.lever_mm, options.adaptor_mm,
                                                                to_radians(options.adaptor_angle_deg))});
    if (design.is_tapped()) {
        constexpr double vdi_surplus = 1.2;  // joint::needed_engagement() explains it
        const joint::TappedHole& hole = design.hole;
        const auto needed = [&](double surplus) {
            return joint::needed_engagement(design.thread.thread, design.bolt_class, hole.material, surplus) /
                   mm;
        };
        values.push_back({"engagement_needed_mm", needed(1.0)});
        values.push_back({"engagement_needed_vdi_mm", needed(vdi_surplus)});
        if (hole.engagement > 0.0)
            values.push_back({"strips_at_kN", joint::stripping_forces(design.thread.thread, design.bolt_class,
                                                                      hole.material, hole.engagement)
                                                      .least() /
                                                  1e3});
    }
    if (!design.is_tapped()) {
        const joint::HeldPartTorques held = joint::held_part_torques(design, preload.force);
        values.push_back({"thread_on_held_part_Nm", held.thread});
        values.push_back({"friction_on_held_part_Nm", held.friction});
        values.push_back({"second_wrench_bears_Nm", held.second_wrench()});
    }
    if (options.locking) {
        const joint::LockingNut& nut = *joint::locking_nut(design.thread.size.name);
        values.push_back({"prevailing_on_most_Nm", nut.most_on});
        values.push_back({"prevailing_off_least_Nm", nut.least_off});
        values.push_back({"prevailing_fifth_off_least_Nm", nut.least_off_5th});
    }
    return values;
}

int run_torque(const TorqueOptions& options) {
    const std::string name =
        options.pitch_mm > 0.0 ? fmt::format("{}x{:g}", options.size, options.pitch_mm) : options.size;
    Result<joint::JointDesign> design = joint_of(options, name);
    if (!design) {
        design.error().code = ErrorCode::usage;
        return print_error(design.error());
    }
    const std::string& bolt = design->bolt_class.name;
    const std::vector<AnswerValue> values = torque_values(options, *design);
    std::string text;
    if (options.json) {
        nlohmann::ordered_json json = {
            {"size", name}, {"class", bolt}, {"mu", options.mu}, {"utilisation", options.utilisation}};
        for (const AnswerValue& answer : values) json[answer.name] = answer.value;
        text = json.dump() + "\n";
    } else {
        text = fmt::format("{} {}, mu {:g}, {:.0f} % of yield\n", name, bolt, options.mu,
                           100.0 * options.utilisation);
        for (const AnswerValue& answer : values)
            text += fmt::format("{} {:.{}f}\n", answer.name, answer.value,
                                answer.name.starts_with("prevailing") ? 2 : 1);
    }
    const Status printed = print(text);
    return printed ? 0 : print_error(printed.error());
}

}  // namespace

void add_torque(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<TorqueOptions>();
    CLI::App* torque =
        app.add_subcommand("torque", "Assembly preload and tightening torque after VDI 2230 table A1");
    torque->add_option("--size", options->size, "Thread: M4 to M39, or with its pitch, M16x1.5")->required();
    torque->add_option("--class", options->property_class, "Property class: 8.8, 10.9, A2-70, ...")
        ->required();
    torque->add_option("--mu", options->mu, "Friction of thread and head")
        ->check(CLI::Range(0.01, 1.0))
        ->capture_default_str();
    torque->add_option("--pitch", options->pitch_mm, "Pitch in mm of a fine thread")
        ->check(CLI::PositiveNumber);
    torque->add_option("--utilisation", options->utilisation, "Share of the yield strength")
        ->check(CLI::Range(0.01, 1.0))
        ->capture_default_str();
    torque->add_option("--head", options->head, "Head: hexagon (ISO 4014) or socket (ISO 4762)")
        ->check(CLI::IsMember(head_names()))
        ->capture_default_str();
    CLI::Option* tapped =
        torque->add_option("--tapped", options->tapped,
                           "Material of a tapped hole, such as GJL-250: adds the engagement at "
                           "which the bolt breaks before a thread strips");
    torque
        ->add_option("--engagement", options->engagement_mm, "Engaged thread in mm: adds its stripping force")
        ->check(CLI::Range(0.1, 1000.0))
        ->needs(tapped);
    torque->add_flag("--locking", options->locking,
                     "Adds the prevailing torques of a locking nut (ISO 2320)");
    CLI::Option* lever =
        torque
            ->add_option("--lever", options->lever_mm,
                         "Lever of a torque wrench without its adaptor in mm, to the grip's mark")
            ->check(CLI::Range(50.0, 3000.0));
    CLI::Option* adaptor =
        torque
            ->add_option("--adaptor", options->adaptor_mm,
                         "Length of an adaptor on the torque wrench in mm: adds the setting of its scale")
            ->check(CLI::Range(1.0, 1000.0))
            ->needs(lever);
    lever->needs(adaptor);
    torque
        ->add_option("--adaptor-angle", options->adaptor_angle_deg,
                     "Angle of the adaptor in degrees: 0 lengthens the lever, 90 changes nothing")
        ->check(CLI::Range(0.0, 90.0))
        ->needs(adaptor);
    torque->add_flag("--json", options->json, "One JSON object");
    torque->callback([options, &exit_code] { exit_code = run_torque(*options); });
}

}  // namespace bolt::author
