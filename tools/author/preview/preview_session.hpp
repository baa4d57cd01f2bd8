// The preview in a window.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "engine/platform/window.hpp"
#include "tools/author/preview/controls.hpp"
#include "tools/author/preview/gpu_state.hpp"
#include "tools/author/preview/joint_selection.hpp"
#include "tools/author/preview/preview_panel.hpp"

namespace bolt::author {

// Draws, polls the files and restarts after a lost GPU.
class PreviewSession {
  public:
    PreviewSession(const PreviewOptions& options, PreviewSources& sources, platform::Window& window,
                   const gpu::Instance& instance)
        : options_(options), sources_(sources), window_(window), instance_(instance) {}

    Status run();

  private:
    Status start();
    Status run_until_closed();
    Status follow_files(bool all);
    Status reload_model(view::DetailLevel level, const std::string& variant);
    void start_check();
    Status poll_check();
    Status prepare_overlay();
    Status choose_variant(std::size_t index);
    Status choose_problem(std::size_t index);
    Status follow_click(const glm::dvec2& at);
    Status reload_light();
    Status reload_shaders(render::ShaderCode code);
    Status execute(const PreviewCommands& commands);
    Status select_joint(const SelectableJoint* joint);
    Status follow_selection();
    void outline_selection(bool on);
    Result<bool> draw();
    [[nodiscard]] VkExtent2D window_size() const;
    enum Source : std::uint8_t { model_source, light_source, shader_source };
    void report_errors(Source source, std::vector<Error> errors);
    void update_title();
    void print_messages();

    const PreviewOptions& options_;
    PreviewSources& sources_;
    platform::Window& window_;
    const gpu::Instance& instance_;
    std::optional<render::HotShaders> hot_shaders_;
    render::ShaderCode shaders_;
    std::optional<GpuState> gpu_;
    view::CameraGlide camera_;
    PreviewControls controls_;
    SelectableJoints joints_;
    std::optional<SelectableJoint> selected_;
    BackgroundCheck check_;
    CheckOverlay overlay_;
    PreviewPanel panel_;
    std::pair<std::size_t, std::size_t> shown_progress_{0, 0};  // of the check
    std::size_t next_problem_ = 0;                              // index in CheckOverlay::problems()
    bool all_sectors_ = false;
    bool camera_placed_ = false;  // false until the first picture
    bool needs_redraw_ = true;    // the picture in the window is out of date
    bool closed_ = false;
    double files_polled_at_ = 0.0;
    std::array<std::vector<Error>, 3> errors_;  // by Source
    std::size_t messages_printed_ = 0;
};

}  // namespace bolt::author
