// Writes nodes, skins, animations, cameras, lights, images and textures.
#include <cmath>

#include "engine/assets/image.hpp"
#include "engine/assets/write/writer.hpp"

namespace bolt::assets {

namespace {

Json numbers(const std::vector<float>& values) {
    Json json = Json::array();
    for (const float value : values) json.push_back(json_number(value));
    return json;
}

// Returns whether an index is valid, or -1 for none.
bool in_range(int index, std::size_t count) { return index < static_cast<int>(count); }

const char* name_of(TargetPath path) {
    switch (path) {
        case TargetPath::translation:
            return "translation";
        case TargetPath::rotation:
            return "rotation";
        case TargetPath::scale:
            return "scale";
        case TargetPath::weights:
            break;
    }
    return "weights";
}

const char* name_of(Interpolation interpolation) {
    switch (interpolation) {
        case Interpolation::step:
            return "STEP";
        case Interpolation::linear:
            return "LINEAR";
        case Interpolation::cubic:
            break;
    }
    return "CUBICSPLINE";
}

int add_floats(GlbWriter& writer, const std::vector<float>& values, TargetPath path) {
    const auto add = [&](auto element, const char* type) {
        using Element = decltype(element);
        const auto* first = reinterpret_cast<const Element*>(values.data());
        return writer.buffer.add(
            std::span<const Element>(first, values.size() * sizeof(float) / sizeof(Element)),
            BufferTarget::other, {.type = type});
    };
    if (path == TargetPath::weights) return add(float{}, "SCALAR");
    if (path == TargetPath::rotation) return add(std::array<float, 4>{}, "VEC4");
    return add(std::array<float, 3>{}, "VEC3");
}

}  // namespace

Error error_at(std::string pointer, std::string what, std::string expected) {
    Error error;
    error.code = ErrorCode::failed;
    error.pointer = std::move(pointer);
    error.what = std::move(what);
    error.expected = std::move(expected);
    return error;
}

Result<Json> write_node(GlbWriter& writer, std::size_t index) {
    const Model& model = writer.model;
    const Node& node = model.nodes[index];
    const std::string pointer = "/nodes/" + std::to_string(index);
    if (!in_range(node.mesh, model.meshes.size()) || !in_range(node.skin, model.skins.size()) ||
        !in_range(node.camera, model.cameras.size()) || !in_range(node.light, model.lights.size()))
        return fail(error_at(pointer, "node '" + node.name + "' has an index that is out of range"));
    if (std::abs(glm::length(node.rotation) - 1.0F) > 1e-3F)
        return fail(
            error_at(pointer + "/rotation", "the rotation of '" + node.name + "' does not have unit length"));
    Json json = Json::object();
    if (!node.name.empty()) json["name"] = node.name;
    for (const int child : node.children) {
        if (child < 0 || !in_range(child, model.nodes.size()))
            return fail(error_at(pointer + "/children", "there is no node " + std::to_string(child)));
        json["children"].push_back(child);
    }
    if (node.translation != glm::vec3(0.0F)) json["translation"] = array(node.translation);
    if (node.rotation != glm::quat(1.0F, 0.0F, 0.0F, 0.0F)) json["rotation"] = array(node.rotation);
    if (node.scale != glm::vec3(1.0F)) json["scale"] = array(node.scale);
    if (node.mesh >= 0) json["mesh"] = node.mesh;
    if (node.skin >= 0) json["skin"] = node.skin;
    if (node.camera >= 0) json["camera"] = node.camera;
    if (!node.weights.empty()) json["weights"] = numbers(node.weights);
    if (node.light >= 0) json["extensions"]["KHR_lights_punctual"]["light"] = node.light;
    if (!node.extras.empty()) {
        Json extras = Json::parse(node.extras, nullptr, false);
        if (extras.is_discarded())
            return fail(error_at(pointer + "/extras", "the extras of '" + node.name + "' are not JSON"));
        json["extras"] = std::move(extras);
    }
    return json;
}

Result<Json> write_skin(GlbWriter& writer, std::size_t index) {
    const Skin& skin = writer.model.skins[index];
    const std::string pointer = "/skins/" + std::to_string(index);
    if (skin.joints.empty()) return fail(error_at(pointer, "skin '" + skin.name + "' has no joints"));
    if (!skin.inverse_bind.empty() && skin.inverse_bind.size() != skin.joints.size())
        return fail(error_at(
            pointer, "skin '" + skin.name + "' does not have as many inverse bind matrices as joints"));
    Json json = Json::object();
    if (!skin.name.empty()) json["name"] = skin.name;
    if (!skin.inverse_bind.empty())
        json["inverseBindMatrices"] = writer.buffer.add(std::span<const glm::mat4>(skin.inverse_bind),
                                                        BufferTarget::other, {.type = "MAT4"});
    if (skin.skeleton >= 0) json["skeleton"] = skin.skeleton;
    for (const int joint : skin.joints)
        if (joint < 0 || !in_range(joint, writer.model.nodes.size()))
            return fail(error_at(pointer + "/joints", "there is no node " + std::to_string(joint)));
    json["joints"] = skin.joints;
    return json;
}

Result<Json> write_animation(GlbWriter& writer, std::size_t index) {
    const Animation& animation = writer.model.animations[index];
    const std::string pointer = "/animations/" + std::to_string(index);
    if (animation.channels.empty())
        return fail(error_at(pointer, "animation '" + animation.name + "' has no channels"));
    Json json = Json::object();
    if (!animation.name.empty()) json["name"] = animation.name;
    json["channels"] = Json::array();
    json["samplers"] = Json::array();
    std::vector<std::pair<const std::vector<float>*, int>> inputs;  // key times that channels share
    for (const AnimationChannel& channel : animation.channels) {
        if (channel.times.empty() || channel.values.size() % channel.times.size() != 0)
            return fail(error_at(
                pointer, "a channel of '" + animation.name +
                             "' has a number of values that is not a multiple of its number of keys"));
        if (channel.interpolation == Interpolation::cubic && channel.times.size() < 2)
            return fail(
                error_at(pointer, "a cubic channel of '" + animation.name + "' has one key", "at least two"));
        int input = -1;
        for (const auto& [times, accessor] : inputs)
            if (*times == channel.times) input = accessor;
        if (input < 0) {
            input = writer.buffer.add(std::span<const float>(channel.times), BufferTarget::other,
                                      {.bounded = true});
            inputs.emplace_back(&channel.times, input);
        }
        json["channels"].push_back(
            {{"sampler", json["samplers"].size()}, {"target", {{"path", name_of(channel.path)}}}});
        if (channel.node >= 0) json["channels"].back()["target"]["node"] = channel.node;
        json["samplers"].push_back({{"input", input},
                                    {"interpolation", name_of(channel.interpolation)},
                                    {"output", add_floats(writer, channel.values, channel.path)}});
    }
    return json;
}

Json write_camera(const Camera& camera) {
    Json json = Json::object();
    if (!camera.name.empty()) json["name"] = camera.name;
    json["type"] = camera.perspective ? "perspective" : "orthographic";
    Json lens = Json::object();
    if (camera.perspective) {
        if (camera.aspect > 0.0F) lens["aspectRatio"] = json_number(camera.aspect);
        lens["yfov"] = json_number(camera.yfov);
    } else {
        lens["xmag"] = json_number(camera.xmag);
        lens["ymag"] = json_number(camera.ymag);
    }
    if (!camera.perspective || camera.zfar > 0.0F) lens["zfar"] = json_number(camera.zfar);
    lens["znear"] = json_number(camera.znear);
    json[camera.perspective ? "perspective" : "orthographic"] = std::move(lens);
    return json;
}

Json write_light(const Light& light) {
    Json json = Json::object();
    if (!light.name.empty()) json["name"] = light.name;
    if (light.color != glm::vec3(1.0F)) json["color"] = array(light.color);
    if (light.intensity != 1.0F) json["intensity"] = json_number(light.intensity);
    json["type"] = light.type == LightType::directional ? "directional"
                   : light.type == LightType::point     ? "point"
                                                        : "spot";
    if (light.range > 0.0F && light.type != LightType::directional) json["range"] = json_number(light.range);
    if (light.type == LightType::spot)
        json["spot"] = {{"innerConeAngle", json_number(light.inner_cone)},
                        {"outerConeAngle", json_number(light.outer_cone)}};
    return json;
}

Result<Json> write_image(GlbWriter& writer, std::size_t index) {
    const Bitmap& image = writer.model.images[index];
    const std::string pointer = "/images/" + std::to_string(index);
    Json json = Json::object();
    if (!image.name.empty()) json["name"] = image.name;
    if (!image.encoded.empty()) {
        json["mimeType"] = image.mime_type;
        json["bufferView"] = writer.buffer.add_file(image.encoded);
        return json;
    }
    const auto png = encode_png(image.width, image.height, image.channels, image.pixels);
    if (!png) return fail(error_at(pointer, png.error().what));
    json["mimeType"] = "image/png";
    json["bufferView"] =
        writer.buffer.add_file(std::span(reinterpret_cast<const std::uint8_t*>(png->data()), png->size()));
    return json;
}

Json write_texture(const Texture& texture, Json& samplers) {
    constexpr int nearest = 9728;
    constexpr int linear = 9729;
    constexpr int with_mips = 256;  // 9984 is NEAREST_MIPMAP_NEAREST
    const auto wrap = [](Wrap mode) {
        return mode == Wrap::repeat ? 10497 : mode == Wrap::clamp ? 33071 : 33648;
    };
    int min = texture.min == Filter::linear ? linear : nearest;
    if (texture.mipmapped) min += with_mips + (texture.mip == Filter::linear ? 2 : 0);
    const Json sampler = {{"magFilter", texture.mag == Filter::linear ? linear : nearest},
                          {"minFilter", min},
                          {"wrapS", wrap(texture.wrap_s)},
                          {"wrapT", wrap(texture.wrap_t)}};
    std::size_t index = 0;
    while (index < samplers.size() && samplers[index] != sampler) ++index;
    if (index == samplers.size()) samplers.push_back(sampler);
    Json json = {{"sampler", index}};
    if (texture.image >= 0) json["source"] = texture.image;
    return json;
}

}  // namespace bolt::assets
