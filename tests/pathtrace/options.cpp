// Tests of the path tracer's options and of unusable input files.
#include "tools/verify/pathtrace/options.hpp"

#include <doctest/doctest.h>

#include "tests/pathtrace/about.hpp"
#include "tests/pathtrace/shapes.hpp"
#include "tests/support/folder.hpp"
#include "tools/verify/pathtrace/environment.hpp"

using namespace bolt;
using namespace bolt::pathtrace;

namespace {

PathTraceOptions valid_options() {
    PathTraceOptions options;
    options.file = "a.glb";
    options.png = "a.png";
    return options;
}

bool is_usage_error(const PathTraceOptions& options) {
    PathTraceOptions copy = options;
    const Status done = resolve(copy);
    return !done && done.error().code == ErrorCode::usage;
}

}  // namespace

TEST_CASE("Path tracer options: size, eye, target, fov and background set the camera and the background") {
    PathTraceOptions o = valid_options();
    o.size = "320x200";
    o.eye = "1,-2.5,3e-1";
    o.target = "0,0,0";
    o.fov_deg = 90.0F;
    o.background = "0.1,0.2,0.3";
    REQUIRE(resolve(o));
    CHECK(o.camera.width == 320);
    CHECK(o.camera.height == 200);
    CHECK(o.camera.eye == glm::vec3(1.0F, -2.5F, 0.3F));
    CHECK(o.camera.fov == about(1.5707963F));
    CHECK(o.has_eye);
    CHECK(o.settings.background == glm::vec3(0.1F, 0.2F, 0.3F));
    o.background = "env";
    REQUIRE(resolve(o));
    CHECK_FALSE(o.settings.background.has_value());
}

TEST_CASE("Path tracer options: invalid values are usage errors") {
    PathTraceOptions o = valid_options();
    CHECK_FALSE(is_usage_error(o));
    for (const char* size :
         {"800", "800x", "x600", "0x600", "800x600x2", "8.5x6", "-1x5", "99999x1", "axb"}) {
        o = valid_options();
        o.size = size;
        CAPTURE(size);
        CHECK(is_usage_error(o));
    }
    for (const char* point : {"1,2", "1,2,3,4", "1,,3", "nan,0,0", "1 2 3", ","}) {
        o = valid_options();
        o.eye = point;
        CAPTURE(point);
        CHECK(is_usage_error(o));
    }
    o = valid_options();
    o.eye = o.target = "1,2,3";
    CHECK(is_usage_error(o));
    o = valid_options();
    o.fov_deg = 180.0F;
    CHECK(is_usage_error(o));
    o = valid_options();
    o.view = glm::vec3(1.0F);
    o.from = "0,0,0";
    CHECK(is_usage_error(o));
    o = valid_options();
    o.png.clear();
    CHECK(is_usage_error(o));
    o = valid_options();
    o.file.clear();
    CHECK(is_usage_error(o));
}

TEST_CASE("Environment: an image written to .hdr and read back is equal within 1 %") {
    const test::Folder folder;
    const auto path = folder / "light.hdr";
    const RadianceImage image = studio_environment(32);
    REQUIRE(write_hdr(path, image));
    const auto read = read_hdr(path);
    REQUIRE_MESSAGE(read, read.error().message());
    CHECK(read->width == 32);
    CHECK(read->height == 16);
    REQUIRE(read->pixels.size() == image.pixels.size());
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        CHECK(read->pixels[i].g == about(image.pixels[i].g).epsilon(0.01));
    std::filesystem::remove(path);
    CHECK(read_hdr(path).error().file == path.string());
}

TEST_CASE("Path tracer: a scene without triangles is an error") {
    assets::Model model = single(square(), matte(glm::vec3(1.0F)));
    model.meshes[0].primitives[0].topology = assets::Topology::points;
    CHECK_FALSE(TracedScene::build(model, {}));
    CHECK_FALSE(TracedScene::build(single(square(), {}), {.nodes = {.show = {"nothing"}, .hide = {}}}));
}
