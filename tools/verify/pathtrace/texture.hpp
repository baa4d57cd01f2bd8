// Samples images as glTF defines: bilinear or nearest, wrapped, transformed (KHR_texture_transform).
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "engine/assets/model.hpp"
#include "engine/base/result.hpp"

namespace bolt::pathtrace {

// Decodes the images of the model. One that cannot be decoded is an error.
class Textures {
  public:
    static Result<Textures> load(const assets::Model& model);

    // Linear values; `srgb` for textures of colours. Without a texture: ones.
    [[nodiscard]] glm::vec4 sample(const assets::TextureRef& ref, const std::array<glm::vec2, 2>& texcoords,
                                   bool srgb) const;

  private:
    std::vector<assets::Image> images_;
    std::vector<assets::Texture> textures_;
};

}  // namespace bolt::pathtrace
