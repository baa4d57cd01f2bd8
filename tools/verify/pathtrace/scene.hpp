// Samples images as glTF defines: bilinear or nearest, wrapped, transformed (KHR_texture_transform).
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

namespace bolt::pathtrace {

// Decodes the images of the model. One that cannot be decoded is an error.
class Textures {
  public:
    static Result<Textures> load(const assets::Model& model);

    // Linear values; `srgb` for textures of colours. Without a texture: ones.
    [[nodiscard]] glm::vec4 sample(const assets::TextureRef& ref, const std::array<glm::vec2, 2>& texcoords,
                                   bool srgb) const;

  private:
    std::vector<assets::Image> images_;
    std::vector<assets::Texture> textures_;
};

}  // namespace bolt::pathtrace

// A model for ray tracing: its triangles in Embree, and the surface at a hit.

struct RTCDeviceTy;
struct RTCSceneTy;

namespace bolt::pathtrace {

struct Vertex {
    glm::vec3 position{0.0F};
    glm::vec3 normal{0.0F};  // zero: that of the triangle
    glm::vec4 tangent{0.0F};
    std::array<glm::vec2, 2> texcoords{};
    glm::vec4 color{1.0F};
};

struct Triangle {
    std::array<std::uint32_t, 3> corners{};
    std::uint32_t material = 0;
    std::int32_t node = -1;  // −1: the floor
};

// A light of the model in the world.
struct PunctualLight {
    assets::Light light;
    glm::vec3 position{0.0F};
    glm::vec3 direction{0.0F};  // in which it shines
};

struct Visibility {
    std::vector<std::string> show;  // patterns of node names with * and ?; empty: all
    std::vector<std::string> hide;
};

struct SceneOptions {
    Visibility nodes;
    bool floor = false;  // a large grey plate under the model
};

struct Hit {
    float distance = 0.0F;
    std::uint32_t triangle = 0;
    glm::vec2 barycentric{0.0F};
};

class Scene {
  public:
    static Result<Scene> build(const assets::Model& model, const SceneOptions& options);

    // The nearest triangle in front of `origin`; `direction` has unit length.
    [[nodiscard]] std::optional<Hit> cast(const glm::vec3& origin, const glm::vec3& direction) const;
    // Whether something lies within `distance`.
    [[nodiscard]] bool blocked(const glm::vec3& origin, const glm::vec3& direction, float distance) const;

    // What is there, turned towards `out` (the way that the ray came from).
    [[nodiscard]] Surface surface(const Hit& hit, const glm::vec3& out) const;
    // The geometric normal, and a point from which rays leave without meeting the surface again.
    [[nodiscard]] glm::vec3 normal(const Hit& hit) const;
    [[nodiscard]] glm::vec3 departure(const Hit& hit, const glm::vec3& side) const;
    [[nodiscard]] int node(const Hit& hit) const { return triangles_[hit.triangle].node; }
    [[nodiscard]] bool transparent() const { return transparent_; }

    [[nodiscard]] const std::vector<PunctualLight>& lights() const { return lights_; }
    [[nodiscard]] std::size_t triangle_count() const { return triangles_.size(); }
    // Of the model, without the floor.
    [[nodiscard]] glm::vec3 low() const { return low_; }
    [[nodiscard]] glm::vec3 high() const { return high_; }

  private:
    struct Release {
        void operator()(RTCDeviceTy* device) const;
        void operator()(RTCSceneTy* scene) const;
    };

    Status build_tree();

    std::unique_ptr<RTCDeviceTy, Release> device_;
    std::unique_ptr<RTCSceneTy, Release> tree_;
    std::vector<Vertex> vertices_;
    std::vector<Triangle> triangles_;
    std::vector<assets::Material> materials_;  // the last: of primitives without one
    Textures textures_;
    std::vector<PunctualLight> lights_;
    glm::vec3 low_{0.0F}, high_{0.0F};
    bool transparent_ = false;
};

}  // namespace bolt::pathtrace
