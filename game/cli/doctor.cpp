// boltwright doctor: what this machine has, and what of it would be used.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "engine/base/console.hpp"
#include "engine/gpu/device.hpp"
#include "game/cli/commands.hpp"

namespace bolt::cli {

namespace {

Status examine() {
    Result<gpu::Instance> instance = gpu::Instance::create({});
    if (!instance) return fail(instance.error());
    const Result<gpu::Survey> found = gpu::survey(*instance, {});
    if (!found) return fail(found.error());
    std::string text = "Vulkan devices:\n";
    for (const std::string& reason : found->choice.reasons) text += fmt::format("  {}\n", reason);
    gpu::InstanceOptions validated;
    validated.validation = true;
    text +=
        fmt::format("Validation layers: {}\n",
                    gpu::Instance::create(validated) ? "installed" : "not installed (only tests need them)");
    if (Status said = say(text); !said) return said;
    if (found->choice.index < 0)
        return fail(ErrorCode::no_device, "no Vulkan device can be used",
                    "mesa-vulkan-drivers renders without a GPU");
    return {};
}

}  // namespace

void add_doctor(CLI::App& app, int& exit_code) {
    app.add_subcommand("doctor", "Say what this machine has for drawing, and what would be used")
        ->callback([&exit_code] {
            const Status done = examine();
            exit_code = done ? 0 : complain(done.error());
        });
}

}  // namespace bolt::cli
