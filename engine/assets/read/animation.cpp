#include <fmt/format.h>

#include <glm/gtc/type_ptr.hpp>

#include "engine/assets/read/accessor.hpp"
#include "engine/assets/read/sections.hpp"

namespace bolt::assets {

namespace {

Status set_path(const Document& document, const std::string& name, const std::string& pointer, Path& path) {
    constexpr std::pair<const char*, Path> names[] = {{"translation", Path::translation},
                                                      {"rotation", Path::rotation},
                                                      {"scale", Path::scale},
                                                      {"weights", Path::weights}};
    for (const auto& [known, value] : names) {
        if (name == known) {
            path = value;
            return {};
        }
    }
    return error_at(document, pointer, "is '" + name + "'", "translation, rotation, scale or weights");
}

Status set_interpolation(const Document& document, const std::string& name, const std::string& pointer,
                         Interpolation& interpolation) {
    if (name == "STEP") {
        interpolation = Interpolation::step;
    } else if (name == "CUBICSPLINE") {
        interpolation = Interpolation::cubic;
    } else if (name != "LINEAR") {
        return error_at(document, pointer, "is '" + name + "'", "STEP, LINEAR or CUBICSPLINE");
    }
    return {};
}

// Returns the number of floats per key for the animated property; 0: the node does not have it.
std::size_t width(const Model& model, const Channel& channel) {
    if (channel.path == Path::rotation) return 4;
    if (channel.path != Path::weights) return 3;
    const int mesh = model.nodes[static_cast<std::size_t>(channel.node)].mesh;
    return mesh < 0 ? 0 : model.meshes[static_cast<std::size_t>(mesh)].primitives[0].targets.size();
}

Status read_keys(Document& document, const Model& model, const nlohmann::json& sampler,
                 const std::string& pointer, Channel& channel) {
    BOLT_TRY(set_interpolation(document, sampler.value("interpolation", "LINEAR"), pointer + "/interpolation",
                               channel.interpolation));
    BOLT_TRY_ASSIGN(auto times, unpack_floats(document, sampler["input"], TINYGLTF_TYPE_SCALAR,
                                              NumberFormats::real, pointer + "/input"));
    for (std::size_t i = 0; i < times.size(); ++i)
        if (times[i] < 0.0F || (i > 0 && times[i] <= times[i - 1]))
            return error_at(document, pointer + "/input", fmt::format("key {} is at {} s", i, times[i]),
                            "times that rise from 0");
    const int type = channel.path == Path::rotation  ? TINYGLTF_TYPE_VEC4
                     : channel.path == Path::weights ? TINYGLTF_TYPE_SCALAR
                                                     : TINYGLTF_TYPE_VEC3;
    const bool whole = channel.path == Path::rotation || channel.path == Path::weights;
    BOLT_TRY_ASSIGN(auto values,
                    unpack_floats(document, sampler["output"], type,
                                  whole ? NumberFormats::unit : NumberFormats::real, pointer + "/output"));
    if (channel.interpolation == Interpolation::cubic && times.size() < 2)
        return error_at(document, pointer + "/input", "has one key", "two for a cubic spline");
    const std::size_t tangents = channel.interpolation == Interpolation::cubic ? 3 : 1;
    const std::size_t expected = times.size() * width(model, channel) * tangents;
    if (values.size() != expected || expected == 0)
        return error_at(document, pointer + "/output",
                        fmt::format("has {} numbers for {} keys", values.size(), times.size()),
                        fmt::format("{} numbers", expected));
    channel.times = std::move(times);
    channel.values = std::move(values);
    return {};
}

}  // namespace

Status read_skins(Document& document, Model& model) {
    for (std::size_t i = 0; i < document.gltf.skins.size(); ++i) {
        const tinygltf::Skin& from = document.gltf.skins[i];
        Skin skin;
        skin.name = from.name;
        skin.joints = from.joints;
        skin.skeleton = from.skeleton;
        if (skin.joints.empty()) return error_at(document, fmt::format("/skins/{}/joints", i), "is empty");
        if (from.inverseBindMatrices >= 0) {
            const std::string pointer = fmt::format("/skins/{}/inverseBindMatrices", i);
            BOLT_TRY_ASSIGN(const auto values,
                            unpack_floats(document, from.inverseBindMatrices, TINYGLTF_TYPE_MAT4,
                                          NumberFormats::real, pointer));
            if (values.size() < skin.joints.size() * 16)
                return error_at(
                    document, pointer,
                    fmt::format("has {} matrices for {} joints", values.size() / 16, skin.joints.size()));
            skin.inverse_bind.resize(skin.joints.size());
            for (std::size_t k = 0; k < skin.inverse_bind.size(); ++k)
                skin.inverse_bind[k] = glm::make_mat4(values.data() + 16 * k);
        }
        model.skins.push_back(std::move(skin));
    }
    return {};
}

Status read_animations(Document& document, Model& model) {
    const auto animations = document.json.find("animations");
    if (animations == document.json.end()) return {};
    for (std::size_t i = 0; i < animations->size(); ++i) {
        const nlohmann::json& from = (*animations)[i];
        const nlohmann::json& samplers = from["samplers"];
        Animation animation;
        animation.name = from.value("name", "");
        for (std::size_t k = 0; k < from["channels"].size(); ++k) {
            const nlohmann::json& source = from["channels"][k];
            const std::string pointer = fmt::format("/animations/{}/channels/{}", i, k);
            const std::size_t sampler = source["sampler"];
            if (sampler >= samplers.size())
                return error_at(document, pointer + "/sampler",
                                fmt::format("there is no sampler {}", sampler),
                                fmt::format("an index below {}", samplers.size()));
            // A channel without a node belongs to an extension and is ignored.
            if (!source["target"].contains("node")) continue;
            Channel channel;
            channel.node = source["target"]["node"];
            Status read =
                set_path(document, source["target"]["path"], pointer + "/target/path", channel.path);
            if (read)
                read = read_keys(document, model, samplers[sampler],
                                 fmt::format("/animations/{}/samplers/{}", i, sampler), channel);
            if (!read) return read;
            animation.channels.push_back(std::move(channel));
        }
        if (!animation.channels.empty()) model.animations.push_back(std::move(animation));
    }
    return {};
}

}  // namespace bolt::assets
