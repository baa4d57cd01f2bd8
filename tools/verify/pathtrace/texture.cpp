#include "tools/verify/pathtrace/texture.hpp"

#include <cmath>

#include "engine/assets/image.hpp"
#include "tools/verify/pathtrace/tone.hpp"

namespace bolt::pathtrace {

namespace {

// The nearest texel within the image.
int wrapped(int index, int size, assets::Wrap wrap) {
    if (wrap == assets::Wrap::clamp) return std::clamp(index, 0, size - 1);
    if (wrap == assets::Wrap::repeat) return ((index % size) + size) % size;
    const int period = ((index % (2 * size)) + 2 * size) % (2 * size);
    return period < size ? period : 2 * size - 1 - period;
}

glm::vec4 texel(const assets::Image& image, int x, int y, bool srgb) {
    const auto channels = static_cast<std::size_t>(image.channels);
    const auto row = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width);
    const std::uint8_t* bytes = image.pixels.data() + (row + static_cast<std::size_t>(x)) * channels;
    const auto color = [&](std::size_t c) {
        return srgb ? from_srgb(bytes[c]) : static_cast<float>(bytes[c]) / 255.0F;
    };
    const float alpha = channels % 2 == 0 ? static_cast<float>(bytes[channels - 1]) / 255.0F : 1.0F;
    if (channels < 3) return {glm::vec3(color(0)), alpha};
    return {color(0), color(1), color(2), alpha};
}

}  // namespace

Result<Textures> Textures::load(const assets::Model& model) {
    Textures textures;
    textures.images_ = model.images;
    textures.textures_ = model.textures;
    for (assets::Image& image : textures.images_) BOLT_TRY(assets::decode(image));
    return textures;
}

glm::vec4 Textures::sample(const assets::TextureRef& ref, const std::array<glm::vec2, 2>& texcoords,
                           bool srgb) const {
    if (ref.texture < 0) return glm::vec4(1.0F);
    const assets::Texture& texture = textures_[static_cast<std::size_t>(ref.texture)];
    if (texture.image < 0) return glm::vec4(1.0F);
    const assets::Image& image = images_[static_cast<std::size_t>(texture.image)];
    const glm::vec2 scaled = texcoords[static_cast<std::size_t>(ref.texcoord & 1)] * ref.scale;
    const float c = std::cos(ref.rotation);
    const float s = std::sin(ref.rotation);
    const glm::vec2 uv = glm::vec2(c * scaled.x + s * scaled.y, -s * scaled.x + c * scaled.y) + ref.offset;
    // Far from the origin a float cannot tell texels apart, and an int may not hold their number.
    const glm::vec2 place = glm::clamp(uv, -1e4F, 1e4F) * glm::vec2(image.width, image.height);
    const auto at = [&](int x, int y) {
        return texel(image, wrapped(x, image.width, texture.wrap_s), wrapped(y, image.height, texture.wrap_t),
                     srgb);
    };
    if (texture.mag == assets::Filter::nearest)
        return at(static_cast<int>(std::floor(place.x)), static_cast<int>(std::floor(place.y)));
    const glm::vec2 corner = glm::floor(place - 0.5F);
    const glm::vec2 f = place - 0.5F - corner;
    const int x = static_cast<int>(corner.x);
    const int y = static_cast<int>(corner.y);
    return glm::mix(glm::mix(at(x, y), at(x + 1, y), f.x), glm::mix(at(x, y + 1), at(x + 1, y + 1), f.x),
                    f.y);
}

}  // namespace bolt::pathtrace
