// A renderer for a test, with validation, and access to the pixels of its pictures.
#pragma once

#include "engine/render/camera.hpp"
#include "engine/render/renderer.hpp"
#include "tests/gpu/support.hpp"

namespace bolt::test {

class Studio {
  public:
    explicit Studio(const render::RendererOptions& options = {});

    render::GpuModel upload(const assets::Model& model, const render::UploadOptions& options = {}) {
        return gpu_.need(render::upload_model(gpu_.device(), model, options));
    }
    render::EnvironmentLight light(const shading::RadianceImage& image) {
        return gpu_.need(render::upload_environment(gpu_.device(), image));
    }
    std::vector<render::Picture> shoot(const render::Scene& scene, std::span<const render::Eye> eyes,
                                       VkExtent2D extent) {
        return gpu_.need(render::take_pictures(gpu_.device(), *frames_, *renderer_, scene, eyes, extent));
    }
    render::Picture shoot(const render::Scene& scene, const render::Eye& eye, VkExtent2D extent) {
        return std::move(shoot(scene, std::span(&eye, 1), extent).front());
    }
    render::Renderer& renderer() { return *renderer_; }
    gpu::Device& device() { return gpu_.device(); }
    gpu::Frames& frames() { return *frames_; }
    Gpu& gpu() { return gpu_; }
    // Waits for the submitted frames and returns a picture of the last one.
    render::Picture download(const render::ImageLayer& picture);

  private:
    Gpu gpu_;
    std::unique_ptr<gpu::Frames> frames_;
    std::unique_ptr<render::Renderer> renderer_;
};

// A sphere of radius 1 about the origin, or a square of half size 1 in the plane y = 0, facing up.
assets::Model sphere(const assets::Material& material, int rings = 64);
assets::Model plate(const assets::Material& material);

// Inverts sRGB and tone mapping for grey colours in the range where Khronos PBR Neutral only subtracts (0.08
// … 0.76); returns radiance.
double grey_radiance(std::uint8_t encoded);

inline glm::ivec4 pixel(const render::Picture& picture, std::uint32_t x, std::uint32_t y) {
    const std::uint8_t* p = picture.rgba.data() + 4 * (std::size_t{y} * picture.width + x);
    return {p[0], p[1], p[2], p[3]};
}

// Returns the largest difference of any channel.
int largest_difference(const render::Picture& a, const render::Picture& b);

}  // namespace bolt::test
