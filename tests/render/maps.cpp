// Textures on triangles.
#include <doctest/doctest.h>

#include "tests/render/support.hpp"

using namespace bolt;
using namespace bolt::render;

TEST_CASE("Maps: base colour, normals, roughness and holes are independent of the triangulation") {
    // A board of large texels seen from near uses the finest mip; coarser ones would be grey.
    assets::Bitmap board;
    board.width = board.height = 32;
    board.channels = 4;
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x) {
            const bool dark = (x / 2 + y / 2) % 2 == 0;
            for (const int value : {dark ? 40 : 220, dark ? 100 : 150, 220, dark ? 80 : 180})
                board.pixels.push_back(static_cast<std::uint8_t>(value));
        }
    assets::Model model = test::plate({});
    model.images.push_back(board);
    model.textures.push_back({.image = 0});
    assets::Material& material = model.materials[0];
    for (assets::TextureRef* map : {&material.base_color_texture, &material.normal_texture,
                                    &material.metallic_roughness_texture, &material.emissive_texture})
        map->texture = 0;
    material.alpha_mode = assets::AlphaMode::mask;
    material.emissive = glm::vec3(0.2F);
    assets::Primitive& square = model.meshes[0].primitives[0];
    square.texcoords[0] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    assets::Model other = model;
    other.meshes[0].primitives[0].indices = {0, 1, 3, 1, 2, 3};

    test::Studio studio;
    const EnvironmentLight light = studio.light(shading::studio_environment(64));
    const auto shoot = [&](const assets::Model& plate) {
        const GpuModel gpu_model = studio.upload(plate);
        Scene scene;
        add_model(scene, plate, gpu_model);
        scene.environment = &light;
        scene.background = {0.3F, 0.3F, 0.3F, 1.0F};
        Perspective p;
        p.fov = 0.6F;
        return studio.shoot(scene, make_eye({0.4F, 4, 1.5F}, {0, 0, 0}, p), {128, 128});
    };
    const Picture one = shoot(model), two = shoot(other);
    CHECK(test::largest_difference(one, two) <= 8);
    // Negative control: a shift by half a texel is detected.
    other.meshes[0].primitives[0].texcoords[0] = {{0.015F, 0}, {1.015F, 0}, {1.015F, 1}, {0.015F, 1}};
    CHECK(test::largest_difference(one, shoot(other)) > 60);
}
