// bolt-pathtrace: a picture of a glTF file by path tracing.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>

#include "engine/assets/gltf.hpp"
#include "engine/assets/image.hpp"
#include "engine/base/console.hpp"
#include "engine/base/file.hpp"
#include "tools/pathtrace/options.hpp"
#include "tools/pathtrace/render.hpp"
#include "tools/pathtrace/tone.hpp"

namespace {

using namespace bolt;
using namespace bolt::pathtrace;

Result<Environment> light(const Options& options) {
    if (options.light == "none") return Environment();
    if (options.light == "studio") return Environment(studio());
    auto image = read_hdr(options.light);
    if (!image) return fail(image.error());
    return Environment(std::move(*image));
}

Status draw(const Options& options) {
    const auto begin = std::chrono::steady_clock::now();
    if (!options.write_env.empty())
        if (Status written = write_hdr(options.write_env, studio(1024)); !written) return written;
    if (options.png.empty()) return {};
    auto model = assets::read_gltf(options.file);
    if (!model) return fail(model.error());
    if (options.no_lights) model->lights.clear();
    if (options.no_lights)
        for (assets::Node& node : model->nodes) node.light = -1;
    const auto scene = Scene::build(*model, {{options.nodes, options.hide}, options.floor});
    if (!scene) {
        Error error = scene.error();
        error.file = options.file;
        return fail(std::move(error));
    }
    const auto environment = light(options);
    if (!environment) return fail(environment.error());
    Camera camera = options.camera;
    if (!options.has_target) camera.target = 0.5F * (scene->low() + scene->high());
    if (!options.has_eye) camera = frame(camera, scene->low(), scene->high(), options.view);
    const auto image = render(*scene, *environment, camera, options.settings);
    const auto png =
        assets::encode_png(camera.width, camera.height, 3, develop(image, std::exp2(options.exposure)));
    if (!png) return fail(png.error());
    if (Status written = write_file(options.png, *png); !written) return written;
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
    return say(
        fmt::format("{}: {} triangles, eye {:.4f},{:.4f},{:.4f}, target {:.4f},{:.4f},{:.4f}, {:.1f} s\n",
                    options.png, scene->triangle_count(), camera.eye.x, camera.eye.y, camera.eye.z,
                    camera.target.x, camera.target.y, camera.target.z, time.count()));
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Draws a glTF file by path tracing.", "bolt-pathtrace");
    Options options;
    declare(app, options);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        const int code = app.exit(error);
        return code == 0 ? 0 : static_cast<int>(ErrorCode::usage);
    }
    Status done = resolve(options);
    if (done) done = draw(options);
    return done ? 0 : complain(done.error());
}
