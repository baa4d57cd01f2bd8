// bolt-arm-validation: measures on emulated arms how stiff contact and the nut may be, what the announced
// limits feel like, and whether the guiding force helps a hand that does not see. It runs for minutes;
// tests/feel runs a part of it.
#include <algorithm>
#include <filesystem>
#include <thread>

#include <CLI/CLI.hpp>

#include "engine/base/file.hpp"
#include "engine/base/result.hpp"
#include "engine/program/program.hpp"
#include "tools/verify/arms/tables.hpp"

namespace {

using namespace bolt;
using namespace bolt::arm_validation;

struct ArmValidationOptions {
    ValidationOptions validation;
    std::vector<std::string> keys;
    bool quick = false;
    std::string update;
};

Result<std::vector<const ArmFacts*>> selected(const std::vector<std::string>& keys) {
    std::vector<const ArmFacts*> arms;
    for (const std::string& key : keys) {
        const ArmFacts* arm = find_arm(key);
        std::string known;
        for (const ArmFacts& a : arm_table()) known += (known.empty() ? "" : ", ") + std::string(a.key);
        if (arm == nullptr) return fail(ErrorCode::usage, "--arm: " + key + " is unknown", known);
        arms.push_back(arm);
    }
    if (arms.empty())
        for (const ArmFacts& a : arm_table()) arms.push_back(&a);
    return arms;
}

Status run(ArmValidationOptions& options) {
    BOLT_TRY_ASSIGN(auto arms, selected(options.keys));
    options.validation.arms = std::move(arms);
    if (options.quick) options.validation.approaches = 0;
    BOLT_TRY_ASSIGN(const auto result, validate(options.validation));
    const std::string tables = to_markdown(result);
    if (options.update.empty()) return print(tables);
    BOLT_TRY_ASSIGN(const auto text, read_file(options.update, 1U << 20U, ErrorCode::usage));
    BOLT_TRY_ASSIGN(const auto replaced, replace_tables(text, tables));
    return write_file(options.update, replaced);
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Measures the feel of emulated arms and prints it as Markdown tables.",
                 "bolt-arm-validation");
    ArmValidationOptions options;
    options.validation.threads = std::max(1U, std::thread::hardware_concurrency());
    int exit_code = 0;
    app.add_option("assembly", options.validation.assembly, "Folder, file or name of an assembly");
    app.add_option("--arm", options.keys, "Only these arms");
    app.add_flag("--quick", options.quick, "Without the approaches");
    app.add_option("--approaches", options.validation.approaches, "Approaches of each arm and variant")
        ->capture_default_str();
    app.add_option("--markdown", options.update, "Writes the tables between their marks in this file");
    app.add_option("--threads", options.validation.threads, "Threads; the results do not depend on them")
        ->capture_default_str();
    app.callback([&] {
        const Status done = run(options);
        exit_code = done ? 0 : print_error(done.error());
    });
    return run_command_line(app, argc, argv, exit_code);
}
