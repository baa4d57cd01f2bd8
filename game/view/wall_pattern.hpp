// The installer's test pattern on projection walls, as the content of a window with view::Walls. The window
// itself shows where the head is; Escape ends.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "content/displays/display_file.hpp"
#include "engine/ui/ui.hpp"
#include "game/view/window.hpp"

namespace bolt::view {

class WallPattern : public WindowContent {
  public:
    // `displays` must be those of the walls.
    explicit WallPattern(const content::DisplayFile& displays) : displays_(displays) {}

    Status start(GpuContext& gpu_context) override;
    void release() override;
    Status update(const WindowFrame& window) override;
    Status share(cluster::MessageWriter& message, cluster::MessageWriter& bulk) override;
    Status follow(cluster::MessageReader& message, cluster::MessageReader& bulk) override;
    Status draw(gpu::FrameContext& frame, const WindowFrame& window) override;
    [[nodiscard]] bool closed() const override { return closed_; }

  private:
    // A user interface for each wall, because they differ in the size of text; the last one is the window's.
    struct GpuResources {
        GpuContext* context = nullptr;
        std::vector<std::unique_ptr<ui::Ui>> uis;
    };
    Status draw_wall(gpu::FrameContext& frame, std::size_t wall, const EyeGroup& group);
    Status draw_window(gpu::FrameContext& frame, const WindowFrame& window);

    const content::DisplayFile& displays_;
    std::unique_ptr<GpuResources> gpu_;
    std::uint64_t frame_number_ = 0;
    bool follows_ = false;  // frame_number_ comes from another process
    bool closed_ = false;
};

}  // namespace bolt::view
