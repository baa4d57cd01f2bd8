// bolt-models: builds the models that we ship and writes them as STEP files into the content folder.

#include <fmt/format.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "game/cli/program.hpp"
#include "tools/models/cover/cover.hpp"
#include "tools/models/document.hpp"
#include "tools/models/flange/flange.hpp"
#include "tools/models/reducer/zq350.hpp"
#include "tools/models/wrench/torque_wrench.hpp"
#include "tools/models/wrench/wrench.hpp"

namespace {

using bolt::Status;
using bolt::models::Document;

struct Model {
    std::string name;
    std::string file;  // below the content folder
    std::function<Status(bolt::models::Document&)> build;
};

Status write(const Model& model, const std::filesystem::path& content) {
    const std::filesystem::path path = content / model.file;
    std::error_code problem;
    std::filesystem::create_directories(path.parent_path(), problem);
    if (problem)
        return bolt::fail(bolt::ErrorCode::failed,
                          fmt::format("{}: {}", path.parent_path().string(), problem.message()));
    bolt::models::Document document(path.stem().string());
    if (const Status built = model.build(document); !built) return built;
    if (const Status written = document.write_step(path.string()); !written) return written;
    fmt::print("{}\n", path.string());
    return {};
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Builds the models that Boltwright ships, as STEP files.", "bolt-models");
    std::string which = "all", content;
    int exit_code = 0;
    const std::vector<Model> models = {
        {"zq350", "assemblies/zq350/zq350.step", bolt::models::add_zq350},
        {"dn200-pn16", "assemblies/dn200-pn16/dn200-pn16.step", bolt::models::add_dn200_pn16},
        {"cover-m8", "assemblies/cover-m8/cover-m8.step", bolt::models::add_cover_m8},
        {"tools", "tools/wrench-13.step",
         [](Document& d) { return bolt::models::add_wrench(d, 13.0, 140.0); }},
        {"tools", "tools/wrench-24.step",
         [](Document& d) { return bolt::models::add_wrench(d, 24.0, 230.0); }},
        {"tools", "tools/wrench-30.step",
         [](Document& d) { return bolt::models::add_wrench(d, 30.0, 380.0); }},
        {"tools", "tools/torque-wrench-24.step",
         [](Document& d) { return bolt::models::add_torque_wrench(d, 24.0); }},
    };
    std::vector<std::string> names = {"all"};
    for (const Model& model : models) names.push_back(model.name);
    app.add_option("model", which, "Which model")->check(CLI::IsMember(names))->capture_default_str();
    app.add_option("-o,--output", content, "The content folder")->required();
    app.callback([&] {
        for (const Model& model : models) {
            if (which != "all" && which != model.name) continue;
            if (const Status done = write(model, content); !done) {
                fmt::print(stderr, "{}\n", done.error().message());
                exit_code = static_cast<int>(done.error().code);
                return;
            }
        }
    });
    return bolt::cli::run_program(app, argc, argv, exit_code);
}
