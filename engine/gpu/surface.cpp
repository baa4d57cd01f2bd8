#include "engine/gpu/surface.hpp"

namespace bolt::gpu {

Surface::~Surface() {
    if (surface_ != VK_NULL_HANDLE) vkDestroySurfaceKHR(instance_, surface_, nullptr);
}

}  // namespace bolt::gpu
