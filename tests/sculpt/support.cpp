#include "support.hpp"

#include <doctest/doctest.h>

namespace bolt::sculpt::test {

const HandModels& hands() {
    static const HandModels made = [] {
        Result<HandModels> result = make_hands();
        REQUIRE(result.has_value());
        return std::move(*result);
    }();
    return made;
}

const HandShape& shape() {
    static const HandShape made;
    return made;
}

TriMesh as_stored(const assets::Model& model) {
    TriMesh out;
    for (const assets::Primitive& primitive : model.meshes.at(0).primitives) {
        const auto base = static_cast<std::uint32_t>(out.positions.size());
        for (const glm::vec3& p : primitive.positions) out.positions.emplace_back(p);
        for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
            out.triangles.push_back({base + primitive.indices[i], base + primitive.indices[i + 1],
                                     base + primitive.indices[i + 2]});
        }
    }
    return out;
}

TriMesh joined(const assets::Model& model) { return weld(as_stored(model)); }

}  // namespace bolt::sculpt::test
