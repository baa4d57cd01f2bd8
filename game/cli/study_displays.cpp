#include "game/cli/study_displays.hpp"

namespace bolt::cli {

void StudyDisplay::close() {
    headset_.reset();
    walls_ = {};
}

Status StudyDisplay::open_headset() {
    xr::HeadsetOptions options;
    if (!quiet_)
        options.log = [](const std::string& line) { (void)std::fprintf(stderr, "%s\n", line.c_str()); };
    auto headset = std::make_unique<xr::Headset>(std::move(options));
    if (!headset->find(0.0)) return fail(*headset->absence());
    headset_ = std::move(headset);
    return {};
}

Status StudyDisplay::open_walls_of(const std::string& file) {
    BOLT_TRY_ASSIGN(auto opened, open_walls(file, desktop_, quiet_));
    if (opened.cluster)
        return fail(ErrorCode::usage, "walls of several processes cannot be opened for single lessons",
                    "a plan without \"display\", and --displays on the command line");
    walls_ = std::move(opened);
    return {};
}

Status StudyDisplay::open(const trainer::LessonDisplay& display) {
    close();
    if (display.kind == trainer::LessonDisplay::Kind::headset) return open_headset();
    if (display.kind == trainer::LessonDisplay::Kind::walls) return open_walls_of(display.file);
    return {};
}

Status run_on_displays(trainer::App& app, platform::Window& window, gpu::Instance& instance,
                       const view::WindowRunOptions& options, StudyDisplay& display) {
    BOLT_TRY(view::run_in_window(app, window, instance, options));
    while (app.wants_other_display()) {
        Status opened = display.open(app.wanted_display());
        gpu::InstanceOptions again = options.instance;
        again.log = instance.shared_log();
        // The functions of Vulkan are loaded for one instance at a time.
        { const gpu::Instance ended = std::move(instance); }
        auto made = view::make_instance(again, display.headset(), true);
        if (!made && display.headset() != nullptr) {
            opened = fail(made.error());
            display.close();
            made = view::make_instance(again, nullptr, false);
        }
        if (!made) return fail(made.error());
        instance = std::move(*made);
        app.enter_display(opened);
        view::WindowRunOptions now = options;
        now.headset = display.headset();
        now.needs_headset = now.headset != nullptr;
        now.walls = display.walls();
        BOLT_TRY(view::run_in_window(app, window, instance, now));
    }
    return {};
}

}  // namespace bolt::cli
