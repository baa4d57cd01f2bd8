// A glTF model for ray tracing: its textures, its triangles in Embree, and the material at a hit. Lengths are
// in metres, in the world frame.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/assets/model.hpp"
#include "engine/base/result.hpp"
#include "tools/verify/pathtrace/bsdf.hpp"

struct RTCDeviceTy;
struct RTCSceneTy;

namespace bolt::pathtrace {

// Samples images as glTF defines: bilinear or nearest, wrapped, transformed (KHR_texture_transform).
class Textures {
  public:
    // Decodes the images of the model. Fails if one cannot be decoded.
    static Result<Textures> load(const assets::Model& model);

    // Returns linear values, or ones if `ref` has no texture. `srgb`: the image stores sRGB colours.
    [[nodiscard]] glm::vec4 sample(const assets::TextureRef& ref, const std::array<glm::vec2, 2>& texcoords,
                                   bool srgb) const;

  private:
    std::vector<assets::Bitmap> images_;
    std::vector<assets::Texture> textures_;
};

struct Vertex {
    glm::vec3 position{0.0F};
    glm::vec3 normal{0.0F};  // zero: the triangle's normal
    glm::vec4 tangent{0.0F};
    std::array<glm::vec2, 2> texcoords{};
    glm::vec4 color{1.0F};
};

struct TracedTriangle {
    std::array<std::uint32_t, 3> corners{};
    std::uint32_t material = 0;
};

struct PunctualLight {
    assets::Light light;
    glm::vec3 position{0.0F};
    glm::vec3 direction{0.0F};  // unit, from the light
};

struct NodeFilter {
    // Patterns of node names with * and ?. A node is visible if it or an ancestor matches `show` and none
    // matches `hide`.
    std::vector<std::string> show;  // empty: all nodes
    std::vector<std::string> hide;
};

struct TracedSceneOptions {
    NodeFilter nodes;
    bool floor = false;  // a large grey plate under the model
};

struct SurfaceHit {
    float distance = 0.0F;
    std::uint32_t triangle = 0;
    glm::vec2 barycentric{0.0F};
};

class TracedScene {
  public:
    static Result<TracedScene> build(const assets::Model& model, const TracedSceneOptions& options);

    // Returns the nearest triangle in front of `origin`. `direction` has unit length.
    [[nodiscard]] std::optional<SurfaceHit> cast(const glm::vec3& origin, const glm::vec3& direction) const;
    // Returns whether a triangle lies within `distance`.
    [[nodiscard]] bool blocked(const glm::vec3& origin, const glm::vec3& direction, float distance) const;

    // Returns the material and frames at a hit, on the side of `out` (unit, towards the ray's origin).
    [[nodiscard]] ShadingPoint shading_point(const SurfaceHit& hit, const glm::vec3& out) const;
    // Returns the geometric normal.
    [[nodiscard]] glm::vec3 normal(const SurfaceHit& hit) const;
    // Returns an origin for rays from the hit towards `side` that do not hit the same surface again.
    [[nodiscard]] glm::vec3 ray_origin(const SurfaceHit& hit, const glm::vec3& side) const;
    // Returns true if a material has an alpha mode other than opaque.
    [[nodiscard]] bool transparent() const { return transparent_; }

    [[nodiscard]] const std::vector<PunctualLight>& lights() const { return lights_; }
    [[nodiscard]] std::size_t triangle_count() const { return triangles_.size(); }
    // Bounds of the model without the floor.
    [[nodiscard]] glm::vec3 low() const { return low_; }
    [[nodiscard]] glm::vec3 high() const { return high_; }

  private:
    struct EmbreeDeleter {
        void operator()(RTCDeviceTy* device) const;
        void operator()(RTCSceneTy* scene) const;
    };

    Status build_tree();

    std::unique_ptr<RTCDeviceTy, EmbreeDeleter> device_;
    std::unique_ptr<RTCSceneTy, EmbreeDeleter> tree_;
    std::vector<Vertex> vertices_;
    std::vector<TracedTriangle> triangles_;
    std::vector<assets::Material> materials_;  // of the model, the default material, the floor's
    Textures textures_;
    std::vector<PunctualLight> lights_;
    glm::vec3 low_{0.0F}, high_{0.0F};
    bool transparent_ = false;
};

}  // namespace bolt::pathtrace
