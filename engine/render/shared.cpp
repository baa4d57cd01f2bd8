// Both languages lay the shared structures out alike: what the shader compilers do by rule is asserted here.
#include "shaders/shared.h"

#include <cstddef>

namespace bolt::render::shared {

static_assert(sizeof(View) == 144 && offsetof(View, eye) == 128);
static_assert(sizeof(Light) == 64);
static_assert(offsetof(Frame, lights) == 576 && offsetof(Frame, diffuse) == 1088);
static_assert(offsetof(Frame, shadow_from_world) == 1232 && offsetof(Frame, cut_strength) == 1376);
static_assert(sizeof(Frame) == 1408);
static_assert(sizeof(Instance) == 112 && offsetof(Instance, flags) == 96);
static_assert(sizeof(Material) == 448 && offsetof(Material, metallic) == 48 && offsetof(Material, uv) == 96);
static_assert(sizeof(DeformPart) == 40);

}  // namespace bolt::render::shared
