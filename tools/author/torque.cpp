#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/base/console.hpp"
#include "haptics/joint/design.hpp"
#include "tools/author/commands.hpp"

namespace bolt::author {

namespace {

struct TorqueOptions {
    std::string size, property_class;
    double mu = 0.12;
    double pitch_mm = 0.0;
    double utilisation = 0.9;
    bool json = false;
};

int run_torque(const TorqueOptions& options) {
    const std::string name =
        options.pitch_mm > 0.0 ? fmt::format("{}x{:g}", options.size, options.pitch_mm) : options.size;
    Result<joint::ThreadSize> size = joint::parse_thread(name);
    if (!size) {
        size.error().code = ErrorCode::usage;
        return print_error(size.error());
    }
    Result<joint::PropertyClass> bolt = joint::property_class(options.property_class, size->size.d);
    if (!bolt) {
        bolt.error().code = ErrorCode::usage;
        return print_error(bolt.error());
    }
    const joint::AssemblyPreload preload = joint::assembly_preload(
        size->thread, *bolt, options.mu, options.mu,
        joint::bearing_mean_diameter(size->size.head_bearing, size->size.hole), options.utilisation);
    std::string text;
    if (options.json) {
        const nlohmann::ordered_json json = {{"size", name},
                                             {"class", bolt->name},
                                             {"mu", options.mu},
                                             {"utilisation", options.utilisation},
                                             {"preload_kN", preload.force / 1e3},
                                             {"torque_Nm", preload.torque}};
        text = json.dump() + "\n";
    } else {
        text = fmt::format("{} {}, mu {:g}, {:.0f} % of yield\npreload_kN {:.1f}\ntorque_Nm {:.1f}\n", name,
                           bolt->name, options.mu, 100.0 * options.utilisation, preload.force / 1e3,
                           preload.torque);
    }
    const Status said = print(text);
    return said ? 0 : print_error(said.error());
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
    torque->add_flag("--json", options->json, "One JSON object");
    torque->callback([options, &exit_code] { exit_code = run_torque(*options); });
}

}  // namespace bolt::author
