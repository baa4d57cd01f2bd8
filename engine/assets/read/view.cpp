// Cameras and lights.
#include <fmt/format.h>

#include "engine/assets/read/sections.hpp"

namespace bolt::assets {

Status read_cameras(const Document& document, Model& model) {
    for (std::size_t i = 0; i < document.gltf.cameras.size(); ++i) {
        const tinygltf::Camera& from = document.gltf.cameras[i];
        Camera camera;
        camera.name = from.name;
        camera.perspective = from.type == "perspective";
        if (camera.perspective) {
            camera.yfov = static_cast<float>(from.perspective.yfov);
            camera.aspect = static_cast<float>(from.perspective.aspectRatio);
            camera.znear = static_cast<float>(from.perspective.znear);
            camera.zfar = static_cast<float>(from.perspective.zfar);
        } else {
            camera.xmag = static_cast<float>(from.orthographic.xmag);
            camera.ymag = static_cast<float>(from.orthographic.ymag);
            camera.znear = static_cast<float>(from.orthographic.znear);
            camera.zfar = static_cast<float>(from.orthographic.zfar);
            if (camera.xmag == 0.0F || camera.ymag == 0.0F)
                return error_at(document, fmt::format("/cameras/{}/orthographic", i), "sees nothing",
                                "xmag and ymag other than zero");
        }
        if (camera.zfar != 0.0F && camera.zfar <= camera.znear)
            return error_at(document, fmt::format("/cameras/{}/{}/zfar", i, from.type),
                            "is not larger than znear");
        model.cameras.push_back(std::move(camera));
    }
    return {};
}

Status read_lights(const Document& document, Model& model) {
    for (std::size_t i = 0; i < document.gltf.lights.size(); ++i) {
        const tinygltf::Light& from = document.gltf.lights[i];
        const std::string pointer = fmt::format("/extensions/KHR_lights_punctual/lights/{}", i);
        Light light;
        light.name = from.name;
        if (from.type == "directional") light.type = LightType::directional;
        if (from.type == "spot") light.type = LightType::spot;
        if (from.color.size() == 3) light.color = {from.color[0], from.color[1], from.color[2]};
        light.intensity = static_cast<float>(from.intensity);
        light.range = static_cast<float>(from.range);
        light.inner_cone = static_cast<float>(from.spot.innerConeAngle);
        light.outer_cone = static_cast<float>(from.spot.outerConeAngle);
        if (light.type == LightType::spot && light.inner_cone >= light.outer_cone)
            return error_at(document, pointer + "/spot",
                            "has an inner cone that is not within the outer one");
        model.lights.push_back(std::move(light));
    }
    return {};
}

}  // namespace bolt::assets
