#include "tools/author/gltf_validator.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "content/format/load.hpp"

extern char** environ;

namespace bolt::author {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

tl::unexpected<Error> broken(std::string what) {
    return fail(ErrorCode::failed, "the Khronos glTF validator: " + std::move(what),
                "expected it as tools/install-node-tools.sh installs it, and node on the path");
}

// Everything a program writes to its standard output.
Result<std::string> output_of(const std::vector<std::string>& command) {
    std::vector<char*> arguments;
    for (const std::string& word : command)
        arguments.push_back(const_cast<char*>(word.c_str()));  // NOLINT: posix_spawn changes none of them
    arguments.push_back(nullptr);
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) return broken("no pipe");
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    ::posix_spawn_file_actions_addclose(&actions, ends[0]);
    ::posix_spawn_file_actions_addclose(&actions, ends[1]);
    pid_t child = 0;
    const int problem = ::posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    std::string text;
    std::array<char, 4096> buffer{};
    for (ssize_t got = 1; problem == 0 && got != 0;) {
        got = ::read(ends[0], buffer.data(), buffer.size());
        if (got < 0 && errno != EINTR) break;
        if (got > 0) text.append(buffer.data(), static_cast<std::size_t>(got));
    }
    ::close(ends[0]);
    if (problem != 0) return broken(fmt::format("{} cannot be started", command[0]));
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return broken("it failed");
    return text;
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
    const auto text = output_of(command);
    if (!text) return tl::unexpected<Error>(text.error());
    const json reports = json::parse(*text, nullptr, false);
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
