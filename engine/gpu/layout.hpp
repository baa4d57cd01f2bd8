// Descriptor set and pipeline layouts of shaders that work together.
#pragma once

#include "engine/gpu/pipeline.hpp"

namespace bolt::gpu {

// Fills in layout, sets, bindings and push constants. Stages that mean different things by one binding are an
// error.
Status merge_layouts(const Device& device, std::span<const Shader* const> shaders, Pipeline& pipeline);

}  // namespace bolt::gpu
