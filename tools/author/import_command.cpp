#include "tools/author/import_command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "engine/base/console.hpp"
#ifdef BOLT_WITH_STEP
#include "tools/import/guard.hpp"
#include "tools/import/import_step.hpp"
#endif

namespace bolt::author {

#ifdef BOLT_WITH_STEP

namespace {

// On a terminal one line that is written over; else a line every tenth.
class ProgressLine {
  public:
    ProgressLine() : terminal_(isatty(STDERR_FILENO) == 1) {}

    void operator()(double fraction, const std::string& what) {
        const int percent = static_cast<int>(100.0 * fraction);
        if (terminal_) {
            if (percent == last_ && what == what_) return;
            write(fmt::format("\r\033[K{:3d} % {}", percent, what.substr(0, 70)));
            if (percent == 100) write("\r\033[K");
        } else if (percent / 10 > last_ / 10 || last_ < 0) {
            write(fmt::format("{:3d} % {}\n", percent, what));
        }
        last_ = percent;
        what_ = what;
    }

    void clear() const {
        if (terminal_ && last_ >= 0) write("\r\033[K");
    }

  private:
    bool terminal_;
    int last_ = -1;
    std::string what_;

    static void write(const std::string& text) {
        (void)std::fputs(text.c_str(), stderr);
        (void)std::fflush(stderr);
    }
};

int run(const step_import::ImportOptions& options) {
    ProgressLine line;
    const step_import::Imported imported = step_import::import_step(
        options, [&](double fraction, const std::string& what) { line(fraction, what); });
    line.clear();
    if (!imported.ok()) return complain(imported.errors);
    const Status said = say(step_import::summary(imported.report));
    return said ? 0 : complain(said.error());
}

}  // namespace

void add_import_step(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<step_import::ImportOptions>();
    CLI::App* import = app.add_subcommand(
        "import-step", "Make the models of an assembly, and a draft of its file, from a STEP file");
    import->add_option("step", options->step, "STEP file (AP203, AP214, AP242)")->required();
    import->add_option("-o,--out", options->folder, "Folder for the files; a materials.json in it is used")
        ->required();
    import->add_option("--name", options->name, "Name of the files; the STEP file's if not given");
    import->add_option("--deflection", options->deflection_mm, "Largest distance of chord and surface, mm")
        ->check(CLI::Range(0.001, 50.0))
        ->capture_default_str();
    import->add_option("--angle", options->angle_deg, "Largest angle between neighbouring chords, degrees")
        ->check(CLI::Range(1.0, 60.0))
        ->capture_default_str();
    import
        ->add_option("--contact-deflection", options->contact_deflection_mm,
                     "Deflection of the contact model, mm; as --deflection if not given")
        ->check(CLI::Range(0.001, 50.0));
    import->add_flag("--lod", options->far_level, "Also write NAME.far.glb, the far level of detail");
    import->add_option("--far-triangles", options->far_triangles, "Triangles of the far level, all instances")
        ->check(CLI::Range(100, 10'000'000))
        ->capture_default_str();
    import->add_flag("!--no-joints", options->joints, "Do not look for joints, and draft no assembly.json");
    import->callback([options, &exit_code] { exit_code = run(*options);
});
}

#else

void add_import_step(CLI::App& app, int& exit_code) {
    auto ignored = std::make_shared<std::string>();
    CLI::App* import =
        app.add_subcommand("import-step", "Not in this build: it was made without OpenCASCADE");
    import->add_option("step", *ignored, "STEP file");
    import->allow_extras();
    import->callback([ignored, &exit_code] {
        Error error;
    error.code = ErrorCode::no_device;
    error.what = "this bolt-author was built without OpenCASCADE, which reads STEP files";
    error.expected = "install libocct-data-exchange-dev and build again";
    exit_code = complain(error);
});
}

#endif

}  // namespace bolt::author
