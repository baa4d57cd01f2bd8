// Tests of Radiance files and of the workshop's light.
#include "tools/assets/sculpt/environment.hpp"

#include <doctest/doctest.h>

#include "engine/base/random.hpp"

namespace sculpt_environment_test {

using namespace bolt;
using namespace bolt::sculpt;

TEST_CASE("Radiance files: an image is read back within one step of its mantissa") {
    Panorama picture;
    picture.width = 64;
    picture.height = 32;
    Random random(5);
    for (int i = 0; i < 64 * 32; ++i) {
        const float base = static_cast<float>(std::exp(random.uniform(-8, 8)));
        const bool flat = i % 64 > 20 && i % 64 < 50;  // runs
        picture.pixels.emplace_back(flat ? 0.25F : base, flat ? 0.5F : 0.3F * base, flat ? 1.5F : 0.0F);
    }
    const Result<Panorama> back = assets::decode_hdr(assets::encode_hdr(picture), "workshop.hdr");
    REQUIRE(back.has_value());
    REQUIRE(back->pixels.size() == picture.pixels.size());
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const glm::vec3& was = picture.pixels[i];
        const float top = std::max({was.x, was.y, was.z});
        for (int k = 0; k < 3; ++k) CHECK(std::abs(back->pixels[i][k] - was[k]) <= top / 128.0F);
    }
}

TEST_CASE("Radiance files: a file without a complete header is an error") {
    const Panorama picture{16, 8, std::vector<glm::vec3>(128, glm::vec3(0.5F))};
    const std::string bytes = assets::encode_hdr(picture);
    CHECK(assets::decode_hdr(bytes, "light.hdr").has_value());
    const std::size_t header = bytes.find("+X 16\n");
    for (std::size_t length = 0; length < header; ++length)
        CHECK_FALSE(assets::decode_hdr(bytes.substr(0, length), "light.hdr").has_value());
}

TEST_CASE(
    "Workshop light: has strip lights above, windows on the left, a warm wall on the right and a dark "
    "floor") {
    const auto sum = [](const Vec3& c) { return c.x + c.y + c.z; };
    CHECK(sum(workshop_radiance(glm::normalize(Vec3(-0.2, 1.75, 0.4)))) > 40.0);
    CHECK(sum(workshop_radiance(glm::normalize(Vec3(0, -1.05, 2.0)))) < 0.5);
    CHECK(sum(workshop_radiance(Vec3(0, -1, 0))) > 0.5);
    const Vec3 cool = workshop_radiance(glm::normalize(Vec3(-3.8, 0.8, 1.2)));
    const Vec3 warm = workshop_radiance(glm::normalize(Vec3(3.8, 0.6, 0.85)));
    CHECK(cool.z > 1.2 * cool.x);
    CHECK(warm.x > 1.5 * warm.z);
    for (const Vec3& direction : {Vec3(0, 0, -1), Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 1, 0)}) {
        const Vec3 light = workshop_radiance(direction);
        CHECK(std::min({light.x, light.y, light.z}) > 0.0);
    }
}

}  // namespace sculpt_environment_test
