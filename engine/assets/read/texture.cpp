#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "engine/assets/read/sections.hpp"

namespace bolt::assets {

namespace {

Status set_wrap(const Document& document, std::size_t sampler, const char* key, int value, Wrap& wrap) {
    switch (value) {
        case TINYGLTF_TEXTURE_WRAP_REPEAT:
            wrap = Wrap::repeat;
            return {};
        case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
            wrap = Wrap::clamp;
            return {};
        case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
            wrap = Wrap::mirror;
            return {};
        default:
            break;
    }
    return error_at(document, fmt::format("/samplers/{}/{}", sampler, key),
                    fmt::format("{} is no wrapping mode", value), "10497, 33071 or 33648");
}

Status set_filters(const Document& document, std::size_t sampler, int mag, int min, Texture& texture) {
    const std::string pointer = fmt::format("/samplers/{}", sampler);
    if (mag != -1 && mag != TINYGLTF_TEXTURE_FILTER_NEAREST && mag != TINYGLTF_TEXTURE_FILTER_LINEAR)
        return error_at(document, pointer + "/magFilter", fmt::format("{} is no filter", mag),
                        "9728 or 9729");
    texture.mag = mag == TINYGLTF_TEXTURE_FILTER_NEAREST ? Filter::nearest : Filter::linear;
    switch (min) {
        case TINYGLTF_TEXTURE_FILTER_NEAREST:
        case TINYGLTF_TEXTURE_FILTER_LINEAR:
            texture.mipmapped = false;
            break;
        case -1:
        case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST:
        case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST:
        case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR:
        case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR:
            break;
        default:
            return error_at(document, pointer + "/minFilter", fmt::format("{} is no filter", min),
                            "9728, 9729 or 9984 to 9987");
    }
    if (min == TINYGLTF_TEXTURE_FILTER_NEAREST || min == TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST ||
        min == TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR)
        texture.min = Filter::nearest;
    if (min == TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST ||
        min == TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST)
        texture.mip = Filter::nearest;
    return {};
}

// Detects the type from the first bytes, because a file's declared type may be wrong.
const char* media_type(const std::vector<std::uint8_t>& bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.starts_with("\x89PNG\r\n\x1A\n")) return "image/png";
    if (text.starts_with("\xFF\xD8\xFF")) return "image/jpeg";
    return nullptr;
}

}  // namespace

Status read_textures(Document& document, Model& model) {
    for (std::size_t i = 0; i < document.images.size(); ++i) {
        Image image;
        image.name = document.json["images"][i].value("name", "");
        const char* type = media_type(document.images[i]);
        // Optional extensions add images of other types, which no core texture refers to.
        const bool used = std::any_of(document.gltf.textures.begin(), document.gltf.textures.end(),
                                      [i](const auto& t) { return t.source == static_cast<int>(i); });
        if (type == nullptr && used)
            return error_at(document, fmt::format("/images/{}", i), "is neither a PNG nor a JPEG file");
        image.mime_type = type != nullptr ? type : "application/octet-stream";
        image.encoded = std::move(document.images[i]);
        model.images.push_back(std::move(image));
    }
    for (const tinygltf::Texture& from : document.gltf.textures) {
        Texture texture;
        texture.image = from.source;
        if (from.sampler >= 0) {
            const auto index = static_cast<std::size_t>(from.sampler);
            const tinygltf::Sampler& sampler = document.gltf.samplers[index];
            Status set = set_filters(document, index, sampler.magFilter, sampler.minFilter, texture);
            if (set) set = set_wrap(document, index, "wrapS", sampler.wrapS, texture.wrap_s);
            if (set) set = set_wrap(document, index, "wrapT", sampler.wrapT, texture.wrap_t);
            if (!set) return set;
        }
        model.textures.push_back(texture);
    }
    return {};
}

}  // namespace bolt::assets
