// A glTF 2.0 scene as plain values on the CPU, its triangulation and its node transforms. Names and meanings
// follow the glTF 2.0 specification (Khronos, 2021). Indices refer to the vectors of Model; -1: none. Frame:
// metres, right-handed, Y up. Colours are linear. Every member has a default, so that designated initializers
// need to name only some of them.
#pragma once

#include <array>
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <string>
#include <vector>

namespace bolt::assets {

enum class Topology : std::uint8_t {
    points,
    lines,
    line_loop,
    line_strip,
    triangles,
    triangle_strip,
    triangle_fan
};

// Displacements of a morph target; empty: none.
struct MorphTarget {
    std::vector<glm::vec3> positions = {}, normals = {}, tangents = {};
};

// Every vertex stream is empty or as long as `positions`. Empty `indices`: the vertices are used in order.
struct Primitive {
    Topology topology = Topology::triangles;
    std::vector<glm::vec3> positions = {};
    std::vector<glm::vec3> normals = {};
    std::vector<glm::vec4> tangents = {};  // w: handedness
    std::array<std::vector<glm::vec2>, 2> texcoords = {};
    std::vector<glm::vec4> colors = {};
    std::vector<glm::u16vec4> joints = {};  // indices into the skin's joints
    std::vector<glm::vec4> weights = {};    // sum to one
    std::vector<std::uint32_t> indices = {};
    std::vector<MorphTarget> targets = {};
    int material = -1;
};

struct Mesh {
    std::string name = {};
    std::vector<Primitive> primitives = {};
    std::vector<float> weights = {};  // default weights of the morph targets
};

struct Node {
    std::string name = {};
    glm::vec3 translation{0.0F};
    glm::quat rotation{1.0F, 0.0F, 0.0F, 0.0F};
    glm::vec3 scale{1.0F};
    std::vector<int> children = {};
    int mesh = -1, skin = -1, camera = -1, light = -1;
    std::vector<float> weights = {};
    std::string extras = {};  // JSON text; empty: none
};

struct Skin {
    std::string name = {};
    std::vector<int> joints = {};  // nodes
    std::vector<glm::mat4> inverse_bind = {};
    int skeleton = -1;
};

// A use of a texture, with the KHR_texture_transform extension.
struct TextureRef {
    int texture = -1;
    int texcoord = 0;  // set of texture coordinates
    glm::vec2 offset{0.0F};
    float rotation = 0.0F;  // rad
    glm::vec2 scale{1.0F};
};

enum class AlphaMode : std::uint8_t { opaque, mask, blend };

// Metallic-roughness with clearcoat, anisotropy, ior, specular and emissive strength.
struct Material {
    std::string name = {};
    glm::vec4 base_color{1.0F};
    float metallic = 1.0F, roughness = 1.0F;
    TextureRef base_color_texture = {}, metallic_roughness_texture = {}, normal_texture = {},
               occlusion_texture = {}, emissive_texture = {};
    float normal_scale = 1.0F, occlusion_strength = 1.0F;
    glm::vec3 emissive{0.0F};
    float emissive_strength = 1.0F;
    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5F;
    bool double_sided = false;
    float clearcoat = 0.0F, clearcoat_roughness = 0.0F;
    TextureRef clearcoat_texture = {}, clearcoat_roughness_texture = {}, clearcoat_normal_texture = {};
    float anisotropy = 0.0F, anisotropy_rotation = 0.0F;
    TextureRef anisotropy_texture = {};
    float ior = 1.5F;
    float specular = 1.0F;
    glm::vec3 specular_color{1.0F};
    TextureRef specular_texture = {}, specular_color_texture = {};
};

// The bytes of a PNG or JPEG file, decoded pixels, or both. Empty `pixels`: not decoded.
struct Bitmap {
    std::string name = {}, mime_type = {};
    std::vector<std::uint8_t> encoded = {};
    int width = 0, height = 0, channels = 0;
    std::vector<std::uint8_t> pixels = {};
};

enum class Filter : std::uint8_t { nearest, linear };
enum class Wrap : std::uint8_t { repeat, clamp, mirror };

struct Texture {
    int image = -1;
    Filter mag = Filter::linear, min = Filter::linear, mip = Filter::linear;
    bool mipmapped = true;
    Wrap wrap_s = Wrap::repeat, wrap_t = Wrap::repeat;
};

enum class LightType : std::uint8_t { directional, point, spot };

// A light of KHR_lights_punctual. It shines along the node's -Z.
struct Light {
    std::string name = {};
    LightType type = LightType::point;
    glm::vec3 color{1.0F};
    float intensity = 1.0F;                           // cd (point, spot) or lx (directional)
    float range = 0.0F;                               // m; 0: unlimited
    float inner_cone = 0.0F, outer_cone = 0.785398F;  // rad from the axis
};

struct Camera {
    std::string name = {};
    bool perspective = true;
    float yfov = 0.8F;                 // rad
    float aspect = 0.0F;               // width / height; 0: that of the window
    float xmag = 1.0F, ymag = 1.0F;    // m, half the width and height of an orthographic view
    float znear = 0.01F, zfar = 0.0F;  // m; zfar 0: infinite
};

// The property of a node that an animation changes (glTF: target.path).
enum class TargetPath : std::uint8_t { translation, rotation, scale, weights };
enum class Interpolation : std::uint8_t { step, linear, cubic };

struct AnimationChannel {
    int node = -1;
    TargetPath path = TargetPath::translation;
    Interpolation interpolation = Interpolation::linear;
    std::vector<float> times = {};  // s, strictly increasing
    // Per key: 3 floats, 4 for a rotation, or one per morph target; three times as many for cubic splines.
    std::vector<float> values = {};
};

struct Animation {
    std::string name = {};
    std::vector<AnimationChannel> channels = {};
};

struct Model {
    std::string generator = {}, copyright = {};
    std::vector<Node> nodes = {};
    std::vector<int> roots = {};  // root nodes of the default scene
    std::vector<Mesh> meshes = {};
    std::vector<Material> materials = {};
    std::vector<Texture> textures = {};
    std::vector<Bitmap> images = {};
    std::vector<Skin> skins = {};
    std::vector<Light> lights = {};
    std::vector<Camera> cameras = {};
    std::vector<Animation> animations = {};
};

// Adds another model, with its own meshes and materials. Its root nodes stand beside those of `model`.
void append(Model& model, Model added);

// Returns three vertex indices per triangle, wound as glTF defines for strips and fans; empty for points and
// lines.
std::vector<std::uint32_t> triangle_indices(const Primitive& primitive);

// Returns the matrix that scales, then rotates, then translates.
glm::mat4 local_transform(const glm::vec3& translation, const glm::quat& rotation, const glm::vec3& scale);

// Returns the rest-pose transforms of all nodes to world space, in the order of model.nodes. Nodes that the
// default scene does not contain are included.
std::vector<glm::mat4> world_transforms(const Model& model);

// The same for another pose. `local`: the transform of each node relative to its parent, in the order of
// model.nodes.
std::vector<glm::mat4> world_transforms(const Model& model, std::span<const glm::mat4> local);

}  // namespace bolt::assets
