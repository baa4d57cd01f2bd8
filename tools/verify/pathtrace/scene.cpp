#include "tools/verify/pathtrace/scene.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <string>

#include "engine/assets/image.hpp"
#include "engine/base/embree.hpp"
#include "tools/verify/pathtrace/camera.hpp"
#include "tools/verify/pathtrace/flatten.hpp"

namespace bolt::pathtrace {

namespace {

// Maps a texel index into the image by the wrap mode.
int wrapped(int index, int size, assets::Wrap wrap) {
    if (wrap == assets::Wrap::clamp) return std::clamp(index, 0, size - 1);
    if (wrap == assets::Wrap::repeat) return ((index % size) + size) % size;
    const int period = ((index % (2 * size)) + 2 * size) % (2 * size);
    return period < size ? period : 2 * size - 1 - period;
}

glm::vec4 texel(const assets::Bitmap& image, int x, int y, bool srgb) {
    const auto channels = static_cast<std::size_t>(image.channels);
    const auto row = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width);
    const std::uint8_t* bytes = image.pixels.data() + (row + static_cast<std::size_t>(x)) * channels;
    const auto color = [&](std::size_t c) {
        return srgb ? from_srgb(bytes[c]) : static_cast<float>(bytes[c]) / 255.0F;
    };
    const float alpha = channels % 2 == 0 ? static_cast<float>(bytes[channels - 1]) / 255.0F : 1.0F;
    if (channels < 3) return {glm::vec3(color(0)), alpha};
    return {color(0), color(1), color(2), alpha};
}

}  // namespace

Result<Textures> Textures::load(const assets::Model& model) {
    Textures textures;
    textures.images_ = model.images;
    textures.textures_ = model.textures;
    for (assets::Bitmap& image : textures.images_) BOLT_TRY(assets::decode(image));
    return textures;
}

glm::vec4 Textures::sample(const assets::TextureRef& ref, const std::array<glm::vec2, 2>& texcoords,
                           bool srgb) const {
    if (ref.texture < 0) return glm::vec4(1.0F);
    const assets::Texture& texture = textures_[static_cast<std::size_t>(ref.texture)];
    if (texture.image < 0) return glm::vec4(1.0F);
    const assets::Bitmap& image = images_[static_cast<std::size_t>(texture.image)];
    const glm::vec2 scaled = texcoords[static_cast<std::size_t>(ref.texcoord & 1)] * ref.scale;
    const float c = std::cos(ref.rotation);
    const float s = std::sin(ref.rotation);
    const glm::vec2 uv = glm::vec2(c * scaled.x + s * scaled.y, -s * scaled.x + c * scaled.y) + ref.offset;
    // Clamp: far from the origin a float cannot distinguish texels, and the index may overflow an int.
    const glm::vec2 position = glm::clamp(uv, -1e4F, 1e4F) * glm::vec2(image.width, image.height);
    const auto at = [&](int x, int y) {
        return texel(image, wrapped(x, image.width, texture.wrap_s), wrapped(y, image.height, texture.wrap_t),
                     srgb);
    };
    if (texture.mag == assets::Filter::nearest)
        return at(static_cast<int>(std::floor(position.x)), static_cast<int>(std::floor(position.y)));
    const glm::vec2 corner = glm::floor(position - 0.5F);
    const glm::vec2 f = position - 0.5F - corner;
    const int x = static_cast<int>(corner.x);
    const int y = static_cast<int>(corner.y);
    return glm::mix(glm::mix(at(x, y), at(x + 1, y), f.x), glm::mix(at(x, y + 1), at(x + 1, y + 1), f.x),
                    f.y);
}

namespace {

RTCRay make_ray(const glm::vec3& origin, const glm::vec3& direction, float distance) {
    RTCRay ray{};
    ray.org_x = origin.x;
    ray.org_y = origin.y;
    ray.org_z = origin.z;
    ray.dir_x = direction.x;
    ray.dir_y = direction.y;
    ray.dir_z = direction.z;
    ray.tfar = distance;
    ray.mask = 0xFFFFFFFFU;
    return ray;
}

void add_floor(FlatMesh& flat, std::size_t material, const glm::vec3& low, const glm::vec3& high) {
    const float half = 20.0F * glm::distance(low, high);
    const glm::vec3 middle = 0.5F * (low + high);
    const auto first = static_cast<std::uint32_t>(flat.vertices.size());
    for (const auto& [x, z] : {std::pair{-1, -1}, {-1, 1}, {1, 1}, {1, -1}}) {
        Vertex vertex;
        vertex.position = {middle.x + static_cast<float>(x) * half, low.y,
                           middle.z + static_cast<float>(z) * half};
        vertex.normal = {0.0F, 1.0F, 0.0F};
        flat.vertices.push_back(vertex);
    }
    const auto index = static_cast<std::uint32_t>(material);
    flat.triangles.push_back({{first, first + 1, first + 2}, index});
    flat.triangles.push_back({{first, first + 2, first + 3}, index});
}

assets::Material floor_material() {
    assets::Material material;
    material.name = "floor";
    material.base_color = {0.4F, 0.4F, 0.4F, 1.0F};
    material.metallic = 0.0F;
    material.roughness = 0.8F;
    return material;
}

}  // namespace

void TracedScene::EmbreeDeleter::operator()(RTCDeviceTy* device) const { rtcReleaseDevice(device); }
void TracedScene::EmbreeDeleter::operator()(RTCSceneTy* scene) const { rtcReleaseScene(scene); }

Result<TracedScene> TracedScene::build(const assets::Model& model, const TracedSceneOptions& options) {
    FlatMesh flat = flatten(model, options.nodes);
    if (flat.triangles.empty())
        return fail(ErrorCode::bad_content, "has no visible triangles", "a model with triangles");
    TracedScene scene;
    scene.low_ = glm::vec3(FLT_MAX);
    scene.high_ = glm::vec3(-FLT_MAX);
    for (const TracedTriangle& triangle : flat.triangles) {
        for (const std::uint32_t corner : triangle.corners) {
            scene.low_ = glm::min(scene.low_, flat.vertices[corner].position);
            scene.high_ = glm::max(scene.high_, flat.vertices[corner].position);
        }
    }
    scene.materials_ = model.materials;
    scene.materials_.emplace_back();  // the default material of glTF
    scene.materials_.push_back(floor_material());
    if (options.floor) add_floor(flat, scene.materials_.size() - 1, scene.low_, scene.high_);
    for (const assets::Material& material : scene.materials_)
        scene.transparent_ = scene.transparent_ || material.alpha_mode != assets::AlphaMode::opaque;
    BOLT_TRY_ASSIGN(auto textures, Textures::load(model));
    scene.textures_ = std::move(textures);
    scene.vertices_ = std::move(flat.vertices);
    scene.triangles_ = std::move(flat.triangles);
    scene.lights_ = std::move(flat.lights);
    BOLT_TRY(scene.build_tree());
    return scene;
}

Status TracedScene::build_tree() {
    // Build with one thread so that the tree, and therefore the image, is the same on every machine.
    device_.reset(rtcNewDevice("threads=1"));
    if (!device_) return fail(ErrorCode::failed, "Embree: cannot create a device", "free memory");
    tree_.reset(rtcNewScene(device_.get()));
    rtcSetSceneFlags(tree_.get(), RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), vertices_.size()));
    auto* corners = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), triangles_.size()));
    if (positions == nullptr || corners == nullptr) {
        rtcReleaseGeometry(geometry);
        return fail(ErrorCode::failed, "Embree: cannot allocate memory for the model", "free memory");
    }
    for (std::size_t i = 0; i < vertices_.size(); ++i)
        std::memcpy(positions + 3 * i, &vertices_[i].position, 3 * sizeof(float));
    for (std::size_t i = 0; i < triangles_.size(); ++i)
        std::memcpy(corners + 3 * i, triangles_[i].corners.data(), 3 * sizeof(std::uint32_t));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(tree_.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(tree_.get());
    return {};
}

std::optional<SurfaceHit> TracedScene::cast(const glm::vec3& origin, const glm::vec3& direction) const {
    RTCRayHit query{};
    query.ray = make_ray(origin, direction, FLT_MAX);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    embree::intersect(tree_.get(), query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return SurfaceHit{query.ray.tfar, query.hit.primID, {query.hit.u, query.hit.v}};
}

bool TracedScene::blocked(const glm::vec3& origin, const glm::vec3& direction, float distance) const {
    RTCRay ray = make_ray(origin, direction, distance);
    return embree::occluded(tree_.get(), ray);
}

namespace {

using assets::Material;
using assets::TextureRef;

glm::vec3 any_perpendicular(const glm::vec3& n) {
    const glm::vec3 axis = std::abs(n.x) < 0.7F ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    return glm::normalize(glm::cross(axis, n));
}

glm::mat3 make_frame(const glm::vec3& normal, const glm::vec3& tangent, float handedness) {
    glm::vec3 t = tangent - glm::dot(tangent, normal) * normal;
    const float length = glm::length(t);
    t = length > 1e-12F ? t / length : any_perpendicular(normal);
    return {t, glm::cross(normal, t) * (handedness < 0.0F ? -1.0F : 1.0F), normal};
}

// Computes the tangent (the direction of increasing u) of a triangle with texture coordinates but no
// tangents; w is the handedness of the bitangent.
glm::vec4 tangent_of(const Vertex& a, const Vertex& b, const Vertex& c, std::size_t set) {
    const glm::vec2 e1 = b.texcoords[set] - a.texcoords[set];
    const glm::vec2 e2 = c.texcoords[set] - a.texcoords[set];
    const float area = e1.x * e2.y - e2.x * e1.y;
    if (area == 0.0F) return {glm::vec3(0.0F), 1.0F};
    return {((b.position - a.position) * e2.y - (c.position - a.position) * e1.y) / area,
            area < 0.0F ? 1.0F : -1.0F};
}

// Applies a normal map to the frame.
glm::mat3 apply_normal_map(const glm::mat3& frame, const glm::vec4& texel, float scale,
                           const glm::vec3& out) {
    glm::vec3 bump = 2.0F * glm::vec3(texel) - 1.0F;
    bump.x *= scale;
    bump.y *= scale;
    const glm::vec3 normal = glm::normalize(frame * bump);
    // Ignore a normal that points away from the viewer: it would make the surface black.
    if (glm::dot(normal, out) <= 0.0F) return frame;
    return make_frame(normal, frame[0], 1.0F);
}

void set_base(const Material& m, const Textures& textures, const std::array<glm::vec2, 2>& uv,
              const glm::vec4& color, ShadingPoint& s) {
    const glm::vec4 base = m.base_color * color * textures.sample(m.base_color_texture, uv, true);
    s.base_color = glm::clamp(glm::vec3(base), 0.0F, 1.0F);
    s.opacity = 1.0F;
    if (m.alpha_mode == assets::AlphaMode::mask) s.opacity = base.a >= m.alpha_cutoff ? 1.0F : 0.0F;
    if (m.alpha_mode == assets::AlphaMode::blend) s.opacity = std::clamp(base.a, 0.0F, 1.0F);
    const glm::vec4 rough = textures.sample(m.metallic_roughness_texture, uv, false);
    s.metallic = std::clamp(m.metallic * rough.b, 0.0F, 1.0F);
    const float roughness = std::clamp(m.roughness * rough.g, 0.0F, 1.0F);
    s.alpha = glm::vec2(std::max(roughness * roughness, min_alpha));
    s.emission = m.emissive * m.emissive_strength * glm::vec3(textures.sample(m.emissive_texture, uv, true));
}

// KHR_materials_ior and _specular.
void set_dielectric(const Material& m, const Textures& textures, const std::array<glm::vec2, 2>& uv,
                    ShadingPoint& s) {
    const float ratio = (m.ior - 1.0F) / (m.ior + 1.0F);
    const float weight = m.specular * textures.sample(m.specular_texture, uv, false).a;
    const glm::vec3 tint = m.specular_color * glm::vec3(textures.sample(m.specular_color_texture, uv, true));
    s.f0 = glm::min(ratio * ratio * tint, glm::vec3(1.0F)) * weight;
    s.f90 = weight;
}

// KHR_materials_anisotropy: red and green of the texture hold the direction, blue the strength.
void set_anisotropy(const Material& m, const Textures& textures, const std::array<glm::vec2, 2>& uv,
                    ShadingPoint& s) {
    if (m.anisotropy <= 0.0F) return;
    glm::vec2 direction(1.0F, 0.0F);
    float strength = m.anisotropy;
    if (m.anisotropy_texture.texture >= 0) {
        const glm::vec4 texel = textures.sample(m.anisotropy_texture, uv, false);
        direction = glm::vec2(texel) * 2.0F - 1.0F;
        strength *= texel.b;
    }
    const float c = std::cos(m.anisotropy_rotation);
    const float r = std::sin(m.anisotropy_rotation);
    const glm::vec2 turned(c * direction.x - r * direction.y, r * direction.x + c * direction.y);
    s.frame = make_frame(s.frame[2], s.frame[0] * turned.x + s.frame[1] * turned.y, 1.0F);
    s.alpha.x = glm::mix(s.alpha.x, 1.0F, strength * strength);
}

void set_coat(const Material& m, const Textures& textures, const std::array<glm::vec2, 2>& uv,
              const glm::vec3& out, ShadingPoint& s) {
    s.coat = std::clamp(m.clearcoat * textures.sample(m.clearcoat_texture, uv, false).r, 0.0F, 1.0F);
    if (s.coat <= 0.0F) return;
    const float roughness = std::clamp(
        m.clearcoat_roughness * textures.sample(m.clearcoat_roughness_texture, uv, false).g, 0.0F, 1.0F);
    s.coat_alpha = std::max(roughness * roughness, min_alpha);
    if (m.clearcoat_normal_texture.texture >= 0)
        s.coat_frame =
            apply_normal_map(s.coat_frame, textures.sample(m.clearcoat_normal_texture, uv, false), 1.0F, out);
}

}  // namespace

glm::vec3 TracedScene::normal(const SurfaceHit& hit) const {
    const TracedTriangle& t = triangles_[hit.triangle];
    const glm::vec3& a = vertices_[t.corners[0]].position;
    const glm::vec3 n =
        glm::cross(vertices_[t.corners[1]].position - a, vertices_[t.corners[2]].position - a);
    return glm::normalize(n);
}

ShadingPoint TracedScene::shading_point(const SurfaceHit& hit, const glm::vec3& out) const {
    const TracedTriangle& t = triangles_[hit.triangle];
    const Vertex& a = vertices_[t.corners[0]];
    const Vertex& b = vertices_[t.corners[1]];
    const Vertex& c = vertices_[t.corners[2]];
    const glm::vec3 w(1.0F - hit.barycentric.x - hit.barycentric.y, hit.barycentric.x, hit.barycentric.y);
    const auto blend = [&](const auto& x, const auto& y, const auto& z) {
        return x * w.x + y * w.y + z * w.z;
    };
    const Material& m = materials_[t.material];
    const std::array<glm::vec2, 2> uv = {blend(a.texcoords[0], b.texcoords[0], c.texcoords[0]),
                                         blend(a.texcoords[1], b.texcoords[1], c.texcoords[1])};
    glm::vec3 face = normal(hit);
    glm::vec3 shading = blend(a.normal, b.normal, c.normal);
    const float length = glm::length(shading);
    shading = length > 1e-6F ? shading / length : face;
    // Shade the back of a triangle as its front.
    if (glm::dot(face, out) < 0.0F) {
        face = -face;
        shading = -shading;
    }
    // At a silhouette the smooth normal may point away from the viewer; turn it towards the viewer.
    const float facing = glm::dot(shading, out);
    if (facing < 1e-3F) shading = glm::normalize(shading + (1e-3F - facing) * out);
    glm::vec4 tangent = blend(a.tangent, b.tangent, c.tangent);
    ShadingPoint s;
    const auto set = static_cast<std::size_t>(m.normal_texture.texcoord & 1);
    if (tangent == glm::vec4(0.0F)) tangent = tangent_of(a, b, c, set);
    s.frame = make_frame(shading, glm::vec3(tangent), tangent.w);
    s.coat_frame = s.frame;
    if (m.normal_texture.texture >= 0)
        s.frame =
            apply_normal_map(s.frame, textures_.sample(m.normal_texture, uv, false), m.normal_scale, out);
    set_base(m, textures_, uv, blend(a.color, b.color, c.color), s);
    set_dielectric(m, textures_, uv, s);
    set_anisotropy(m, textures_, uv, s);
    set_coat(m, textures_, uv, out, s);
    return s;
}

// Moves the point from the triangle to the curved surface that the vertex normals describe, so that a coarse
// cylinder casts no faceted shadow on itself. J. Hanika, Hacking the Shadow Terminator, Ray Tracing Gems II,
// 2021.
glm::vec3 TracedScene::ray_origin(const SurfaceHit& hit, const glm::vec3& side) const {
    const TracedTriangle& t = triangles_[hit.triangle];
    const glm::vec3 w(1.0F - hit.barycentric.x - hit.barycentric.y, hit.barycentric.x, hit.barycentric.y);
    const glm::vec3 flat = w.x * vertices_[t.corners[0]].position + w.y * vertices_[t.corners[1]].position +
                           w.z * vertices_[t.corners[2]].position;
    glm::vec3 lift(0.0F);
    glm::vec3 face = normal(hit);
    const float sign = glm::dot(face, side) < 0.0F ? -1.0F : 1.0F;
    for (int i = 0; i < 3; ++i) {
        const Vertex& vertex = vertices_[t.corners[static_cast<std::size_t>(i)]];
        const glm::vec3 n = sign * vertex.normal;
        lift -= w[i] * std::min(0.0F, glm::dot(flat - vertex.position, n)) * n;
    }
    const float scale = std::max({std::abs(flat.x), std::abs(flat.y), std::abs(flat.z), 0.01F});
    return flat + lift + sign * face * (scale * 4e-6F);
}

}  // namespace bolt::pathtrace
