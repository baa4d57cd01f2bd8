#include "tools/author/gltf_validator.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "content/format/assembly.hpp"
#include "engine/base/process.hpp"

namespace bolt::author {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

tl::unexpected<Error> broken(std::string what) {
    return fail(ErrorCode::failed, "the Khronos glTF validator: " + std::move(what),
                "expected it as tools/install-node-tools.sh installs it, and node on the path");
}

}  // namespace

fs::path gltf_validator() {
    const char* given =
        std::getenv("BOLTWRIGHT_GLTF_VALIDATOR");  // NOLINT(concurrency-mt-unsafe): nothing sets it
    const fs::path folder = given != nullptr && *given != '\0'
                                ? fs::path(given)
                                : content::content_folder().parent_path() / "tools" / "gltf-validator";
    std::error_code ignored;
    const bool there = fs::is_regular_file(folder / "validate.mjs", ignored) &&
                       fs::is_directory(folder / "node_modules" / "gltf-validator", ignored);
    return there ? folder / "validate.mjs" : fs::path{};
}

Result<std::vector<Error>> run_gltf_validator(const fs::path& script, const std::vector<std::string>& files) {
    std::vector<std::string> command{"node", script.string()};
    for (const std::string& file : files) command.push_back(fs::absolute(file).string());
    const Result<ProgramResult> run = run_program(command, Capture::output);
    if (!run) return broken(run.error().what);
    if (run->exit_code != 0) return broken("it failed");
    const json reports = json::parse(run->output, nullptr, false);
    if (!reports.is_array() || reports.size() != files.size()) return broken("it said nothing that we know");
    std::vector<Error> errors;
    for (std::size_t i = 0; i < files.size(); ++i)
        for (const json& message : reports[i].value("messages", json::array())) {
            Error error;
            error.code = ErrorCode::bad_content;
            error.file = files[i];
            error.pointer = message.value("pointer", "");
            error.what = fmt::format("{} ({}, {} of the Khronos glTF validator)",
                                     message.value("message", ""), message.value("code", ""),
                                     message.value("severity", 0) == 0 ? "an error" : "a warning");
            errors.push_back(std::move(error));
        }
    return errors;
}

}  // namespace bolt::author
