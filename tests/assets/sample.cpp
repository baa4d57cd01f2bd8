#include "tests/assets/sample.hpp"

namespace bolt::assets {

namespace {

Primitive triangle() {
    Primitive p;
    p.positions = {{0.0F, 0.0F, 0.0F}, {0.1F, 0.0F, 0.0F}, {0.0F, 0.3F, -0.7F}};
    p.normals = {{0.0F, 0.0F, 1.0F}, {0.6F, 0.0F, 0.8F}, {0.0F, 1.0F, 0.0F}};
    p.tangents = {{1.0F, 0.0F, 0.0F, 1.0F}, {0.8F, 0.0F, -0.6F, 1.0F}, {1.0F, 0.0F, 0.0F, -1.0F}};
    p.texcoords[0] = {{0.0F, 0.0F}, {1.0F, 0.0F}, {0.5F, 0.25F}};
    p.texcoords[1] = {{0.0F, 0.0F}, {4.0F, 0.0F}, {0.0F, -3.0F}};
    p.colors = {{1.0F, 0.0F, 0.0F, 1.0F}, {0.0F, 1.0F, 0.0F, 0.5F}, {0.0F, 0.0F, 1.0F, 0.0F}};
    p.indices = {2, 1, 0};
    p.material = 0;
    return p;
}

Primitive skinned() {
    Primitive p = triangle();
    p.joints = {{0, 1, 0, 0}, {1, 0, 0, 0}, {0, 0, 0, 0}};
    p.weights = {{0.75F, 0.25F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F, 0.0F}};
    MorphTarget target;
    target.positions = {{0.0F, 0.01F, 0.0F}, {0.0F, 0.0F, 0.0F}, {0.02F, 0.0F, 0.0F}};
    target.normals = {{0.0F, 0.1F, 0.0F}, {0.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 0.0F}};
    p.targets = {target};
    return p;
}

// Not square, so that the axes cannot be confused: 2 × 1 pixels.
Bitmap image() {
    Bitmap image;
    image.name = "paint";
    image.width = 2;
    image.height = 1;
    image.channels = 3;
    image.pixels = {255, 0, 0, 0, 0, 255};
    return image;
}

Material paint() {
    Material m;
    m.name = "paint";
    m.base_color = {0.1F, 0.2F, 0.3F, 0.4F};
    m.metallic = 0.25F;
    m.roughness = 0.75F;
    m.base_color_texture = {
        .texture = 0, .texcoord = 1, .offset = {0.5F, 0.25F}, .rotation = 0.3F, .scale = {2.0F, 3.0F}};
    m.metallic_roughness_texture.texture = 0;
    m.normal_texture.texture = 0;
    m.normal_scale = 0.5F;
    m.occlusion_texture.texture = 0;
    m.occlusion_strength = 0.6F;
    m.emissive_texture.texture = 0;
    m.emissive = {0.7F, 0.8F, 0.9F};
    m.emissive_strength = 5.0F;
    m.alpha_mode = AlphaMode::mask;
    m.alpha_cutoff = 0.3F;
    m.double_sided = true;
    m.clearcoat = 0.9F;
    m.clearcoat_roughness = 0.05F;
    m.clearcoat_texture.texture = 0;
    m.clearcoat_roughness_texture.texture = 0;
    m.clearcoat_normal_texture.texture = 0;
    m.anisotropy = 0.4F;
    m.anisotropy_rotation = 1.2F;
    m.anisotropy_texture = {.texture = 0, .scale = {4.0F, 1.0F}};
    m.ior = 1.7F;
    m.specular = 0.35F;
    m.specular_color = {0.5F, 0.6F, 0.65F};
    m.specular_texture.texture = 0;
    m.specular_color_texture = {.texture = 0, .texcoord = 1};
    return m;
}

std::vector<AnimationChannel> channels() {
    const std::vector<float> keys = {0.0F, 0.5F};
    return {{.node = 0, .times = keys, .values = {0, 0, 0, 1, 2, 3}},
            {.node = 1,
             .path = TargetPath::rotation,
             .interpolation = Interpolation::step,
             .times = keys,
             .values = {0, 0, 0, 1, 0, 1, 0, 0}},
            {.node = 0,
             .path = TargetPath::scale,
             .interpolation = Interpolation::cubic,
             .times = keys,
             .values = {0, 0, 0, 1, 1, 1, 0, 0, 0, 0, 0, 0, 2, 2, 2, 0, 0, 0}},
            {.node = 3, .path = TargetPath::weights, .times = keys, .values = {0.0F, 1.0F}}};
}

}  // namespace

Model sample_model() {
    Model model;
    model.generator = "sample";
    model.copyright = "nobody";
    model.nodes.resize(6);
    model.nodes[0] = {.name = "root",
                      .translation = {1.0F, 2.0F, 3.0F},
                      .rotation = {0.5F, 0.5F, -0.5F, 0.5F},
                      .scale = {1.0F, 2.0F, 4.0F},
                      .children = {1, 2, 4, 5},
                      .extras = R"({"grade":"8.8","thread":["M16",2]})"};
    model.nodes[1] = {.name = "part", .mesh = 0};
    model.nodes[2] = {.name = "same_part", .translation = {0.0F, 0.1F, 0.0F}, .mesh = 0};
    model.nodes[3] = {.name = "hand", .mesh = 1, .skin = 0, .weights = {0.5F}};
    model.nodes[4] = {.name = "eye", .camera = 0};
    model.nodes[5] = {.name = "lamp", .light = 2};
    model.roots = {0, 3};
    model.meshes = {{.name = "part", .primitives = {triangle()}},
                    {.name = "hand", .primitives = {skinned()}, .weights = {0.25F}}};
    model.materials = {paint(), {.name = "plain"}};
    model.images = {image()};
    model.textures = {{.image = 0, .mag = Filter::nearest, .wrap_s = Wrap::clamp, .wrap_t = Wrap::mirror}};
    model.skins = {{.name = "rig", .joints = {1, 2}, .inverse_bind = {glm::mat4(1.0F), glm::mat4(1.0F)}}};
    model.skins[0].inverse_bind[1][3] = {0.0F, -0.1F, 0.0F, 1.0F};
    model.lights = {
        {.name = "sun", .type = LightType::directional, .color = {1.0F, 0.9F, 0.8F}, .intensity = 3.0F},
        {.name = "bulb", .intensity = 7.0F, .range = 20.0F},
        {.name = "spot", .type = LightType::spot, .inner_cone = 0.2F, .outer_cone = 0.4F}};
    model.cameras = {
        {.name = "eye", .yfov = 0.7F, .aspect = 1.5F, .znear = 0.02F, .zfar = 50.0F},
        {.name = "plan", .perspective = false, .xmag = 0.5F, .ymag = 0.25F, .znear = 0.0F, .zfar = 9.0F}};
    model.animations = {{.name = "wave", .channels = channels()}};
    return model;
}

}  // namespace bolt::assets
