// bolt-models: builds the models that Boltwright ships and writes them as STEP files into the content folder.

#include <fmt/format.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "engine/program/program.hpp"
#include "tools/assets/models/document.hpp"
#include "tools/assets/models/shipped.hpp"

namespace {

using bolt::Status;
using bolt::models::CadDocument;

struct ShippedModel {
    std::string name;  // argument that selects the model
    std::string file;  // path below the content folder
    std::function<Status(CadDocument&)> build;
};

Status write(const ShippedModel& model, const std::filesystem::path& content) {
    const std::filesystem::path path = content / model.file;
    std::error_code error;
    std::filesystem::create_directories(path.parent_path(), error);
    if (error)
        return bolt::fail(
            bolt::ErrorCode::failed,
            fmt::format("{}: cannot create the folder: {}", path.parent_path().string(), error.message()),
            "a folder that this user may write to");
    CadDocument document(path.stem().string());
    BOLT_TRY(model.build(document));
    BOLT_TRY(document.write_step(path.string()));
    fmt::print("{}\n", path.string());
    return {};
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Builds the models that Boltwright ships, as STEP files.", "bolt-models");
    std::string which = "all", content;
    int exit_code = 0;
    const std::vector<ShippedModel> models = {
        {"zq350", "assemblies/zq350/zq350.step", bolt::models::add_zq350},
        {"zq350-base", "assemblies/zq350/zq350-base.step", bolt::models::add_zq350_base},
        {"dn200-pn16", "assemblies/dn200-pn16/dn200-pn16.step", bolt::models::add_dn200_pn16},
        {"cover-m8", "assemblies/cover-m8/cover-m8.step", bolt::models::add_cover_m8},
        {"pump-32-160", "assemblies/pump-32-160/pump-32-160.step", bolt::models::add_pump_32_160},
        {"tools", "tools/wrench-13.step",
         [](CadDocument& d) { return bolt::models::add_wrench(d, 13.0, 140.0); }},
        {"tools", "tools/wrench-24.step",
         [](CadDocument& d) { return bolt::models::add_wrench(d, 24.0, 230.0); }},
        {"tools", "tools/wrench-30.step",
         [](CadDocument& d) { return bolt::models::add_wrench(d, 30.0, 380.0); }},
        {"tools", "tools/torque-wrench-24.step",
         [](CadDocument& d) { return bolt::models::add_torque_wrench(d, 24.0); }},
    };
    std::vector<std::string> names = {"all"};
    for (const ShippedModel& model : models) names.push_back(model.name);
    app.add_option("model", which, "Model to build, or all")
        ->check(CLI::IsMember(names))
        ->capture_default_str();
    app.add_option("-o,--output", content, "Content folder to write to")->required();
    app.callback([&] {
        for (const ShippedModel& model : models) {
            if (which != "all" && which != model.name) continue;
            if (const Status done = write(model, content); !done) {
                fmt::print(stderr, "{}\n", done.error().message());
                exit_code = static_cast<int>(done.error().code);
                return;
            }
        }
    });
    return bolt::run_command_line(app, argc, argv, exit_code);
}
