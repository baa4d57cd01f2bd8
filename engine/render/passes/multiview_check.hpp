// Whether a driver draws several views in one pass correctly, found by drawing.
#pragma once

#include "engine/gpu/pipeline.hpp"

namespace bolt::render {

// Draws a triangle that is clipped into both layers of a small image, and returns whether each layer has its
// view's value. Waits for the GPU. lavapipe of Mesa 22.3 draws the clipped triangle of the second view into
// the first layer (gallium/auxiliary/draw/draw_pipe_vbuf.c); Mesa 25 does not.
Result<bool> multiview_works(gpu::Device& device, const gpu::PipelineCache& cache);

}  // namespace bolt::render
