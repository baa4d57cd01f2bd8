// Messages, scenes and panels that the processes of projection walls send each other arrive as they were.
#include <doctest/doctest.h>

#include "engine/base/random.hpp"
#include "game/view/panel_stream.hpp"
#include "game/view/scene_stream.hpp"

using namespace bolt;

namespace {

// Two models without GPU objects: the first has a rigid mesh, the second one with three joints.
struct TwoModels {
    render::GpuModel rigid, skinned;
    render::EnvironmentLight light;
    view::StreamedModels streamed;

    TwoModels() {
        rigid.parts.resize(1);
        rigid.meshes = {{0, 1}, {0, 1}};
        skinned.parts.resize(1);
        skinned.parts[0].deformable.joint_boxes.resize(3);
        skinned.meshes = {{0, 1}};
        streamed = {{&rigid, &skinned}, &light};
    }
};

glm::mat4 random_transform(Random& random) {
    glm::mat4 m(1.0F);
    for (glm::length_t column = 0; column < 4; ++column)
        for (glm::length_t row = 0; row < 3; ++row)
            m[column][row] = static_cast<float>(random.uniform(-2.0, 2.0));
    return m;
}

render::Scene first_scene(const TwoModels& models, Random& random) {
    render::Scene scene;
    scene.environment = &models.light;
    scene.background = {0.1F, 0.2F, 0.3F, 1.0F};
    scene.cut_away = {{0.1F, 0.2F, 0.3F}, 0.04F, 0.5F};
    scene.lights.resize(2);
    scene.lights[1].casts_shadow = true;
    scene.lights[1].light.color = {1.0F, 0.5F, 0.25F, 0.0F};
    for (std::uint32_t i = 0; i < 40; ++i) {
        render::Object object;
        object.model = i % 5 == 4 ? &models.skinned : &models.rigid;
        object.mesh = i % 5 == 3 ? 1 : 0;
        object.world = random_transform(random);
        object.moves = i % 2 == 0;
        if (object.model == &models.skinned)
            object.deformation = std::make_shared<render::Deformation>(render::Deformation{
                {random_transform(random), random_transform(random), random_transform(random)}, {0.5F}});
        scene.objects.push_back(object);
    }
    for (const char* text : {"B1", "B2", "Gehäuse"})
        scene.labels.push_back({.text = text, .position = {1, 2, 3}});
    return scene;
}

void change(render::Scene& scene, Random& random) {
    scene.exposure = static_cast<float>(random.uniform(0.5, 2.0));
    render::Object& nut = scene.objects[7];
    nut.world = random_transform(random);
    scene.objects[3].tint = {1.0F, 0.0F, 0.0F, 0.5F};
    scene.objects[5].outline = {0.0F, 1.0F, 0.0F, static_cast<float>(random.uniform(0.1, 1.0))};
    scene.objects[9].deformation = std::make_shared<render::Deformation>(
        render::Deformation{{random_transform(random), glm::mat4(1.0F), random_transform(random)}, {}});
    scene.labels[1].text += "!";
}

void check_equal(const render::Scene& a, const render::Scene& b) {
    CHECK(a.exposure == b.exposure);
    CHECK(a.background == b.background);
    CHECK(a.environment == b.environment);
    CHECK(a.cut_away.focus == b.cut_away.focus);
    CHECK(a.cut_away.strength == b.cut_away.strength);
    REQUIRE(a.lights.size() == b.lights.size());
    for (std::size_t i = 0; i < a.lights.size(); ++i) {
        CHECK(a.lights[i].casts_shadow == b.lights[i].casts_shadow);
        CHECK(a.lights[i].light.color == b.lights[i].light.color);
    }
    CHECK(a.labels == b.labels);
    REQUIRE(a.objects.size() == b.objects.size());
    for (std::size_t i = 0; i < a.objects.size(); ++i) {
        const render::Object &x = a.objects[i], &y = b.objects[i];
        CHECK(x.model == y.model);
        CHECK(x.mesh == y.mesh);
        CHECK(x.world == y.world);
        CHECK(x.moves == y.moves);
        CHECK(x.tint == y.tint);
        CHECK(x.outline == y.outline);
        REQUIRE((x.deformation == nullptr) == (y.deformation == nullptr));
        if (!x.deformation) continue;
        CHECK(x.deformation->joints == y.deformation->joints);
        CHECK(x.deformation->weights == y.deformation->weights);
    }
}

}  // namespace

TEST_CASE("Message: values are read as they were written, and none that was not") {
    cluster::MessageWriter writer;
    writer.put(std::uint16_t{513});
    writer.put(true);
    writer.put(glm::dvec3(1.0, -2.0, 0.1));
    writer.put_text("Schraube");
    writer.put_all(std::span<const float>(std::vector<float>{1.5F, 2.5F}));
    cluster::MessageReader reader(writer.message());
    CHECK(reader.get<std::uint16_t>() == 513);
    CHECK(reader.get<bool>());
    CHECK(reader.get<glm::dvec3>() == glm::dvec3(1.0, -2.0, 0.1));
    CHECK(reader.get_text() == "Schraube");
    CHECK(reader.get_all<float>() == std::vector<float>{1.5F, 2.5F});
    CHECK(reader.ok());
    CHECK(reader.size() == 0);
    CHECK(reader.get<std::uint8_t>() == 0);
    CHECK(!reader.ok());
    // A length beyond the message takes no memory.
    cluster::MessageWriter lies;
    lies.put(std::uint32_t{0xFFFFFFFF});
    cluster::MessageReader misled(lies.message());
    CHECK(misled.get_all<double>().empty());
    CHECK(!misled.ok());
}

TEST_CASE("SceneStream: the received scene equals the sent one, frame by frame, to the bit") {
    Random random(4);
    const TwoModels models;
    view::SceneSender sender;
    render::Scene scene = first_scene(models, random), received;
    for (int frame = 0; frame < 30; ++frame) {
        if (frame > 0) change(scene, random);
        if (frame == 10) scene.objects.erase(scene.objects.begin() + 2);
        if (frame == 12) scene.objects.push_back(scene.objects.front());
        if (frame == 14) scene.labels.pop_back();
        if (frame == 20) sender.restart();
        cluster::MessageWriter message;
        sender.write(message, scene, models.streamed);
        cluster::MessageReader reader(message.message());
        REQUIRE(view::read_scene(reader, models.streamed, received));
        CHECK(reader.size() == 0);
        check_equal(scene, received);
    }
}

TEST_CASE("SceneStream: a part that rests takes no bytes, a part that moves fewer than 64") {
    Random random(5);
    const TwoModels models;
    view::SceneSender sender;
    render::Scene scene = first_scene(models, random);
    const auto bytes = [&] {
        cluster::MessageWriter message;
        sender.write(message, scene, models.streamed);
        return message.size();
    };
    const std::size_t whole = bytes(), resting = bytes();
    CHECK(whole > 40 * 48);
    scene.objects[7].world = random_transform(random);
    CHECK(bytes() < resting + 64);
    CHECK(bytes() == resting);
    for (int i = 0; i < 40; ++i) scene.objects.push_back(scene.objects.front());
    (void)bytes();
    CHECK(bytes() == resting);
}

TEST_CASE("SceneStream: objects of other models and panels are left out") {
    Random random(6);
    const TwoModels models;
    const render::GpuModel other;
    render::Scene scene = first_scene(models, random), received;
    const std::size_t count = scene.objects.size();
    scene.objects.insert(scene.objects.begin(), render::Object{.model = &other});
    scene.panels.resize(1);
    view::SceneSender sender;
    cluster::MessageWriter message;
    sender.write(message, scene, models.streamed);
    cluster::MessageReader reader(message.message());
    REQUIRE(view::read_scene(reader, models.streamed, received));
    CHECK(received.objects.size() == count);
    CHECK(received.panels.empty());
}

TEST_CASE("SceneStream: a damaged message is refused or gives a scene that can be drawn") {
    Random random(7);
    const TwoModels models;
    render::Scene scene = first_scene(models, random);
    view::SceneSender sender;
    cluster::MessageWriter message;
    sender.write(message, scene, models.streamed);
    int refused = 0;
    for (int i = 0; i < 2000; ++i) {
        cluster::Message damaged = message.message();
        const auto position = [&] {
            return static_cast<std::size_t>(random.uniform(0.0, 1.0) *
                                            static_cast<double>(damaged.size() - 1));
        };
        if (i % 3 == 0) damaged.resize(position());
        for (int flips = i % 3; flips > 0; --flips)
            damaged[position()] = static_cast<std::byte>(random.uniform(0.0, 255.0));
        cluster::MessageReader reader(damaged);
        render::Scene received;
        if (!view::read_scene(reader, models.streamed, received)) {
            ++refused;
            CHECK(received.objects.empty());
            continue;
        }
        for (const render::Object& object : received.objects) {
            REQUIRE(object.model != nullptr);
            CHECK(object.mesh < object.model->meshes.size());
            if (object.model == &models.skinned && object.deformation)
                CHECK(object.deformation->joints.size() >= 3);
        }
    }
    CHECK(refused > 700);
    // Joints that are missing would be read beyond the end.
    scene.objects[4].deformation =
        std::make_shared<render::Deformation>(render::Deformation{{glm::mat4(1.0F)}, {}});
    cluster::MessageWriter few;
    sender.restart();
    sender.write(few, scene, models.streamed);
    cluster::MessageReader reader(few.message());
    render::Scene received;
    CHECK(!view::read_scene(reader, models.streamed, received));
}

TEST_CASE("PanelStream: only changed tiles are sent, and arrive as they were, at the panel's edges too") {
    const VkExtent2D extent{150, 100};  // 3 x 2 tiles, of which those at the edges are smaller
    std::vector<std::byte> before(150 * 100 * 4), now;
    Random random(8);
    for (std::byte& byte : before) byte = static_cast<std::byte>(random.uniform(0.0, 255.0));
    CHECK(view::changed_tiles(before, {}, extent).size() == 6);
    CHECK(view::changed_tiles(before, before, extent).empty());
    now = before;
    now[(99 * 150 + 149) * 4] ^= std::byte{1};
    const std::vector<view::PanelTile> tiles = view::changed_tiles(now, before, extent);
    REQUIRE(tiles.size() == 1);
    CHECK(tiles[0].column == 2);
    CHECK(tiles[0].row == 1);
    CHECK(tiles[0].texels.size() == 22 * 36 * 4);
    cluster::MessageWriter message;
    view::put_tiles(message, tiles);
    cluster::MessageReader reader(message.message());
    const auto received = view::get_tiles(reader, extent);
    REQUIRE(received);
    REQUIRE(received->size() == 1);
    CHECK(received->front().texels == tiles[0].texels);
    // In a smaller panel there is no such tile.
    cluster::MessageReader again(message.message());
    CHECK(!view::get_tiles(again, {128, 64}));
    cluster::MessageReader cut(std::span(message.message()).first(message.size() / 2));
    CHECK(!view::get_tiles(cut, extent));
}
