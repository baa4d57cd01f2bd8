// bolt-pathtrace: renders an image of a glTF file by path tracing.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>

#include "engine/assets/gltf.hpp"
#include "engine/assets/image.hpp"
#include "engine/base/file.hpp"
#include "engine/base/result.hpp"
#include "tools/verify/pathtrace/camera.hpp"
#include "tools/verify/pathtrace/options.hpp"
#include "tools/verify/pathtrace/render.hpp"

namespace {

using namespace bolt;
using namespace bolt::pathtrace;

Result<Environment> light(const PathTraceOptions& options) {
    if (options.light == "none") return Environment();
    if (options.light == "studio") return Environment(studio_environment());
    BOLT_TRY_ASSIGN(auto image, read_hdr(options.light));
    return Environment(std::move(image));
}

Status draw(const PathTraceOptions& options) {
    const auto begin = std::chrono::steady_clock::now();
    if (!options.write_env.empty()) BOLT_TRY(write_hdr(options.write_env, studio_environment(1024)));
    if (options.png.empty()) return {};
    BOLT_TRY_ASSIGN(auto model, assets::read_gltf(options.file));
    if (options.no_lights) model.lights.clear();
    if (options.no_lights)
        for (assets::Node& node : model.nodes) node.light = -1;
    const auto scene = TracedScene::build(model, {{options.nodes, options.hide}, options.floor});
    if (!scene) {
        Error error = scene.error();
        error.file = options.file;
        return fail(std::move(error));
    }
    BOLT_TRY_ASSIGN(const auto environment, light(options));
    PinholeCamera camera = options.camera;
    if (!options.has_target) camera.target = 0.5F * (scene->low() + scene->high());
    if (!options.has_eye) camera = frame_box(camera, scene->low(), scene->high(), options.view);
    const auto image = render(*scene, environment, camera, options.settings);
    BOLT_TRY_ASSIGN(const auto png, assets::encode_png(camera.width, camera.height, 3,
                                                       to_srgb8(image, std::exp2(options.exposure))));
    BOLT_TRY(write_file(options.png, png));
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
    return print(
        fmt::format("{}: {} triangles, eye {:.4f},{:.4f},{:.4f}, target {:.4f},{:.4f},{:.4f}, {:.1f} s\n",
                    options.png, scene->triangle_count(), camera.eye.x, camera.eye.y, camera.eye.z,
                    camera.target.x, camera.target.y, camera.target.z, time.count()));
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Renders a glTF file by path tracing.", "bolt-pathtrace");
    PathTraceOptions options;
    declare(app, options);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        const int code = app.exit(error);
        return code == 0 ? 0 : static_cast<int>(ErrorCode::usage);
    }
    Status done = resolve(options);
    if (done) done = draw(options);
    return done ? 0 : print_error(done.error());
}
