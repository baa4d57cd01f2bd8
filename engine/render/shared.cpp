// Asserts that C++ lays the shared structures out like the shader compilers.
#include "shaders/shared.h"

#include <cstddef>

namespace bolt::render::shared {

static_assert(sizeof(View) == 144 && offsetof(View, eye) == 128);
static_assert(sizeof(Light) == 64);
static_assert(offsetof(FrameData, lights) == 576 && offsetof(FrameData, diffuse) == 1088);
static_assert(offsetof(FrameData, shadow_from_world) == 1232 && offsetof(FrameData, cut_strength) == 1376);
static_assert(sizeof(FrameData) == 1408);
static_assert(sizeof(Instance) == 112 && offsetof(Instance, flags) == 96);
static_assert(sizeof(Material) == 448 && offsetof(Material, metallic) == 48 && offsetof(Material, uv) == 96);
static_assert(sizeof(DeformPart) == 40);

}  // namespace bolt::render::shared
