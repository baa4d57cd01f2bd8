#include "engine/render/draw_list.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <map>
#include <tuple>

#include "engine/render/camera.hpp"

namespace bolt::render {

namespace {

struct Item {
    Kind kind;
    const Object* object = nullptr;
    std::uint32_t model = 0;  // in the order in which models appear
    std::uint32_t part = 0;
    float distance = 0.0F;  // of blending ones, to the first eye
};

Kind kind_of(const Object& object, const Part& part) {
    const MaterialMaps& maps = object.model->maps[part.material];
    Kind kind;
    kind.blends = maps.blends || object.opacity < 1.0F;
    // A mirrored part shows the other winding.
    kind.double_sided = maps.double_sided || glm::determinant(glm::mat3(object.world)) < 0.0F;
    kind.textured = object.model->materials[part.material].textures != 0;
    kind.colors = part.colors;
    return kind;
}

bool seen(const Box& box, std::span<const Eye> eyes) {
    return eyes.empty() || std::any_of(eyes.begin(), eyes.end(),
                                       [&](const Eye& eye) { return in_sight(box, eye.clip_from_world); });
}

bool before(const Item& a, const Item& b) {
    if (a.kind.blends != b.kind.blends) return b.kind.blends;
    if (a.kind.blends && a.distance != b.distance) return a.distance > b.distance;
    return std::tie(a.kind, a.model, a.part) < std::tie(b.kind, b.model, b.part);
}

shared::Instance instance_of(const Object& object, std::uint32_t material) {
    shared::Instance instance{};
    instance.world_from_object = object.world;
    instance.tint = object.tint;
    instance.material = material;
    instance.flags = object.flat ? INSTANCE_FLAT : 0U;
    instance.opacity = object.opacity;
    return instance;
}

}  // namespace

DrawList make_draw_list(const Scene& scene, std::span<const Eye> eyes) {
    DrawList list;
    std::map<const GpuModel*, std::pair<std::uint32_t, std::uint32_t>> models;  // → order, first material
    std::vector<Item> items;
    for (const Object& object : scene.objects) {
        const auto [known, fresh] =
            models.try_emplace(object.model, static_cast<std::uint32_t>(models.size()),
                               static_cast<std::uint32_t>(list.materials.size()));
        if (fresh)
            list.materials.insert(list.materials.end(), object.model->materials.begin(),
                                  object.model->materials.end());
        const MeshRange range = object.model->meshes[object.mesh];
        for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
            const Part& part = object.model->parts[i];
            const Box box = transformed(part.box, object.world);
            if (!seen(box, eyes)) continue;
            const float distance =
                eyes.empty() ? 0.0F : glm::distance(0.5F * (box.low + box.high), eyes.front().position);
            items.push_back({kind_of(object, part), &object, known->second.first, i, distance});
        }
    }
    std::stable_sort(items.begin(), items.end(), before);
    for (const Item& item : items) {
        const Part& part = item.object->model->parts[item.part];
        const std::uint32_t material = models.at(item.object->model).second + part.material;
        const bool joins = !list.draws.empty() && list.draws.back().kind == item.kind &&
                           list.draws.back().model == item.object->model &&
                           list.draws.back().part == item.part;
        if (!joins)
            list.draws.push_back({item.kind, item.object->model, item.part,
                                  static_cast<std::uint32_t>(list.instances.size()), 0});
        ++list.draws.back().instances;
        list.instances.push_back(instance_of(*item.object, material));
        list.triangles += part.index_count / 3;
    }
    return list;
}

}  // namespace bolt::render
