// Joining two models.
#include <doctest/doctest.h>

#include "engine/assets/gltf.hpp"
#include "engine/assets/model.hpp"
#include "tests/assets/sample.hpp"

using namespace bolt;
using namespace bolt::assets;

TEST_CASE("Append: a model that is added to itself is there twice, and each copy refers to its own parts") {
    const Model one = sample_model();
    Model two = one;
    append(two, one);
    REQUIRE(two.nodes.size() == 2 * one.nodes.size());
    REQUIRE(two.roots.size() == 2 * one.roots.size());
    REQUIRE(two.materials.size() == 2 * one.materials.size());
    REQUIRE(two.animations.size() == 2 * one.animations.size());
    const auto shifted = [](int index, std::size_t by) {
        return index < 0 ? index : index + static_cast<int>(by);
    };
    for (std::size_t i = 0; i < one.nodes.size(); ++i) {
        const Node &first = two.nodes[i], &second = two.nodes[one.nodes.size() + i];
        CHECK(first.mesh == one.nodes[i].mesh);
        CHECK(second.mesh == shifted(first.mesh, one.meshes.size()));
        CHECK(second.skin == shifted(first.skin, one.skins.size()));
        REQUIRE(second.children.size() == first.children.size());
        for (std::size_t child = 0; child < first.children.size(); ++child)
            CHECK(second.children[child] == shifted(first.children[child], one.nodes.size()));
    }
    for (std::size_t i = 0; i < one.meshes.size(); ++i)
        for (std::size_t k = 0; k < one.meshes[i].primitives.size(); ++k)
            CHECK(two.meshes[one.meshes.size() + i].primitives[k].material ==
                  shifted(one.meshes[i].primitives[k].material, one.materials.size()));
    for (std::size_t i = 0; i < one.textures.size(); ++i)
        CHECK(two.textures[one.textures.size() + i].image ==
              shifted(one.textures[i].image, one.images.size()));
    for (std::size_t i = 0; i < one.skins.size(); ++i)
        for (std::size_t k = 0; k < one.skins[i].joints.size(); ++k)
            CHECK(two.skins[one.skins.size() + i].joints[k] ==
                  shifted(one.skins[i].joints[k], one.nodes.size()));
    // The reader refuses files whose parts refer to what is not there.
    const auto bytes = encode_glb(two);
    REQUIRE(bytes);
    CHECK(parse_gltf(*bytes, "twice.glb"));
}
