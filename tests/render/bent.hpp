// Reference deformation in double precision, written directly from the glTF specification.
#pragma once

#include <glm/matrix.hpp>

#include "engine/render/gpu_model.hpp"

namespace bolt::test {

struct Bent {
    std::vector<glm::dvec3> positions, normals, tangents;  // in the object's frame; unit length
};

// glTF 2.0, 3.7.2.2 and 3.7.3.3. Normals are transformed by the inverse transpose.
inline Bent bent(const assets::Primitive& p, const render::Deformation& deformation) {
    Bent result;
    const auto morphed = [&](glm::dvec3 rest, std::size_t i, auto stream) {
        for (std::size_t t = 0; t < p.targets.size() && t < deformation.weights.size(); ++t)
            if (!(p.targets[t].*stream).empty())
                rest += double{deformation.weights[t]} * glm::dvec3((p.targets[t].*stream)[i]);
        return rest;
    };
    for (std::size_t i = 0; i < p.positions.size(); ++i) {
        glm::dmat4 m(1.0);
        if (!deformation.joints.empty() && !p.joints.empty()) {
            m = glm::dmat4(0.0);
            for (int k = 0; k < 4; ++k)
                m += double{p.weights[i][k]} * glm::dmat4(deformation.joints[p.joints[i][k]]);
        }
        const glm::dvec3 place = morphed(glm::dvec3(p.positions[i]), i, &assets::MorphTarget::positions);
        result.positions.emplace_back(m * glm::dvec4(place, 1.0));
        if (p.normals.empty()) continue;
        const glm::dvec3 n = morphed(glm::dvec3(p.normals[i]), i, &assets::MorphTarget::normals);
        result.normals.push_back(glm::normalize(glm::transpose(glm::inverse(glm::dmat3(m))) * n));
        if (p.tangents.empty()) continue;
        const glm::dvec3 t = morphed(glm::dvec3(p.tangents[i]), i, &assets::MorphTarget::tangents);
        result.tangents.push_back(glm::normalize(glm::dmat3(m) * t));
    }
    return result;
}

}  // namespace bolt::test
