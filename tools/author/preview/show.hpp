// The preview itself: draws in a window until it is closed, and follows the files.
#pragma once

#include "engine/platform/window.hpp"
#include "tools/author/preview/sources.hpp"

namespace bolt::author {

// A GPU that is lost is started again, once in a while (gpu::DeviceLossPolicy).
Status show_preview(const PreviewOptions& options, Sources& sources, platform::Window& window,
                    const gpu::Instance& instance);

// One picture without a window.
Status draw_preview(const PreviewOptions& options, const Sources& sources, const gpu::Instance& instance);

}  // namespace bolt::author
