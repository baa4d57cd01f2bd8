#include "engine/render/draw_list.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <tuple>

#include "engine/render/camera.hpp"

namespace bolt::render {

namespace {

// A part of an object that is drawn.
struct Item {
    PipelineKind kind;
    const Object* object = nullptr;
    std::uint32_t model = 0;  // in order of first use
    std::uint32_t part = 0, level = 0;
    bool outlined = false;
    float distance = 0.0F;  // m, see drawing_distance()
};

// Features by which a part's values differ from the material's constants.
constexpr std::uint32_t varying_features =
    SCENE_BASE_MAP | SCENE_METALLIC_ROUGHNESS_MAP | SCENE_OCCLUSION_MAP | SCENE_VERTEX_COLORS | SCENE_TINTED;

PipelineKind kind_of(const Object& object, const MeshPart& part) {
    const MaterialMaps& maps = object.model->maps[part.material];
    PipelineKind kind;
    kind.ghost = object.opacity < 1.0F;
    kind.blends = maps.blends || kind.ghost;
    // Mirroring reverses the winding.
    const bool mirrored = glm::determinant(glm::mat3(object.world)) < 0.0F;
    kind.double_sided = maps.double_sided || mirrored != mirrors(object.deformation.get());
    kind.features = object.model->features[part.material];
    if (part.colors) kind.features |= SCENE_VERTEX_COLORS;
    if (part.tangents) kind.features |= SCENE_TANGENTS;
    if (object.flat || object.tint.w > 0.0F || object.opacity < 1.0F) kind.features |= SCENE_TINTED;
    const std::uint32_t f = kind.features;
    const bool coat_has_own_normal = (f & SCENE_COAT) != 0 && (f & SCENE_NORMAL_MAP) != 0;
    kind.forward = kind.blends || object.flat || coat_has_own_normal ||
                   (f & (SCENE_EMISSIVE_MAP | SCENE_FORWARD_MAPS)) != 0;
    if (!kind.forward && (f & varying_features) != 0) kind.features |= SCENE_PER_PIXEL_MATERIAL;
    return kind;
}

// Returns the pixels per metre at the box corner nearest to an eye: the maximum over all eyes.
float pixels_per_metre(const BoundingBox& box, std::span<const Eye> eyes, float height_px) {
    float most = 0.0F;
    for (const Eye& eye : eyes) {
        const glm::mat4& m = eye.clip_from_world;
        float nearest = 1e30F;
        for (int i = 0; i < 8; ++i)
            nearest = std::min(
                nearest, glm::dot(glm::vec4(m[0].w, m[1].w, m[2].w, m[3].w), glm::vec4(box.corner(i), 1.0F)));
        if (nearest <= 0.0F) return 1e30F;  // the box reaches behind the eye
        most = std::max(most, glm::length(glm::vec3(m[0].y, m[1].y, m[2].y)) * 0.5F * height_px / nearest);
    }
    return most;
}

std::uint32_t level_of(const MeshPart& part, const BoundingBox& box, float scale, std::span<const Eye> eyes,
                       const DetailLimits& detail) {
    if (part.levels.size() < 2) return 0;
    const float allowed =
        eyes.empty() ? detail.allowed_m : detail.allowed_px / pixels_per_metre(box, eyes, detail.height_px);
    std::uint32_t level = 0;
    while (level + 1 < part.levels.size() && part.levels[level + 1].error * scale < allowed) ++level;
    return level;
}

// Returns false if a box is certainly outside the cones from the eyes to the cut-away's focus.
bool may_hide_focus(const BoundingBox& box, const CutAway& cut, std::span<const Eye> eyes) {
    const glm::vec3 middle = 0.5F * (box.low + box.high);
    const float reach = 0.5F * glm::distance(box.low, box.high);
    return std::any_of(eyes.begin(), eyes.end(), [&](const Eye& eye) {
        const glm::vec3 to_focus = cut.focus - eye.position;
        const float length = glm::length(to_focus);
        if (length <= 0.0F) return false;
        const float along = glm::dot(middle - eye.position, to_focus) / length;
        const float distance_to_axis = glm::length(middle - eye.position - to_focus * (along / length));
        return along - reach < length && along + reach > 0.0F && distance_to_axis - reach < cut.radius;
    });
}

bool may_be_visible(const BoundingBox& box, std::span<const Eye> eyes, float margin) {
    return eyes.empty() || std::any_of(eyes.begin(), eyes.end(), [&](const Eye& eye) {
               return may_be_visible(box, eye.clip_from_world, margin);
           });
}

// Items with the same value are drawn as instances of one draw.
auto draw_of(const Item& item) {
    return std::tie(item.kind, item.model, item.part, item.level, item.outlined);
}

// The order of drawing:
// 1. opaque parts in the geometry buffer, from near to far, so that few of their pixels are drawn over
// 2. other opaque parts, from near to far
// 3. blended parts, from far to near
bool is_drawn_before(const Item& a, const Item& b) {
    if (a.kind.blends != b.kind.blends) return b.kind.blends;
    if (a.kind.forward != b.kind.forward) return b.kind.forward;
    if (a.distance != b.distance) return (a.distance < b.distance) != a.kind.blends;
    return draw_of(a) < draw_of(b);
}

// Opaque items of one draw stay together, at the distance of the nearest of them.
void sort_for_drawing(std::vector<Item>& items) {
    std::map<decltype(draw_of(items.front())), float> nearest;
    for (const Item& item : items) {
        const auto [known, is_new] = nearest.try_emplace(draw_of(item), item.distance);
        known->second = std::min(known->second, item.distance);
    }
    for (Item& item : items)
        if (!item.kind.blends) item.distance = nearest.at(draw_of(item));
    std::stable_sort(items.begin(), items.end(), is_drawn_before);
}

// Returns the distance by which parts are ordered: for blended ones that of the box's centre; for opaque ones
// that of its farthest corner, so that floors and walls, whose boxes surround the eye, come last.
float drawing_distance(const BoundingBox& box, const glm::vec3& eye, bool blends) {
    if (blends) return glm::distance(0.5F * (box.low + box.high), eye);
    return glm::length(glm::max(glm::abs(box.low - eye), glm::abs(box.high - eye)));
}

shared::Instance instance_of(const Object& object) {
    shared::Instance instance{};
    instance.world_from_object = object.world;
    instance.tint = object.tint;
    instance.outline = object.outline;
    instance.flags = object.flat ? INSTANCE_FLAT : 0U;
    instance.opacity = object.opacity;
    return instance;
}

}  // namespace

BoundingBox cone_end(const CutAway& cut) { return {cut.focus - cut.radius, cut.focus + cut.radius}; }

std::uint32_t features_of(const Scene& scene) {
    std::uint32_t features =
        static_cast<std::uint32_t>(std::min<std::size_t>(scene.lights.size(), MAX_LIGHTS))
        << SCENE_LIGHTS_SHIFT;
    if (casts_shadow(scene)) features |= SCENE_SHADOW;
    if (scene.occlusion_radius > 0.0F) features |= SCENE_OCCLUSION;
    return features;
}

DrawList make_draw_list(const Scene& scene, std::span<const Eye> eyes, const DetailLimits& detail,
                        const DeformedParts& deformed) {
    DrawList list;
    // By model: its order of first use, and the index of its first material.
    std::map<const GpuModel*, std::pair<std::uint32_t, std::uint32_t>> models;
    const std::uint32_t scene_features = features_of(scene);
    std::vector<Item> items;
    for (const Object& object : scene.objects) {
        const auto [known, is_new] =
            models.try_emplace(object.model, static_cast<std::uint32_t>(models.size()),
                               static_cast<std::uint32_t>(list.materials.size()));
        if (is_new)
            list.materials.insert(list.materials.end(), object.model->materials.begin(),
                                  object.model->materials.end());
        const Deformation* deformation = object.deformation.get();
        const float scale =
            std::cbrt(std::abs(glm::determinant(glm::mat3(object.world)))) * scale_of(deformation);
        const MeshRange range = object.model->meshes[object.mesh];
        for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
            const MeshPart& part = object.model->parts[i];
            const BoundingBox box = bounds(object, part);
            if (!may_be_visible(box, eyes, detail.margin)) continue;
            PipelineKind kind = kind_of(object, part);
            const float distance =
                eyes.empty() ? 0.0F : drawing_distance(box, eyes.front().position, kind.blends);
            kind.features |= scene_features;
            Item item{kind,
                      &object,
                      known->second.first,
                      i,
                      level_of(part, box, scale, eyes, detail),
                      object.outline.w > 0.0F,
                      distance};
            if (item.outlined) list.outlined.push_back(box);
            if (object.cut && scene.cut_away.strength > 0.0F && may_hide_focus(box, scene.cut_away, eyes)) {
                // The opaque region is drawn as a surface, the fading region is blended.
                item.kind.features |= SCENE_CUT;
                if (!kind.forward) {
                    items.push_back(item);
                    item.kind.features |= SCENE_CUT_FADING;
                }
                item.kind.blends = item.kind.forward = true;
                item.distance = drawing_distance(box, eyes.front().position, true);
                if (!kind.forward) list.forward.push_back(cone_end(scene.cut_away));
                item.kind.ghost = false;  // removed regions hide nothing
                item.kind.features &= ~SCENE_PER_PIXEL_MATERIAL;
                item.outlined = item.outlined && kind.forward;
            }
            items.push_back(item);
            if (kind.forward) list.forward.push_back(box);
        }
    }
    sort_for_drawing(items);
    for (const Item& item : items) {
        const MeshPart& part = item.object->model->parts[item.part];
        const auto found = deformed.find({item.object->deformation.get(), &part});
        const DeformedPart vertices = found != deformed.end() ? found->second : DeformedPart{};
        const bool is_same_draw =
            !list.draws.empty() && list.draws.back().kind == item.kind &&
            list.draws.back().model == item.object->model && list.draws.back().part == item.part &&
            list.draws.back().level == item.level && list.draws.back().outlined == item.outlined &&
            list.draws.back().deformed == vertices;
        if (!is_same_draw)
            list.draws.push_back({item.kind, item.object->model, item.part, item.level,
                                  models.at(item.object->model).second + part.material, item.outlined,
                                  static_cast<std::uint32_t>(list.instances.size()), 0, vertices});
        ++list.draws.back().instances;
        if (!item.kind.forward) list.features |= item.kind.features;
        list.instances.push_back(instance_of(*item.object));
        list.triangles += part.levels[item.level].index_count / 3;
    }
    return list;
}

}  // namespace bolt::render
