// Skins and morph targets on the GPU, compared with double precision and with models deformed before the
// upload.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/assets/gltf.hpp"
#include "engine/assets/model.hpp"
#include "engine/base/random.hpp"
#include "engine/gpu/resources.hpp"
#include "tests/render/bent.hpp"
#include "tests/render/support.hpp"

using namespace bolt;
using namespace bolt::render;

namespace {

constexpr VkExtent2D extent{160, 120};

float number(Random& random) { return static_cast<float>(random.uniform(-1.0, 1.0)); }
glm::vec3 vector(Random& random) { return {number(random), number(random), number(random)}; }

// Rotations that differ by less than half a turn, so that no blend of them mirrors the mesh.
glm::mat4 joint(Random& random) {
    const glm::quat turn(2.0F, number(random), number(random), number(random));
    return glm::translate(glm::mat4(1.0F), vector(random)) * glm::mat4_cast(glm::normalize(turn)) *
           glm::scale(glm::mat4(1.0F), glm::vec3(1.0F) + 0.4F * vector(random));
}

// A ball with seven joints and three morph targets, one of them without normals.
assets::Model rubber_ball(Random& random) {
    assets::Model model = test::sphere({}, 24);
    assets::Primitive& p = model.meshes[0].primitives[0];
    p.targets.resize(3);
    for (std::size_t i = 0; i < p.positions.size(); ++i) {
        const glm::vec3 along = glm::cross(glm::vec3(0.6F, 0.64F, 0.48F), p.normals[i]);
        p.tangents.emplace_back(glm::normalize(along), i % 2 == 0 ? 1.0F : -1.0F);
        glm::vec4 weights = glm::abs(glm::vec4(vector(random), number(random)));
        if (i % 3 == 0) weights = {1.0F, 0.0F, 0.0F, 0.0F};
        p.weights.push_back(weights / (weights.x + weights.y + weights.z + weights.w));
        const auto any = [&] { return static_cast<std::uint16_t>(random.uniform(0.0, 6.999)); };
        p.joints.push_back({any(), any(), any(), any()});
        for (std::size_t t = 0; t < 3; ++t) {
            p.targets[t].positions.push_back(0.3F * vector(random));
            if (t < 2) p.targets[t].normals.push_back(0.3F * vector(random));
            if (t < 1) p.targets[t].tangents.push_back(0.3F * vector(random));
        }
    }
    return model;
}

std::vector<std::byte> read_back(test::Studio& studio, const gpu::Buffer& from) {
    auto to = gpu::Buffer::create(studio.device(), from.size(), VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                  gpu::MemoryUse::readback);
    REQUIRE(to.has_value());
    const Status copied = gpu::submit_and_wait(studio.device(), [&](VkCommandBuffer commands) {
        gpu::memory_barrier(commands, gpu::ResourceUse::storage_write, gpu::ResourceUse::transfer_from);
        const VkBufferCopy region{0, 0, from.size()};
        vkCmdCopyBuffer(commands, from.get(), to->get(), 1, &region);
        gpu::memory_barrier(commands, gpu::ResourceUse::transfer_to, gpu::ResourceUse::host_read);
    });
    REQUIRE(copied.has_value());
    return {to->bytes().begin(), to->bytes().end()};
}

glm::dvec3 unpacked(const std::int16_t (&v)[4]) { return glm::dvec3(v[0], v[1], v[2]) / 32767.0; }

// The deformed vertices of one part, downloaded from the last frame.
struct Seen {
    std::vector<glm::vec3> positions;
    std::vector<VertexAttributes> attributes;
};
Seen seen(test::Studio& studio, const Object& object, const MeshPart& part) {
    const DeformPass& pass = studio.renderer().deform_pass();
    const DeformedPart where = pass.parts().at({object.deformation.get(), &part});
    const std::vector<std::byte> bytes = read_back(studio, pass.vertices());
    Seen result{std::vector<glm::vec3>(part.deformable.vertices),
                std::vector<VertexAttributes>(part.deformable.vertices)};
    std::memcpy(result.positions.data(), &bytes[where.positions], result.positions.size() * 12);
    std::memcpy(result.attributes.data(), &bytes[where.attributes], result.attributes.size() * 28);
    return result;
}

// Compares every vertex of an object with the reference. Positions must agree within `near` (16-bit weights:
// 1e-5 of the distance between joint motions), directions within 2e-4 rad (16-bit components).
void check_bent(test::Studio& studio, const assets::Mesh& mesh, const Object& object, double near) {
    const MeshRange range = object.model->meshes[object.mesh];
    REQUIRE(range.count == mesh.primitives.size());
    double worst = 0.0, worst_normal = 0.0, worst_tangent = 0.0;
    std::size_t outside = 0, other_side = 0;
    for (std::uint32_t k = 0; k < range.count; ++k) {
        const MeshPart& part = object.model->parts[range.first + k];
        const assets::Primitive& p = mesh.primitives[k];
        const test::Bent expected = test::bent(p, *object.deformation);
        const Seen got = seen(studio, object, part);
        REQUIRE(got.positions.size() == expected.positions.size());
        const BoundingBox box = bounds(part.box, part.deformable, object.deformation.get());
        for (std::size_t i = 0; i < got.positions.size(); ++i) {
            worst = std::max(worst, glm::distance(glm::dvec3(got.positions[i]), expected.positions[i]));
            worst_normal = std::max(worst_normal,
                                    glm::distance(unpacked(got.attributes[i].normal), expected.normals[i]));
            if (!p.tangents.empty()) {
                worst_tangent = std::max(
                    worst_tangent, glm::distance(unpacked(got.attributes[i].tangent), expected.tangents[i]));
                if ((got.attributes[i].tangent[3] > 0) != (p.tangents[i].w > 0.0F)) ++other_side;
            }
            const glm::dvec3 at = expected.positions[i];
            if (!glm::all(glm::lessThan(glm::dvec3(box.low) - near, at)) ||
                !glm::all(glm::lessThan(at, glm::dvec3(box.high) + near)))
                ++outside;
        }
    }
    CHECK(worst < near);
    CHECK(worst_normal < 2e-4);
    CHECK(worst_tangent < 2e-4);
    CHECK(other_side == 0);
    CHECK(outside == 0);
}

Eye front(float distance = 9.0F) { return make_eye({0, 0, distance}, {0, 0, 0}, {}); }

SceneLight sun() {
    SceneLight light;
    light.light.direction = glm::vec4(glm::normalize(glm::vec3(-0.3F, -1.0F, -0.2F)), 0.0F);
    light.light.color = glm::vec4(2.5F);
    light.casts_shadow = true;
    return light;
}

assets::Model hand() {
    const char* folder = std::getenv("BOLTWRIGHT_CONTENT");
    REQUIRE(folder != nullptr);
    auto model = assets::read_gltf(std::filesystem::path(folder) / "hands/hand_right.glb");
    REQUIRE(model.has_value());
    return std::move(*model);
}

// Fingers bend by a negative rotation about x at each joint (content/hands/README.md).
assets::ModelPose curled(const assets::Model& model, float angle) {
    assets::ModelPose pose = assets::rest_pose(model);
    for (std::size_t i = 0; i < model.nodes.size(); ++i)
        for (const char* end : {"_proximal", "_intermediate", "_distal"})
            if (model.nodes[i].name.ends_with(end))
                pose[i].rotation = pose[i].rotation * glm::angleAxis(-angle, glm::vec3(1, 0, 0));
    return pose;
}

// Returns the model deformed by a pose, without skins and targets.
assets::Model baked(const assets::Model& model, const Object& object) {
    assets::Model stiff = model;
    for (assets::Primitive& p : stiff.meshes[object.mesh].primitives) {
        const test::Bent bent = test::bent(p, *object.deformation);
        for (std::size_t i = 0; i < bent.positions.size(); ++i) p.positions[i] = glm::vec3(bent.positions[i]);
        for (std::size_t i = 0; i < bent.normals.size(); ++i) p.normals[i] = glm::vec3(bent.normals[i]);
        p.joints.clear();
        p.weights.clear();
        p.targets.clear();
    }
    for (assets::Node& node : stiff.nodes) node.skin = -1;
    return stiff;
}

// Returns the pixels per thousand with a channel that differs by more than `more` of 255; 6 allows for
// rounding.
double different(const Picture& a, const Picture& b, int more = 6) {
    REQUIRE(a.rgba.size() == b.rgba.size());
    int count = 0;
    for (std::size_t i = 0; i < a.rgba.size(); i += 4)
        for (std::size_t c = 0; c < 3; ++c)
            if (std::abs(int{a.rgba[i + c]} - int{b.rgba[i + c]}) > more) {
                ++count;
                break;
            }
    return 4000.0 * count / static_cast<double>(a.rgba.size());
}

}  // namespace

TEST_CASE("Deform: joints and morph targets agree with the double-precision reference in every frame") {
    Random random(11);
    test::Studio studio;
    const assets::Model model = rubber_ball(random);
    const GpuModel gpu_model = studio.upload(model);
    REQUIRE(gpu_model.parts.front().deformable.vertices == model.meshes[0].primitives[0].positions.size());
    for (int round = 0; round < 6; ++round) {
        CAPTURE(round);
        Scene scene;
        for (int k = 0; k <= round; ++k) {  // the buffer grows
            Deformation deformation;
            if (k % 3 != 1)
                for (int j = 0; j < 7; ++j) deformation.joints.push_back(joint(random));
            if (k % 3 != 2) deformation.weights = {number(random), number(random), 2.0F * number(random)};
            Object object;
            object.model = &gpu_model;
            object.deformation = std::make_shared<const Deformation>(deformation);
            scene.objects.push_back(object);
        }
        (void)studio.shoot(scene, front(), {16, 16});
        for (const Object& object : scene.objects) check_bent(studio, model.meshes[0], object, 1e-4);
    }
}

TEST_CASE("Deform: a hand with curled fingers is drawn, lit and shadowed like a mesh modelled in that pose") {
    test::Studio studio;
    const assets::Model model = hand();
    const assets::Model plate = test::plate({});
    const GpuModel gpu_model = studio.upload(model), ground = studio.upload(plate);
    const EnvironmentLight light = studio.light(shading::studio_environment(128));
    const glm::mat4 floor =
        glm::translate(glm::mat4(1.0F), {0, -0.12F, 0}) * glm::scale(glm::mat4(1.0F), glm::vec3(0.3F));
    Scene scene;
    scene.environment = &light;
    scene.lights = {sun()};
    scene.occlusion_radius = 0.02F;
    add_model(scene, plate, ground, floor);
    Scene stiff = scene;
    add_model(scene, model, gpu_model, curled(model, 0.9F));
    REQUIRE(scene.objects.back().deformation != nullptr);
    const Eye eye = make_eye({-0.25F, 0.25F, 0.25F}, {0, -0.03F, -0.05F}, {0.6F, 4.0F / 3.0F, 0.05F, 5.0F});
    const Picture picture = studio.shoot(scene, eye, extent);
    check_bent(studio, model.meshes[scene.objects.back().mesh], scene.objects.back(), 5e-6);

    const assets::Model made = baked(model, scene.objects.back());
    const GpuModel gpu_made = studio.upload(made);
    add_model(stiff, made, gpu_made);
    const Picture expected = studio.shoot(stiff, eye, extent);
    CHECK(different(picture, expected) < 1.0);

    SUBCASE("the hand at rest has another picture") {
        scene.objects.pop_back();
        add_model(scene, model, gpu_model);
        CHECK(different(studio.shoot(scene, eye, extent), expected) > 40.0);
    }
    SUBCASE("a curled ghost equals the modelled ghost") {
        scene.objects.back().opacity = stiff.objects.back().opacity = 0.5F;
        CHECK(different(studio.shoot(scene, eye, extent), studio.shoot(stiff, eye, extent)) < 1.0);
    }
    SUBCASE("the shadow of a moving hand is added to the static shadow map") {
        for (Scene* one : {&scene, &stiff}) one->objects.back().moves = true;
        CHECK(different(studio.shoot(scene, eye, extent), studio.shoot(stiff, eye, extent)) < 1.0);
        scene.objects.back().deformation = std::make_shared<const Deformation>(Deformation{
            assets::joint_matrices(model.skins[0], assets::world_transforms(model, curled(model, 0.1F))),
            {}});
        const Picture open = studio.shoot(scene, eye, extent);
        CHECK_FALSE(studio.renderer().statistics().static_shadow_redrawn);
        scene.objects.back().moves = false;
        (void)studio.shoot(scene, eye, extent);
        test::Studio fresh;
        const GpuModel again = fresh.upload(model), fresh_ground = fresh.upload(plate);
        const EnvironmentLight fresh_light = fresh.light(shading::studio_environment(128));
        scene.environment = &fresh_light;
        scene.objects.front().model = &fresh_ground;
        scene.objects.back().model = &again;
        scene.objects.back().moves = true;
        CHECK(test::largest_difference(fresh.shoot(scene, eye, extent), open) == 0);
    }
    SUBCASE("the shadow of a static hand is redrawn when the pose changes") {
        (void)studio.shoot(scene, eye, extent);
        const Picture before = studio.shoot(scene, eye, extent);
        CHECK_FALSE(studio.renderer().statistics().static_shadow_redrawn);
        Deformation moved = *scene.objects.back().deformation;
        for (glm::mat4& m : moved.joints) m[3].x += 0.02F;
        scene.objects.back().deformation = std::make_shared<const Deformation>(moved);
        CHECK(different(studio.shoot(scene, eye, extent), before) > 20.0);
        CHECK(studio.renderer().statistics().static_shadow_redrawn);
    }
}

TEST_CASE("Deform: levels of detail of a hand follow the pose") {
    test::Studio fine, coarse({.level_error_px = 0.5F});
    const assets::Model model = hand();
    const GpuModel all = fine.upload(model), levels = coarse.upload(model, {true});
    const Eye eye = make_eye({-0.8F, 0.8F, 0.8F}, {0, 0, -0.05F}, {0.25F, 4.0F / 3.0F, 0.05F, 5.0F});
    Scene scene, detailed;
    add_model(detailed, model, all, curled(model, 0.9F));
    add_model(scene, model, levels, curled(model, 0.9F));
    scene.lights = detailed.lights = {sun()};
    const Picture expected = fine.shoot(detailed, eye, extent);
    const Picture picture = coarse.shoot(scene, eye, extent);
    CHECK(coarse.renderer().statistics().triangles < fine.renderer().statistics().triangles / 2);
    CHECK(different(picture, expected, 32) < 4.0);
    add_model(scene, model, levels, assets::rest_pose(model));
    scene.objects.erase(scene.objects.begin());
    CHECK(different(coarse.shoot(scene, eye, extent), expected, 32) > 12.0);
}

TEST_CASE("Deform: a morphed mesh without normals is lit by its deformed triangles") {
    test::Studio studio;
    assets::Model model = test::plate({});
    assets::Primitive& p = model.meshes[0].primitives[0];
    p.normals.clear();
    p.targets.resize(1);
    p.targets[0].positions = {{0, 0, 0}, {0, 1.5F, 0}, {0, 1.5F, 0}, {0, 0, 0}};  // one side lifted
    const GpuModel gpu_model = studio.upload(model);
    Scene scene;
    assets::ModelPose pose = assets::rest_pose(model);
    pose[0].weights = {0.8F};
    add_model(scene, model, gpu_model, pose);
    (void)studio.shoot(scene, front(), {16, 16});
    const glm::dvec3 normal = glm::normalize(glm::cross(glm::dvec3(2, 1.2, 0), glm::dvec3(0, 0, -2)));
    for (const VertexAttributes& a : seen(studio, scene.objects[0], gpu_model.parts[0]).attributes)
        CHECK(glm::distance(unpacked(a.normal), normal) < 1e-4);
}

TEST_CASE("Deform: culling uses the deformed bounds") {
    test::Studio studio;
    Random random(2);
    const assets::Model model = rubber_ball(random);
    const GpuModel gpu_model = studio.upload(model);
    Scene scene;
    Object object;
    object.model = &gpu_model;
    const glm::mat4 far = glm::translate(glm::mat4(1.0F), {40, 0, 0});
    object.deformation = std::make_shared<const Deformation>(Deformation{std::vector<glm::mat4>(7, far), {}});
    scene.objects.push_back(object);
    const Eye here = front();
    CHECK(make_draw_list(scene, {&here, 1}, {}).draws.empty());
    const Eye there = make_eye({40, 0, 9}, {40, 0, 0}, {});
    CHECK(make_draw_list(scene, {&there, 1}, {}).draws.size() == 1);
    const BoundingBox box = bounds(scene);
    CHECK(box.low.x == doctest::Approx(39.0).epsilon(1e-5));
    CHECK(box.high.x == doctest::Approx(41.0).epsilon(1e-5));
    // With joints, targets or both, vertices stay inside the box; where all joints move alike, the box is
    // tight.
    for (int round = 0; round < 50; ++round) {
        Deformation deformation;
        for (int j = 0; j < 7; ++j) deformation.joints.push_back(joint(random));
        deformation.weights = {number(random), number(random), number(random)};
        const MeshPart& part = gpu_model.parts[0];
        const BoundingBox holds = bounds(part.box, part.deformable, &deformation);
        for (const glm::dvec3& at : test::bent(model.meshes[0].primitives[0], deformation).positions) {
            REQUIRE(glm::all(glm::lessThanEqual(glm::dvec3(holds.low) - 1e-4, at)));
            REQUIRE(glm::all(glm::lessThanEqual(at, glm::dvec3(holds.high) + 1e-4)));
        }
    }
}

TEST_CASE("Deform: frames in flight do not overwrite each other's vertices") {
    test::Studio studio;
    Random random(4);
    const assets::Model model = rubber_ball(random);
    const GpuModel gpu_model = studio.upload(model);
    std::vector<Scene> scenes(5);
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        for (std::size_t k = 0; k <= i; ++k) {
            Object object;
            object.model = &gpu_model;
            Deformation deformation{{}, {number(random), 0.0F, number(random)}};
            for (int j = 0; j < 7; ++j)
                deformation.joints.push_back(glm::translate(glm::mat4(1.0F), 0.2F * vector(random)));
            object.deformation = std::make_shared<const Deformation>(deformation);
            scenes[i].objects.push_back(object);
        }
        scenes[i].lights = {sun()};
    }
    const Eye eye = front(6.0F);
    for (const Scene& scene : scenes) {  // without a wait between frames
        auto frame = studio.frames().begin();
        REQUIRE(frame.has_value());
        REQUIRE(studio.renderer().render(**frame, scene, {&eye, 1}, {64, 64}).has_value());
        REQUIRE(studio.frames().submit(**frame).has_value());
    }
    REQUIRE(studio.frames().finish().has_value());
    check_bent(studio, model.meshes[0], scenes.back().objects.back(), 1e-4);
    const Picture last = studio.shoot(scenes.back(), eye, {64, 64});
    (void)studio.shoot(scenes.front(), eye, {64, 64});
    CHECK(test::largest_difference(studio.shoot(scenes.back(), eye, {64, 64}), last) == 0);
}

TEST_CASE("Deform: a deformation with too few joints is an error") {
    test::Studio studio;
    Random random(1);
    const assets::Model model = rubber_ball(random);
    const GpuModel gpu_model = studio.upload(model);
    Scene scene;
    Object object;
    object.model = &gpu_model;
    object.deformation = std::make_shared<const Deformation>(Deformation{{glm::mat4(1.0F)}, {}});
    scene.objects.push_back(object);
    auto frame = studio.frames().begin();
    REQUIRE(frame.has_value());
    const Eye eye = front();
    const Status drawn = studio.renderer().render(**frame, scene, {&eye, 1}, {16, 16});
    REQUIRE_FALSE(drawn.has_value());
    CHECK(drawn.error().what.find("1 joints") != std::string::npos);
    REQUIRE(studio.frames().submit(**frame).has_value());
    REQUIRE(studio.frames().finish().has_value());
}

TEST_CASE("Deform: a ball mirrored by its object, its joint or both looks like the ball") {
    test::Studio studio;
    const assets::Model model = test::sphere({}, 32);
    const GpuModel gpu_model = studio.upload(model);
    const glm::mat4 mirror = glm::scale(glm::mat4(1.0F), {1, 1, -1});
    Scene scene;
    add_model(scene, model, gpu_model);
    scene.lights = {sun()};
    scene.lights[0].casts_shadow = false;
    const Picture plain = studio.shoot(scene, front(5.0F), extent);
    scene.objects[0].world = mirror;
    CHECK(different(studio.shoot(scene, front(5.0F), extent), plain) < 1.0);

    assets::Model skinned = model;
    assets::Primitive& p = skinned.meshes[0].primitives[0];
    p.joints.resize(p.positions.size());
    p.weights.assign(p.positions.size(), {1, 0, 0, 0});
    const GpuModel gpu_skinned = studio.upload(skinned);
    scene.objects[0].model = &gpu_skinned;
    scene.objects[0].deformation = std::make_shared<const Deformation>(Deformation{{mirror}, {}});
    CHECK(different(studio.shoot(scene, front(5.0F), extent), plain) <
          1.0);  // mirrored by the joint and by the object
    scene.objects[0].world = glm::mat4(1.0F);
    CHECK(different(studio.shoot(scene, front(5.0F), extent), plain) < 1.0);
}
