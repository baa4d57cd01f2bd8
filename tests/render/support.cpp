#include "tests/render/support.hpp"

#include <cmath>
#include <cstring>
#include <numbers>

#include "engine/gpu/resources.hpp"

namespace bolt::test {

Studio::Studio(const render::RendererOptions& options)
    : frames_(gpu_.need(gpu::Frames::create(gpu_.device()))),
      renderer_(gpu_.need(render::Renderer::create(gpu_.device(), options))) {}

render::Picture Studio::download(const render::ImageLayer& picture) {
    gpu_.need(frames_->finish());
    const VkExtent2D extent = picture.image->info().extent;
    const std::vector<std::byte> texels = gpu_.need(gpu::download_image(
        gpu_.device(), *picture.image, gpu::ResourceUse::transfer_from, 4, 0, picture.layer));
    render::Picture made{extent.width, extent.height, std::vector<std::uint8_t>(texels.size())};
    std::memcpy(made.rgba.data(), texels.data(), texels.size());
    return made;
}

namespace {

assets::Model single(assets::Primitive primitive, const assets::Material& material) {
    primitive.material = 0;
    assets::Model model;
    model.materials.push_back(material);
    model.meshes.push_back({"thing", {std::move(primitive)}, {}});
    assets::Node node;
    node.name = "thing";
    node.mesh = 0;
    model.nodes.push_back(node);
    model.roots = {0};
    return model;
}

}  // namespace

assets::Model sphere(const assets::Material& material, int rings) {
    assets::Primitive p;
    const int around = 2 * rings;
    for (int i = 0; i <= rings; ++i) {
        for (int j = 0; j <= around; ++j) {
            const double theta = std::numbers::pi * i / rings, phi = 2.0 * std::numbers::pi * j / around;
            const glm::vec3 n(static_cast<float>(std::sin(theta) * std::sin(phi)),
                              static_cast<float>(std::cos(theta)),
                              static_cast<float>(std::sin(theta) * std::cos(phi)));
            p.positions.push_back(n);
            p.normals.push_back(n);
        }
    }
    for (int i = 0; i < rings; ++i) {
        for (int j = 0; j < around; ++j) {
            const auto a = static_cast<std::uint32_t>(i * (around + 1) + j);
            const auto b = a + static_cast<std::uint32_t>(around) + 1;
            for (const std::uint32_t index : {a, b, a + 1, a + 1, b, b + 1}) p.indices.push_back(index);
        }
    }
    return single(std::move(p), material);
}

assets::Model plate(const assets::Material& material) {
    assets::Primitive p;
    p.positions = {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}};
    p.normals.assign(4, glm::vec3(0, 1, 0));
    p.indices = {0, 1, 2, 0, 2, 3};
    return single(std::move(p), material);
}

double grey_radiance(std::uint8_t encoded) {
    const double x = encoded / 255.0;
    return (x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4)) + 0.04;
}

int largest_difference(const render::Picture& a, const render::Picture& b) {
    if (a.rgba.size() != b.rgba.size()) return 256;
    int largest = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i)
        largest = std::max(largest, std::abs(int{a.rgba[i]} - int{b.rgba[i]}));
    return largest;
}

}  // namespace bolt::test
