// The display of a study whose plan names displays: opened for the lessons that need it, and closed after
// them.
#pragma once

#include <memory>

#include "game/cli/opened_walls.hpp"
#include "game/trainer/app.hpp"

namespace bolt::cli {

class StudyDisplay {
  public:
    // `desktop` must outlive it. `quiet`: prints no findings about walls and no lines about the tracker.
    StudyDisplay(const platform::Desktop& desktop, bool quiet) : desktop_(desktop), quiet_(quiet) {}

    // Closes the display that is open, and opens this one. If that fails, only the window is open.
    Status open(const trainer::LessonDisplay& display);
    void close();
    [[nodiscard]] xr::Headset* headset() const { return headset_.get(); }  // null: none is open
    [[nodiscard]] view::Walls* walls() const { return walls_.walls.get(); }

  private:
    Status open_headset();
    Status open_walls_of(const std::string& file);

    const platform::Desktop& desktop_;
    bool quiet_;
    std::unique_ptr<xr::Headset> headset_;
    OpenedWalls walls_;
};

// Runs the app in the window, and on each other display that it wants, until it is closed. `options`: for a
// run in the window alone; headset and walls are added for the other displays.
Status run_on_displays(trainer::App& app, platform::Window& window, gpu::Instance& instance,
                       const view::WindowRunOptions& options, StudyDisplay& display);

}  // namespace bolt::cli
