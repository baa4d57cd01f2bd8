#include "game/view/scene_stream.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace bolt::view {

namespace {

using cluster::MessageReader;
using cluster::MessageWriter;

// The parts of an object that are written, in this order.
enum ObjectPart : std::uint8_t {
    part_mesh = 1,
    part_world = 2,
    part_look = 4,
    part_outline = 8,
    part_deformation = 16,
};
constexpr std::uint8_t all_parts = 31;
// Bits of the flags of an object.
enum ObjectFlag : std::uint8_t { flag_flat = 1, flag_moves = 2, flag_cut = 4 };
constexpr std::uint32_t no_more = 0xFFFFFFFF;  // ends a list: in place of the index of an object or label
// Bytes of a new object and of a new label, at least: a damaged message must not take all memory.
constexpr std::size_t smallest_object = 99, smallest_label = 117;

// An affine transformation as three rows, without loss.
void put_transform(MessageWriter& message, const glm::mat4& m) {
    for (glm::length_t row = 0; row < 3; ++row)
        message.put(glm::vec4(m[0][row], m[1][row], m[2][row], m[3][row]));
}

glm::mat4 get_transform(MessageReader& message) {
    glm::mat4 m(1.0F);
    for (glm::length_t row = 0; row < 3; ++row) {
        const auto values = message.get<glm::vec4>();
        for (glm::length_t column = 0; column < 4; ++column) m[column][row] = values[column];
    }
    return m;
}

bool is_finite(const glm::mat4& m) {
    for (glm::length_t column = 0; column < 4; ++column)
        for (glm::length_t row = 0; row < 4; ++row)
            if (!std::isfinite(m[column][row])) return false;
    return true;
}

// The size of the list if the model is not in it.
std::uint32_t index_of(const render::GpuModel* model, const StreamedModels& models) {
    const auto found = std::find(models.models.begin(), models.models.end(), model);
    return static_cast<std::uint32_t>(found - models.models.begin());
}

std::uint8_t flags_of(const render::Object& object) {
    return static_cast<std::uint8_t>((object.flat ? flag_flat : 0) | (object.moves ? flag_moves : 0) |
                                     (object.cut ? flag_cut : 0));
}

std::uint8_t changed_parts(const render::Object& now, const render::Object& before) {
    unsigned parts = 0;
    if (now.model != before.model || now.mesh != before.mesh || flags_of(now) != flags_of(before))
        parts |= part_mesh;
    if (now.world != before.world) parts |= part_world;
    if (now.tint != before.tint || now.opacity != before.opacity) parts |= part_look;
    if (now.outline != before.outline) parts |= part_outline;
    if (now.deformation != before.deformation) parts |= part_deformation;
    return static_cast<std::uint8_t>(parts);
}

void put_object(MessageWriter& message, const render::Object& object, std::uint8_t parts,
                const StreamedModels& models) {
    if ((parts & part_mesh) != 0) {
        message.put(index_of(object.model, models));
        message.put(object.mesh);
        message.put(flags_of(object));
    }
    if ((parts & part_world) != 0) put_transform(message, object.world);
    if ((parts & part_look) != 0) {
        message.put(object.tint);
        message.put(object.opacity);
    }
    if ((parts & part_outline) != 0) message.put(object.outline);
    if ((parts & part_deformation) == 0) return;
    message.put(object.deformation != nullptr);
    if (!object.deformation) return;
    message.put(static_cast<std::uint32_t>(object.deformation->joints.size()));
    for (const glm::mat4& joint : object.deformation->joints) put_transform(message, joint);
    message.put_all(std::span<const float>(object.deformation->weights));
}

std::shared_ptr<const render::Deformation> get_deformation(MessageReader& message) {
    if (!message.get<bool>()) return nullptr;
    const auto count = message.get<std::uint32_t>();
    if (count > message.size() / (3 * sizeof(glm::vec4))) {
        message.mark_damaged();
        return nullptr;
    }
    render::Deformation deformation;
    deformation.joints.reserve(count);
    for (std::uint32_t i = 0; i < count; ++i) deformation.joints.push_back(get_transform(message));
    deformation.weights = message.get_all<float>();
    return std::make_shared<const render::Deformation>(std::move(deformation));
}

void get_object(MessageReader& message, render::Object& object, std::uint8_t parts,
                const StreamedModels& models) {
    if ((parts & part_mesh) != 0) {
        const auto model = message.get<std::uint32_t>();
        object.model = model < models.models.size() ? models.models[model] : nullptr;
        object.mesh = message.get<std::uint32_t>();
        const auto flags = message.get<std::uint8_t>();
        object.flat = (flags & flag_flat) != 0;
        object.moves = (flags & flag_moves) != 0;
        object.cut = (flags & flag_cut) != 0;
    }
    if ((parts & part_world) != 0) object.world = get_transform(message);
    if ((parts & part_look) != 0) {
        object.tint = message.get<glm::vec4>();
        object.opacity = message.get<float>();
    }
    if ((parts & part_outline) != 0) object.outline = message.get<glm::vec4>();
    if ((parts & part_deformation) != 0) object.deformation = get_deformation(message);
}

// Returns true if the renderer can draw the object: its mesh exists, its values are finite, and its
// deformation has all joints that the mesh refers to.
bool can_be_drawn(const render::Object& object) {
    if (object.model == nullptr || object.mesh >= object.model->meshes.size()) return false;
    if (!is_finite(object.world) || !std::isfinite(object.opacity)) return false;
    if (!object.deformation) return true;
    const std::vector<glm::mat4>& joints = object.deformation->joints;
    if (!std::all_of(joints.begin(), joints.end(), is_finite)) return false;
    const render::MeshRange& range = object.model->meshes[object.mesh];
    for (std::uint32_t i = 0; i < range.count; ++i)
        if (object.model->parts[range.first + i].deformable.joint_boxes.size() > joints.size()) return false;
    return true;
}

void put_label(MessageWriter& message, const render::Label& label) {
    message.put_text(label.text);
    message.put(label.position);
    message.put(label.placement);
    message.put(label.orientation);
    for (const float value :
         {label.height, label.outline_width, label.occluded_visibility, label.occlusion_margin})
        message.put(value);
    message.put(label.anchor);
    message.put(label.offset_px);
    for (const glm::vec4& color : {label.color, label.outline, label.plate}) message.put(color);
}

render::Label get_label(MessageReader& message) {
    render::Label label;
    label.text = message.get_text();
    label.position = message.get<glm::vec3>();
    label.placement = message.get<render::LabelPlacement>();
    if (label.placement > render::LabelPlacement::on_screen) message.mark_damaged();
    label.orientation = message.get<glm::quat>();
    for (float* value :
         {&label.height, &label.outline_width, &label.occluded_visibility, &label.occlusion_margin}) {
        *value = message.get<float>();
        if (!std::isfinite(*value)) message.mark_damaged();
    }
    label.anchor = message.get<glm::vec2>();
    label.offset_px = message.get<glm::vec2>();
    for (glm::vec4* color : {&label.color, &label.outline, &label.plate}) *color = message.get<glm::vec4>();
    return label;
}

void put_lights(MessageWriter& message, const render::Scene& scene) {
    message.put(static_cast<std::uint32_t>(scene.lights.size()));
    for (const render::SceneLight& light : scene.lights) {
        for (const glm::vec4& part :
             {light.light.position, light.light.direction, light.light.color, light.light.cone})
            message.put(part);
        message.put(light.casts_shadow);
    }
}

void get_lights(MessageReader& message, render::Scene& scene) {
    const auto count = message.get<std::uint32_t>();
    if (count > MAX_LIGHTS) message.mark_damaged();
    scene.lights.clear();
    for (std::uint32_t i = 0; i < count && message.ok(); ++i) {
        render::SceneLight light;
        render::shared::Light& values = light.light;
        for (glm::vec4* part : {&values.position, &values.direction, &values.color, &values.cone})
            *part = message.get<glm::vec4>();
        light.casts_shadow = message.get<bool>();
        scene.lights.push_back(light);
    }
}

void put_surroundings(MessageWriter& message, const render::Scene& scene, const StreamedModels& models) {
    message.put(scene.environment != nullptr && scene.environment == models.light);
    for (const float value :
         {scene.environment_intensity, scene.environment_turn, scene.exposure, scene.occlusion_radius,
          scene.outline_px, scene.cut_away.radius, scene.cut_away.strength})
        message.put(value);
    message.put(scene.background);
    message.put(scene.cut_away.focus);
}

void get_surroundings(MessageReader& message, render::Scene& scene, const StreamedModels& models) {
    scene.environment = message.get<bool>() ? models.light : nullptr;
    for (float* value :
         {&scene.environment_intensity, &scene.environment_turn, &scene.exposure, &scene.occlusion_radius,
          &scene.outline_px, &scene.cut_away.radius, &scene.cut_away.strength}) {
        *value = message.get<float>();
        if (!std::isfinite(*value)) message.mark_damaged();
    }
    scene.background = message.get<glm::vec4>();
    scene.cut_away.focus = message.get<glm::vec3>();
}

void get_objects(MessageReader& message, const StreamedModels& models, render::Scene& scene) {
    const auto count = message.get<std::uint32_t>();
    if (count > scene.objects.size() + message.size() / smallest_object) message.mark_damaged();
    if (!message.ok()) return;
    scene.objects.resize(count);
    for (;;) {
        const auto index = message.get<std::uint32_t>();
        if (!message.ok() || index == no_more) break;
        if (index >= count) return message.mark_damaged();
        const auto parts = message.get<std::uint8_t>();
        get_object(message, scene.objects[index], parts, models);
        if (parts > all_parts || !can_be_drawn(scene.objects[index])) return message.mark_damaged();
    }
    // A new object that was not described has no model.
    if (std::any_of(scene.objects.begin(), scene.objects.end(),
                    [](const render::Object& object) { return object.model == nullptr; }))
        message.mark_damaged();
}

void get_labels(MessageReader& message, render::Scene& scene) {
    const auto count = message.get<std::uint32_t>();
    if (count > scene.labels.size() + message.size() / smallest_label) message.mark_damaged();
    if (!message.ok()) return;
    scene.labels.resize(count);
    for (;;) {
        const auto index = message.get<std::uint32_t>();
        if (!message.ok() || index == no_more) return;
        if (index >= count) return message.mark_damaged();
        scene.labels[index] = get_label(message);
    }
}

}  // namespace

void SceneSender::restart() {
    objects_.clear();
    labels_.clear();
    whole_ = true;
}

void SceneSender::write(MessageWriter& message, const render::Scene& scene, const StreamedModels& models) {
    message.put(std::exchange(whole_, false));
    put_surroundings(message, scene, models);
    put_lights(message, scene);
    std::vector<render::Object> objects;
    objects.reserve(scene.objects.size());
    std::copy_if(
        scene.objects.begin(), scene.objects.end(), std::back_inserter(objects),
        [&](const render::Object& object) { return index_of(object.model, models) < models.models.size(); });
    message.put(static_cast<std::uint32_t>(objects.size()));
    for (std::size_t i = 0; i < objects.size(); ++i) {
        const std::uint8_t parts = i < objects_.size() ? changed_parts(objects[i], objects_[i]) : all_parts;
        if (parts == 0) continue;
        message.put(static_cast<std::uint32_t>(i));
        message.put(parts);
        put_object(message, objects[i], parts, models);
    }
    message.put(no_more);
    objects_ = std::move(objects);
    message.put(static_cast<std::uint32_t>(scene.labels.size()));
    for (std::size_t i = 0; i < scene.labels.size(); ++i) {
        if (i < labels_.size() && labels_[i] == scene.labels[i]) continue;
        message.put(static_cast<std::uint32_t>(i));
        put_label(message, scene.labels[i]);
    }
    message.put(no_more);
    labels_ = scene.labels;
}

Status read_scene(MessageReader& message, const StreamedModels& models, render::Scene& scene) {
    if (message.get<bool>()) {
        scene.objects.clear();
        scene.labels.clear();
    }
    get_surroundings(message, scene, models);
    get_lights(message, scene);
    get_objects(message, models, scene);
    get_labels(message, scene);
    if (message.ok()) return {};
    scene.objects.clear();
    scene.labels.clear();
    return fail(ErrorCode::failed, "the scene that another process sent cannot be drawn",
                "the same program and content in all processes");
}

}  // namespace bolt::view
