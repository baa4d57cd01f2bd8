// Shader hot reload.
#include "engine/render/hot_shaders.hpp"

#include <doctest/doctest.h>

#include <cstdlib>

#include "engine/base/file.hpp"
#include "tests/render/support.hpp"
#include "tests/support/folder.hpp"

using namespace bolt;
using namespace bolt::render;
namespace fs = std::filesystem;

namespace {

// A copy of the shaders that the test may change.
struct Copy {
    test::Folder root;
    fs::path folder = root / "paths have spaces" / "shaders";

    Copy() {
        const char* content = std::getenv("BOLTWRIGHT_CONTENT");
        REQUIRE(content != nullptr);
        fs::create_directories(folder.parent_path());
        fs::copy(fs::path(content).parent_path() / "shaders", folder);
    }

    [[nodiscard]] std::string read(const std::string& name) const {
        return read_file(folder / name, 1 << 20, ErrorCode::failed).value();
    }
    void replace(const std::string& name, const std::string& what, const std::string& with) const {
        std::string text = read(name);
        REQUIRE(text.find(what) != std::string::npos);
        text.replace(text.find(what), what.size(), with);
        REQUIRE(write_file(folder / name, text).has_value());
    }
};

// Polls twice, one second apart, so that changed files have settled.
std::optional<Result<ShaderCode>> later(HotShaders& hot, double& now) {
    auto code = hot.changed(now += 1.0);
    return code ? std::move(code) : hot.changed(now += 1.0);
}

Picture ball(const ShaderCode& code) {
    RendererOptions options;
    options.shaders = code;
    test::Studio studio(options);
    const assets::Model model = test::sphere({}, 16);
    const GpuModel gpu_model = studio.upload(model);
    const EnvironmentLight light = studio.light(shading::studio_environment(64));
    Scene scene;
    add_model(scene, model, gpu_model);
    scene.environment = &light;
    return studio.shoot(scene, make_eye({0, 0, 5}, {0, 0, 0}, {}), {32, 32});
}

}  // namespace

TEST_CASE("HotShaders: shaders compiled at run time draw the same picture as the built-in ones") {
    const Copy copy;
    HotShaders hot = HotShaders::open(copy.folder).value();
    double now = 0.0;
    const auto code = hot.changed(now);
    REQUIRE(code.has_value());
    REQUIRE_MESSAGE(code->has_value(), code->error().what);
    CHECK((**code).contains("light.frag"));
    CHECK(ball(**code).rgba == ball({}).rgba);
    CHECK_FALSE(later(hot, now).has_value());
}

TEST_CASE(
    "HotShaders: changes are compiled, also in includes; an error is reported, and the last good shaders "
    "stay") {
    const Copy copy;
    HotShaders hot = HotShaders::open(copy.folder).value();
    double now = 0.0;
    const ShaderCode first = hot.changed(now).value().value();
    const std::string good = copy.read("tone.glsl");

    copy.replace("over.frag", "void main() {", "void main() { broken;");
    const auto broken = later(hot, now);
    REQUIRE(broken.has_value());
    REQUIRE_FALSE(broken->has_value());
    CHECK(broken->error().what.find("over.frag") != std::string::npos);
    CHECK(broken->error().what.find("'broken' : undeclared identifier") != std::string::npos);
    CHECK_FALSE(later(hot, now).has_value());  // reported once
    copy.replace("over.frag", "broken;", "");
    const auto mended = later(hot, now);
    REQUIRE(mended.has_value());
    REQUIRE(mended->has_value());

    // A changed include recompiles exactly the shaders that include it.
    const std::string text =
        good + "// the same but for this line\nvec3 unused_by_all() { return vec3(1); }\n";
    REQUIRE(write_file(copy.folder / "tone.glsl", text).has_value());
    const auto same = later(hot, now);
    REQUIRE(same.has_value());
    REQUIRE(same->has_value());
    CHECK((**same).at("shadow.vert") == first.at("shadow.vert"));

    copy.replace("light.frag", "void main() {", "void main() { color_out = vec4(1, 0, 0, 1); return;");
    const auto red = later(hot, now);
    REQUIRE(red.has_value());
    REQUIRE_MESSAGE(red->has_value(), red->error().what);
    CHECK((**red).at("light.frag") != first.at("light.frag"));
    CHECK(test::pixel(ball(**red), 16, 16) == glm::ivec4(255, 0, 0, 255));
}

TEST_CASE("HotShaders: missing, empty and misnamed folders are errors") {
    const Copy copy;
    CHECK(HotShaders::open(copy.root / "nowhere").error().code == ErrorCode::usage);
    CHECK(HotShaders::open(copy.root.path()).error().what.find("not named") != std::string::npos);
    fs::create_directories(copy.root / "empty" / "shaders");
    CHECK(HotShaders::open(copy.root / "empty" / "shaders").error().what.find("none of the renderer's") !=
          std::string::npos);
}
