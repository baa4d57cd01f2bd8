// The panel at the left of the preview: variants, the switch for all sectors, the progress of the check, and
// the list of problems.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "engine/platform/input.hpp"
#include "engine/ui/ui.hpp"
#include "tools/author/preview/background_check.hpp"
#include "tools/author/preview/check_overlay.hpp"

namespace bolt::author {

// The state that the panel shows.
struct PreviewPanelState {
    const CheckOverlay& overlay;
    const BackgroundCheck& check;
    std::span<const std::string> variants;  // of the file; an empty name: without a variant
    std::string variant;                    // the shown one
    std::string selected;                   // id of a joint; empty: none
    bool all_sectors = false;
};

// The author's clicks in one frame.
struct PreviewPanelCommands {
    std::optional<std::size_t> problem;  // index into CheckOverlay::problems()
    std::optional<std::size_t> variant;
    bool toggle_sectors = false;
};

class PreviewPanel {
  public:
    Status start(gpu::Device& device);
    void release();

    // Takes the events that are for the panel out of `events`. Returns true if the panel has to be drawn
    // again. `size`: of the window, px; `scale`: px per point.
    bool take_events(std::vector<platform::InputEvent>& events, const glm::vec2& size, float scale);

    // Draws over the picture, unless the window is too small or the panel is hidden.
    Status draw(gpu::FrameContext& frame, render::Renderer& renderer, const PreviewPanelState& state);

    // Returns the clicks since the last call.
    PreviewPanelCommands take_commands() { return std::exchange(commands_, {}); }

    void toggle() { hidden_ = !hidden_; }
    // Draws the panel again, because its state has changed.
    void refresh() { frames_ = frames_after_event; }

  private:
    // The first frame shows a press or a new text, the next ones its effect or the panel's new size.
    static constexpr int frames_after_event = 3;
    [[nodiscard]] bool is_shown() const;
    [[nodiscard]] bool contains(const glm::dvec2& at) const;
    void draw_contents(const PreviewPanelState& state);
    void draw_problems(const PreviewPanelState& state);

    std::unique_ptr<ui::Ui> ui_;
    ui::UiInput input_;
    render::Rectangle place_;  // px, in the last frame
    PreviewPanelCommands commands_;
    int frames_ = 0;  // to draw until the panel has reacted to the last event
    bool hidden_ = false;
};

}  // namespace bolt::author
