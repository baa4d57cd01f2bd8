#include "tools/verify/pathtrace/options.hpp"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <glm/geometric.hpp>

#include "engine/base/math.hpp"

namespace bolt::pathtrace {

namespace {

// Parses exactly `count` finite numbers with `separator` between them.
Result<std::vector<float>> numbers(const std::string& text, char separator, std::size_t count,
                                   const std::string& option, const std::string& form) {
    std::vector<float> values;
    const char* position = text.data();
    const char* end = text.data() + text.size();
    while (position <= end) {
        float value = 0.0F;
        const auto [after, status] = std::from_chars(position, end, value);
        if (status != std::errc{} || !std::isfinite(value)) break;
        values.push_back(value);
        if (after == end && values.size() == count) return values;
        if (after == end || *after != separator) break;
        position = after + 1;
    }
    return fail(ErrorCode::usage, option + ": '" + text + "' is malformed", form);
}

Result<glm::vec3> triple(const std::string& text, const std::string& option) {
    BOLT_TRY_ASSIGN(const auto values, numbers(text, ',', 3, option, "X,Y,Z"));
    return glm::vec3(values[0], values[1], values[2]);
}

}  // namespace

void declare(CLI::App& app, PathTraceOptions& o) {
    app.add_option("file", o.file, ".glb or .gltf file");
    app.add_option("--png", o.png, "PNG file to write");
    app.add_option("--size", o.size, "WxH in pixels")->default_str("800x600");
    app.add_option("--eye", o.eye, "X,Y,Z of the camera in metres; default: frame the model");
    app.add_option("--target", o.target,
                   "X,Y,Z of the view target in metres; default: the middle of the model");
    app.add_option("--from", o.from, "X,Y,Z: direction from the model to the camera when framing");
    app.add_option("--fov", o.fov_deg, "vertical angle of view in degrees")->capture_default_str();
    app.add_option("--samples", o.settings.samples, "paths per pixel")
        ->capture_default_str()
        ->check(CLI::Range(1, 1 << 20));
    app.add_option("--bounces", o.settings.bounces, "largest number of bounces of a path")
        ->capture_default_str()
        ->check(CLI::Range(0, 64));
    app.add_option("--clamp", o.settings.clamp, "maximum radiance of a path after a bounce; 0: unbiased")
        ->capture_default_str();
    app.add_option("--seed", o.settings.seed, "seed of the random samples")->capture_default_str();
    app.add_option("--threads", o.settings.threads, "threads that render; 0: one per processor")
        ->capture_default_str();
    app.add_option("--env", o.light, "studio, none, or an equirectangular .hdr file")->capture_default_str();
    app.add_option("--background", o.background, "R,G,B radiance behind the model, or env");
    app.add_option("--exposure", o.exposure, "in stops")->capture_default_str();
    app.add_option("--nodes", o.nodes,
                   "show only nodes whose name matches, with their descendants (* and ?)");
    app.add_option("--hide", o.hide, "hide nodes whose name matches, with their descendants");
    app.add_flag("--floor", o.floor, "put a grey floor under the model");
    app.add_flag("--no-lights", o.no_lights, "ignore the lights of the file");
    app.add_option("--write-env", o.write_env, "write the built-in light as .hdr");
}

Status resolve(PathTraceOptions& o) {
    if (o.png.empty() && o.write_env.empty())
        return fail(ErrorCode::usage, "no output file is given", "--png FILE or --write-env FILE");
    if (!o.png.empty() && o.file.empty()) return fail(ErrorCode::usage, "no model is given", "a .glb file");
    if (!o.size.empty()) {
        BOLT_TRY_ASSIGN(const auto size, numbers(o.size, 'x', 2, "--size", "WxH"));
        const auto valid = [](float n) { return n >= 1.0F && n <= 16384.0F && n == std::floor(n); };
        if (!valid(size[0]) || !valid(size[1]))
            return fail(ErrorCode::usage, "--size: '" + o.size + "' is out of range", "1x1 to 16384x16384");
        o.camera.width = static_cast<int>(size[0]);
        o.camera.height = static_cast<int>(size[1]);
    }
    if (!(o.fov_deg > 0.1F && o.fov_deg < 179.0F))
        return fail(ErrorCode::usage, "--fov: is out of range", "0.1 to 179 degrees");
    o.camera.fov = static_cast<float>(to_radians(static_cast<double>(o.fov_deg)));
    o.settings.background = glm::vec3(0.30F, 0.31F, 0.33F);
    if (o.background == "env") {
        o.settings.background.reset();
    } else if (!o.background.empty()) {
        BOLT_TRY_ASSIGN(const auto color, triple(o.background, "--background"));
        o.settings.background = color;
    }
    const std::pair<const std::string*, glm::vec3*> triples[] = {
        {&o.eye, &o.camera.eye}, {&o.target, &o.camera.target}, {&o.from, &o.view}};
    const char* names[] = {"--eye", "--target", "--from"};
    for (std::size_t i = 0; i < 3; ++i) {
        if (triples[i].first->empty()) continue;
        BOLT_TRY_ASSIGN(const auto value, triple(*triples[i].first, names[i]));
        *triples[i].second = value;
    }
    o.has_eye = !o.eye.empty();
    o.has_target = !o.target.empty();
    if (o.has_eye && o.has_target && o.camera.eye == o.camera.target)
        return fail(ErrorCode::usage, "--eye and --target are the same point", "two different points");
    if (glm::length(o.view) == 0.0F)
        return fail(ErrorCode::usage, "--from: is the zero vector", "a direction");
    return {};
}

}  // namespace bolt::pathtrace
