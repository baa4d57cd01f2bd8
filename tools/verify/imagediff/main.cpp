// bolt-imagediff: measures how much an image differs from its reference.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "engine/base/result.hpp"
#include "engine/program/program.hpp"
#include "tools/verify/imagediff/flip.hpp"

namespace {

using namespace bolt;

struct ImageDiffOptions {
    std::string reference, test, flips;
    double max_flip = 1.0;
    int max_channel = 255;
};

Status run(const ImageDiffOptions& options) {
    BOLT_TRY_ASSIGN(const auto reference, imagediff::read_png(options.reference));
    BOLT_TRY_ASSIGN(const auto test, imagediff::read_png(options.test));
    BOLT_TRY_ASSIGN(const auto difference, imagediff::compare(reference, test));
    if (!options.flips.empty()) BOLT_TRY(imagediff::write_flips(options.flips, reference, difference.flips));
    const std::string text = fmt::format(
        "mean FLIP {:.4f}, largest difference of a channel {} of 255, {:.2f} % of the pixels differ\n",
        difference.mean_flip, difference.largest, 100.0 * difference.changed);
    BOLT_TRY(print(text));
    if (difference.mean_flip > options.max_flip || difference.largest > options.max_channel)
        return fail(
            ErrorCode::failed,
            fmt::format("{}: differs from {} by more than the limits", options.test, options.reference),
            fmt::format("a mean FLIP of at most {} and a channel difference of at most {}", options.max_flip,
                        options.max_channel));
    return {};
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Compares an image with its reference.", "bolt-imagediff");
    ImageDiffOptions options;
    int exit_code = 0;
    app.add_option("reference", options.reference, "PNG")->required();
    app.add_option("test", options.test, "PNG of the same size")->required();
    app.add_option("--max-flip", options.max_flip, "Fail above this mean FLIP (0 … 1)");
    app.add_option("--max-channel", options.max_channel,
                   "Fail above this difference in any channel (0 … 255)");
    app.add_option("--flips", options.flips, "Write the FLIP value of every pixel to this PNG");
    app.callback([&] {
        const Status done = run(options);
        exit_code = done ? 0 : print_error(done.error());
    });
    return run_command_line(app, argc, argv, exit_code);
}
