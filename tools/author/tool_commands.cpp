// The subcommands tool (the model of a tool from its parameters) and tools (kinds, sizes and test torques).
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/assets/gltf.hpp"
#include "engine/assets/image.hpp"
#include "engine/base/file.hpp"
#include "engine/base/result.hpp"
#include "engine/render/renderer.hpp"
#include "game/tool_models/tool_model.hpp"
#include "game/view/gpu_context.hpp"
#include "game/view/pictures.hpp"
#include "game/view/shown_model.hpp"
#include "tools/author/commands.hpp"

namespace bolt::author {

namespace {

namespace fs = std::filesystem;

struct ToolCommandOptions {
    std::string kind, head, out, picture_size = "640x400";
    double size_mm = 0.0, length_mm = 0.0, drive_mm = 0.0;
    double adaptor_mm = 0.0, extension_mm = 0.0;
    int teeth = 0;
    bool no_picture = false;
};

// The nearest viewpoint above and in front of the model from which every vertex is in the picture.
view::Viewpoint close_viewpoint(const assets::Model& model, float aspect) {
    constexpr float filled = 0.92F;  // of the picture
    const std::vector<glm::mat4> worlds = assets::world_transforms(model);
    std::vector<glm::vec3> points;
    glm::vec3 low(1e9F), high(-1e9F);
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        if (model.nodes[i].mesh < 0) continue;
        for (const auto& primitive : model.meshes[static_cast<std::size_t>(model.nodes[i].mesh)].primitives)
            for (const glm::vec3& p : primitive.positions) {
                points.emplace_back(worlds[i] * glm::vec4(p, 1.0F));
                low = glm::min(low, points.back());
                high = glm::max(high, points.back());
            }
    }
    view::Viewpoint view;
    view.target = 0.5F * (low + high);
    view.fov = view::default_fov;
    const glm::vec3 back = glm::normalize(glm::vec3(0.3F, 0.75F, 1.0F));
    const glm::vec3 right = glm::normalize(glm::cross(glm::vec3(0.0F, 1.0F, 0.0F), back));
    const glm::vec3 up = glm::cross(back, right);
    const float half = filled * std::tan(0.5F * view.fov);
    float distance = 0.0F;
    for (const glm::vec3& p : points) {
        const glm::vec3 d = p - view.target;
        const float needed =
            std::max(std::abs(glm::dot(d, up)) / half, std::abs(glm::dot(d, right)) / (half * aspect));
        distance = std::max(distance, needed + glm::dot(d, back));
    }
    view.eye = view.target + distance * back;
    return view;
}

// Draws the model with its Z axis upwards and returns the bytes of a PNG file.
Result<std::string> draw_tool(assets::Model model, VkExtent2D size) {
    view::LoadedModel loaded;
    model.nodes.front().rotation = glm::angleAxis(static_cast<float>(-0.5 * pi), glm::vec3(1.0F, 0.0F, 0.0F));
    loaded.model = std::move(model);
    loaded.without_assembly = true;
    BOLT_TRY_ASSIGN(const auto radiance, view::load_light("studio"));
    BOLT_TRY_ASSIGN(auto instance, gpu::Instance::create({}));
    BOLT_TRY_ASSIGN(auto gpu_context, view::make_gpu_context(instance, {}));
    BOLT_TRY_ASSIGN(auto light, render::upload_environment(*gpu_context.device, radiance));
    BOLT_TRY_ASSIGN(const auto shown, view::show_model(*gpu_context.device, loaded, light));
    const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
    const view::Viewpoint view = close_viewpoint(loaded.model, aspect);
    const render::Eye eye = render::make_eye(
        view.eye, view.target, view::perspective_for(shown->box, view.eye, view.target, view.fov, aspect));
    BOLT_TRY_ASSIGN(const auto pictures,
                    render::take_pictures(*gpu_context.device, *gpu_context.frames, *gpu_context.renderer,
                                          shown->scene, {&eye, 1}, size));
    (void)gpu_context.renderer->save_pipelines();  // a failure only slows down the next start
    return assets::encode_png(static_cast<int>(size.width), static_cast<int>(size.height), 4,
                              pictures.front().rgba);
}

std::size_t triangles_of(const assets::Model& model) {
    std::size_t count = 0;
    for (const assets::Mesh& mesh : model.meshes)
        for (const assets::Primitive& primitive : mesh.primitives) count += primitive.indices.size() / 3;
    return count;
}

// Writes all files. After a failure none of them remains, except files that were there before.
Status write_all(const std::vector<std::pair<fs::path, std::string>>& files) {
    std::vector<fs::path> made;
    for (const auto& [file, bytes] : files) {
        std::error_code ignored;
        const bool existed = fs::exists(file, ignored);
        if (const Status written = write_file(file, bytes); !written) {
            for (const fs::path& other : made) fs::remove(other, ignored);
            return fail(written.error());
        }
        if (!existed) made.push_back(file);
    }
    return {};
}

std::string torque_text(const tool_models::TestTorque& torque) {
    using tool_models::TorqueSource;
    const char* mark = torque.source == TorqueSource::tabulated      ? ""
                       : torque.source == TorqueSource::interpolated ? "~"
                                                                     : "?";
    if (torque.source == TorqueSource::none) return "-";
    return fmt::format("{}{:.3g}", mark, torque.torque);
}

// The line on what the tool bears: its test torque, or that of its square drive if the drive bears less, and
// the torque at which a key or a bit bends. Empty if neither is known.
std::string strength_line(const tool_models::ToolParameters& tool) {
    using tool_models::ModelHead;
    using tool_models::ModelKind;
    const tool_models::ToolStrength strength = tool_models::strength_of(tool);
    std::string text;
    if (strength.of_drive)
        text = fmt::format("test torque {} N·m, of its square drive of {:g} mm\n",
                           torque_text(strength.limit), strength.drive / mm);
    else if (strength.limit.source != tool_models::TorqueSource::none)
        text = fmt::format("test torque {} N·m\n", torque_text(strength.limit));
    const bool has_bit = tool_models::has_ratchet(tool) && tool.head == ModelHead::hex_bit;
    if (has_bit || tool.kind == ModelKind::hex_bit || tool.kind == ModelKind::hex_key)
        text += fmt::format("begins to bend at {:.3g} N·m (torsion of its hexagon)\n",
                            tool_models::key_yield_torque(tool.size));
    return text;
}

// Notes on sizes that the tables do not have.
std::string notes_on(const tool_models::ToolParameters& p) {
    const tool_models::KindInfo& info = tool_models::info_of(p.kind);
    const auto sizes = tool_models::standard_sizes(info.measure);
    const double size = p.size / mm;
    const bool standard = std::any_of(sizes.begin(), sizes.end(),
                                      [&](double listed) { return std::abs(listed - size) < 1e-6; });
    if (standard) return {};
    return fmt::format("note: {:g} mm is not a standard size of {}: its dimensions are interpolated\n", size,
                       info.name);
}

// The kinds in assembly.json and those of the models.
constexpr std::pair<std::string_view, std::string_view> kinds_of_files[] = {
    {"open_end_wrench", "open_end"},
    {"ring_wrench", "ring"},
    {"ratchet", "socket"},
    {"click_torque_wrench", "torque_wrench"},
};

// Accepts the names in assembly.json too.
Result<tool_models::ModelKind> kind_of_model(std::string_view name) {
    for (const auto& [in_file, of_model] : kinds_of_files)
        if (name == in_file) return tool_models::kind_named(of_model);
    return tool_models::kind_named(name);
}

tool_models::ModelHead head_of_model(std::string_view name) {
    using tool_models::ModelHead;
    return name == "open_end"  ? ModelHead::open_end
           : name == "socket"  ? ModelHead::socket
           : name == "hex_bit" ? ModelHead::hex_bit
                               : ModelHead::standard;
}

Status make_tool_files(const ToolCommandOptions& options) {
    BOLT_TRY_ASSIGN(const auto size, view::parse_size(options.picture_size));
    tool_models::ToolParameters parameters;
    BOLT_TRY_ASSIGN(parameters.kind, kind_of_model(options.kind));
    parameters.head = head_of_model(options.head);
    parameters.extension = options.extension_mm * mm;
    parameters.size = options.size_mm * mm;
    parameters.length = options.length_mm * mm;
    parameters.drive = options.drive_mm * mm;
    parameters.teeth = options.teeth;
    parameters.adaptor_length = options.adaptor_mm * mm;
    BOLT_TRY_ASSIGN(const auto tool, tool_models::completed(parameters));
    const assets::Model drawn = tool_models::drawn_model(tool), contact = tool_models::contact_model(tool);

    fs::path stem(options.out);
    if (stem.extension() == ".glb") stem.replace_extension();
    const auto file = [&](const char* ending) { return fs::path(stem.string() + ending); };
    std::vector<std::pair<fs::path, std::string>> files;
    BOLT_TRY_ASSIGN(auto drawn_bytes, assets::encode_glb(drawn));
    BOLT_TRY_ASSIGN(auto contact_bytes, assets::encode_glb(contact));
    files.emplace_back(file(".glb"), std::move(drawn_bytes));
    files.emplace_back(file(".contact.glb"), std::move(contact_bytes));
    std::string notes = notes_on(tool);
    if (!options.no_picture) {
        Result<std::string> picture = draw_tool(drawn, size);
        if (picture)
            files.emplace_back(file(".png"), std::move(*picture));
        else if (picture.error().code == ErrorCode::no_device)
            notes += fmt::format("note: there is no picture: {}\n", picture.error().message());
        else
            return fail(picture.error());
    }
    BOLT_TRY(write_all(files));

    std::string text = tool_models::description(tool) + "\n";
    text += strength_line(tool);
    text += fmt::format("{} triangles, {} for contact\n", triangles_of(drawn), triangles_of(contact));
    for (const auto& [path, bytes] : files)
        text += fmt::format("{}: {} bytes\n", path.string(), bytes.size());
    return print(text + notes);
}

}  // namespace

void add_tool(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<ToolCommandOptions>();
    CLI::App* command = app.add_subcommand(
        "tool",
        "Make the models and a picture of a tool from its parameters: FILE.glb, FILE.contact.glb, FILE.png");
    command
        ->add_option("kind", options->kind,
                     "Kind of tool, as bolt-author tools lists them or as in assembly.json")
        ->required();
    command
        ->add_option("--size", options->size_mm,
                     "Width across flats that it grips, or of its square drive, mm")
        ->required();
    command->add_option("--length", options->length_mm,
                        "From the bolt's axis, or from the middle of what grips, to the far end, mm");
    command->add_option("--drive", options->drive_mm, "Width of the square drive, mm");
    command->add_option("--teeth", options->teeth, "Teeth of the ratchet: 24, 72 or 90");
    command
        ->add_option(
            "--head", options->head,
            "What a ratchet (socket unless given) or a torque wrench (open_end unless given) grips with")
        ->check(CLI::IsMember({"open_end", "socket", "hex_bit"}));
    command->add_option("--extension", options->extension_mm,
                        "Length of the bar between a square drive and its socket or bit, mm");
    command->add_option("--adaptor", options->adaptor_mm,
                        "Length of an adaptor between a torque wrench and its open end, mm");
    command->add_option("-o,--out", options->out, "Name of the files without their endings")->required();
    command->add_option("--picture-size", options->picture_size, "WIDTHxHEIGHT of the picture in pixels")
        ->capture_default_str();
    command->add_flag("--no-picture", options->no_picture, "Write no picture");
    command->callback([options, &exit_code] {
        const Status made = make_tool_files(*options);
        exit_code = made ? 0 : print_error(made.error());
    });
}

namespace {

std::string tool_table() {
    using namespace tool_models;
    std::string text;
    for (const KindInfo& info : model_kinds()) {
        const auto sizes = standard_sizes(info.measure);
        text += fmt::format("{:<25}{}, {:g} to {:g} mm\n", info.name, info.description, sizes.front(),
                            sizes.back());
    }
    text += "\nTest torques, N·m    open end      ring, socket\n";
    for (const double size : standard_sizes(SizeMeasure::nut))
        text += fmt::format("{:>4g} mm {:>21} {:>17}\n", size,
                            torque_text(test_torque(ModelKind::open_end_wrench, size * mm)),
                            torque_text(test_torque(ModelKind::ring_wrench, size * mm)));
    text += "\nSquare drive         N·m\n";
    for (const double size : standard_sizes(SizeMeasure::drive))
        text += fmt::format("{:>4g} mm {:>15}\n", size,
                            torque_text(test_torque(ModelKind::extension_bar, size * mm)));
    text += "\nHexagon keys         arms, mm (ISO 2936)\n";
    for (const double size : standard_sizes(SizeMeasure::socket_screw)) {
        const KeyArms arms = key_arms(size * mm);
        text += fmt::format("{:>4g} mm {:>15g} + {:g}\n", size, arms.arm / mm, arms.handle / mm);
    }
    text += "\nKinds in assembly.json\n";
    for (const auto& [in_file, of_model] : kinds_of_files)
        text += fmt::format("{:<25}{} here\n", in_file, of_model);
    return text +
           "\nTorques without a mark: ISO 1711-1 as read in Gedore's tables. ~: interpolated by a power law "
           "between them.\n?: an estimate; beyond the tables, and for square drives from catalogues.\n";
}

}  // namespace

void add_tools(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand("tools", "List the kinds, sizes and test torques of tools");
    command->callback([&exit_code] {
        const Status printed = print(tool_table());
        exit_code = printed ? 0 : print_error(printed.error());
    });
}

}  // namespace bolt::author
