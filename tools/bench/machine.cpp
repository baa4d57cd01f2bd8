#include "tools/bench/machine.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numbers>

#include "engine/base/random.hpp"

namespace bolt::bench {

namespace {

constexpr float full_turn = 2.0F * std::numbers::pi_v<float>;

// The profile of a turned part, from the axis at the bottom to the axis at the top (m). Each pair of points
// spans a band of the surface with a sharp edge at either end.
struct ProfilePoint {
    float radius = 0.0F, height = 0.0F;
};
using TurnedProfile = std::vector<ProfilePoint>;

// The factor of the radius at an angle (rad); 1 everywhere is a circle.
using CrossSection = std::function<float(float angle)>;

float round_section(float) { return 1.0F; }

// Teeth with straight flanks.
CrossSection toothed_section(int teeth) {
    return [teeth](float angle) {
        const float phase = angle / full_turn * static_cast<float>(teeth);
        const float saw = std::abs(2.0F * (phase - std::floor(phase)) - 1.0F);
        return 1.0F + 0.08F * std::clamp(4.0F * saw - 2.0F, -1.0F, 1.0F);
    };
}

// A regular polygon with slightly rounded corners; four sides make a housing, six a bolt.
CrossSection polygon_section(int sides) {
    return [sides](float angle) {
        const float sector = full_turn / static_cast<float>(sides);
        const float within = std::fmod(angle, sector) - 0.5F * sector;
        return std::min(1.0F / std::cos(within), 0.97F / std::cos(0.5F * sector)) * std::cos(0.5F * sector);
    };
}

void add_band(assets::Primitive& to, const ProfilePoint& from, const ProfilePoint& until,
              const CrossSection& section, int rows, int around) {
    const auto first = static_cast<std::uint32_t>(to.positions.size());
    const auto at = [&](float along, float angle) {
        const float radius = std::lerp(from.radius, until.radius, along) * section(angle);
        return glm::vec3(radius * std::sin(angle), std::lerp(from.height, until.height, along),
                         radius * std::cos(angle));
    };
    for (int i = 0; i <= rows; ++i) {
        const float along = static_cast<float>(i) / static_cast<float>(rows);
        for (int j = 0; j <= around; ++j) {
            const float angle = full_turn * static_cast<float>(j) / static_cast<float>(around);
            const float step = 0.25F * full_turn / static_cast<float>(around);
            // Tangents across the band and around it, taken in its middle so that a band that ends on the
            // axis has normals there.
            const glm::vec3 across = at(1.0F, angle) - at(0.0F, angle);
            const glm::vec3 aside = at(0.5F, angle + step) - at(0.5F, angle - step);
            to.positions.push_back(at(along, angle));
            to.normals.push_back(glm::normalize(glm::cross(aside, across)));
        }
    }
    const auto row = static_cast<std::uint32_t>(around) + 1;
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(rows); ++i) {
        for (std::uint32_t j = 0; j + 1 < row; ++j) {
            const std::uint32_t a = first + i * row + j, b = a + row;
            for (const std::uint32_t index : {a, a + 1, b, b, a + 1, b + 1}) to.indices.push_back(index);
        }
    }
}

// Returns a part with about `triangles` triangles, with the same number of rows in each band.
assets::Primitive make_turned_part(const TurnedProfile& profile, const CrossSection& section, int triangles) {
    assets::Primitive part;
    const auto bands = static_cast<int>(profile.size()) - 1;
    const int rows_in_all = std::max(bands, static_cast<int>(std::lround(std::sqrt(triangles / 6.0))));
    const int around = std::max(6, static_cast<int>(std::lround(triangles / (2.0 * rows_in_all))));
    int left = rows_in_all;
    for (int i = 0; i < bands; ++i) {
        const int rows = i + 1 < bands ? rows_in_all / bands : left;
        left -= rows;
        add_band(part, profile[static_cast<std::size_t>(i)], profile[static_cast<std::size_t>(i) + 1],
                 section, rows, around);
    }
    return part;
}

struct TurnedPartMesh {
    TurnedProfile profile;
    CrossSection section;
    int material = 0;
    bool lying = false;  // its axis is along x
};

enum : int { grey_paint, blue_paint, ground_steel, black_steel, zinc, brass, rubber };

std::vector<assets::Material> materials() {
    const auto make = [](const char* name, const glm::vec3& color, float metallic, float roughness,
                         float coat) {
        assets::Material m;
        m.name = name;
        m.base_color = glm::vec4(color, 1.0F);
        m.metallic = metallic;
        m.roughness = roughness;
        m.clearcoat = coat;
        m.clearcoat_roughness = 0.15F;
        return m;
    };
    return {make("grey paint", {0.33F, 0.37F, 0.38F}, 0.0F, 0.5F, 0.6F),
            make("blue paint", {0.05F, 0.16F, 0.35F}, 0.0F, 0.5F, 0.6F),
            make("ground steel", {0.56F, 0.56F, 0.55F}, 1.0F, 0.28F, 0.0F),
            make("black steel", {0.09F, 0.09F, 0.1F}, 1.0F, 0.5F, 0.0F),
            make("zinc", {0.66F, 0.67F, 0.66F}, 1.0F, 0.35F, 0.0F),
            make("brass", {0.85F, 0.68F, 0.35F}, 1.0F, 0.3F, 0.0F),
            make("rubber", {0.03F, 0.03F, 0.03F}, 0.0F, 0.85F, 0.0F)};
}

TurnedPartMesh pick_shape(int index, Random& random) {
    const auto size = [&](double low, double high) { return static_cast<float>(random.uniform(low, high)); };
    const float r = size(0.04, 0.09), h = size(0.05, 0.14);
    switch (index % 5) {
        case 0:  // housing
            return {{{0, 0}, {1.4F * r, 0}, {1.4F * r, h}, {1.1F * r, 1.3F * h}, {0, 1.3F * h}},
                    polygon_section(4),
                    index % 10 == 0 ? grey_paint : blue_paint,
                    false};
        case 1:  // stepped shaft
            return {{{0, 0},
                     {0.25F * r, 0},
                     {0.25F * r, h},
                     {0.4F * r, h},
                     {0.4F * r, 2 * h},
                     {0.2F * r, 2 * h},
                     {0.2F * r, 3 * h},
                     {0, 3 * h}},
                    round_section,
                    ground_steel,
                    true};
        case 2:  // gear
            return {{{0, 0}, {r, 0}, {r, 0.35F * h}, {0, 0.35F * h}},
                    toothed_section(18 + index % 13),
                    index % 2 == 0 ? black_steel : brass,
                    true};
        case 3:  // flange with a hub
            return {
                {{0, 0}, {r, 0}, {r, 0.2F * h}, {0.5F * r, 0.25F * h}, {0.45F * r, 0.7F * h}, {0, 0.7F * h}},
                round_section,
                index % 2 == 0 ? zinc : rubber,
                false};
        default:  // bolt
            return {{{0, 0}, {0.3F * r, 0}, {0.3F * r, 0.2F * h}, {0.26F * r, 0.24F * h}, {0, 0.24F * h}},
                    polygon_section(6),
                    zinc,
                    false};
    }
}

}  // namespace

assets::Model make_machine(const MachineSize& size) {
    Random random(115);
    assets::Model model;
    model.generator = "bolt-bench";
    model.materials = materials();
    const int columns = std::max(1, static_cast<int>(std::lround(std::sqrt(size.parts * 1.5))));
    int left = size.triangles;
    for (int i = 0; i < size.parts; ++i) {
        const TurnedPartMesh shape = pick_shape(i, random);
        assets::Primitive part = make_turned_part(shape.profile, shape.section, left / (size.parts - i));
        left -= static_cast<int>(part.indices.size() / 3);
        part.material = shape.material;
        model.meshes.push_back({"part " + std::to_string(i), {std::move(part)}, {}});
        assets::Node node;
        node.name = model.meshes.back().name;
        node.mesh = i;
        const float pitch = 1.2F / static_cast<float>(columns);
        node.translation = {
            pitch * (static_cast<float>(i % columns) - 0.5F * static_cast<float>(columns - 1)),
            static_cast<float>(random.uniform(0.0, 0.35)),
            pitch * (static_cast<float>(i / columns) - static_cast<float>(columns) / 3.0F)};
        const float angle = static_cast<float>(random.uniform(0.0, 6.28));
        node.rotation = glm::angleAxis(angle, glm::vec3(0, 1, 0));
        if (shape.lying)
            node.rotation = node.rotation * glm::angleAxis(-0.25F * full_turn, glm::vec3(0, 0, 1));
        model.nodes.push_back(std::move(node));
        model.roots.push_back(i);
    }
    return model;
}

}  // namespace bolt::bench
