// The set-up of golden pictures: a renderer with its light, and models that reveal typical errors.
#pragma once

#include "tests/golden/reference_pictures.hpp"
#include "tests/render/support.hpp"

namespace bolt::test {

struct GoldenStudio {
    Studio studio;
    ReferencePictures pictures = reference_pictures(studio.device());
    render::EnvironmentLight light = studio.light(shading::studio_environment(128));

    // An empty scene with this light on grey.
    render::Scene scene();
    // Renders the scene and compares the picture with its reference.
    void shoot(const std::string& name, const render::Scene& scene, const render::Eye& eye,
               VkExtent2D extent = {192, 144});
    void check(const std::string& name, const render::Picture& picture);
};

render::Eye eye_at(const glm::vec3& eye, const glm::vec3& target, float fov = 0.6F,
                   float aspect = 4.0F / 3.0F);

// A lamp that casts a shadow; it shines along `direction`.
render::SceneLight lamp(const glm::vec3& direction, float strength);

glm::mat4 at(const glm::vec3& place, const glm::vec3& scale = glm::vec3(1.0F));

assets::Material paint(const glm::vec3& color, float roughness = 0.6F);
assets::Material metal(const glm::vec3& color, float roughness);

// A sphere of radius 1 with tangents and texture coordinates, and a cube of half size 1 with the whole
// texture on each face.
assets::Model globe(const assets::Material& material);
assets::Model cube(const assets::Material& material, bool tangents = true);

// Adds a texture of size × size to the model, with a colour for every texel (0 … 1); returns its index.
template <class Color>
int add_texture(assets::Model& model, int size, const Color& color) {
    assets::Bitmap image;
    image.width = image.height = size;
    image.channels = 4;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const glm::vec4 texel = color(x, y);
            for (int c = 0; c < 4; ++c)
                image.pixels.push_back(static_cast<std::uint8_t>(255.0F * texel[c] + 0.5F));
        }
    assets::Texture texture;
    texture.image = static_cast<int>(model.images.size());
    model.images.push_back(std::move(image));
    model.textures.push_back(texture);
    return static_cast<int>(model.textures.size()) - 1;
}

}  // namespace bolt::test
