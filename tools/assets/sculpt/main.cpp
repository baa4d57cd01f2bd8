// bolt-sculpt: generates the hands, the workshop and its environment map, deterministically.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/assets/gltf.hpp"
#include "engine/base/file.hpp"
#include "engine/base/result.hpp"
#include "engine/program/program.hpp"
#include "haptics/hand/kinematics.hpp"
#include "haptics/hand/measured_hand.hpp"
#include "tools/assets/sculpt/generated_content.hpp"
#include "tools/assets/sculpt/pose.hpp"

namespace {

using bolt::Status;
using WriteFiles = Status (*)(const std::filesystem::path&);

Status make_all(const std::filesystem::path& content) {
    for (const WriteFiles write :
         {&bolt::sculpt::write_hands, &bolt::sculpt::write_workshop, &bolt::sculpt::write_environment}) {
        BOLT_TRY(write(content));
    }
    return {};
}

void add_writer(CLI::App& app, int& exit_code, const std::string& name, const std::string& help,
                WriteFiles write) {
    CLI::App* command = app.add_subcommand(name, help);
    auto folder = std::make_shared<std::string>();
    command->add_option("-o,--out", *folder, "the content folder to write below")->required();
    command->callback([folder, write, &exit_code] {
        const Status done = write(*folder);
        exit_code = done ? 0 : bolt::print_error(done.error());
    });
}

struct PoseOptions {
    std::string hand, out, pose = "fist";
    std::vector<double> glove;  // degrees, by hand::Sensor; empty: the named pose
};

// Poses the hand by the sensor angles of a glove (degrees).
bolt::Result<bolt::assets::Model> pose_by_glove(const bolt::assets::Model& model,
                                                std::span<const double> degrees, bool left) {
    bolt::hand::PerSensor<double> angles{};
    std::transform(degrees.begin(), degrees.end(), angles.begin(), bolt::to_radians);
    const bolt::hand::Hand hand =
        bolt::hand::make_hand(left ? bolt::hand::Side::left : bolt::hand::Side::right);
    const bolt::hand::Angles clamped = bolt::hand::clamp_to_limits(bolt::hand::hand_angles(angles));
    return bolt::sculpt::posed(model,
                               bolt::hand::joints(hand, clamped, bolt::hand::wrist_of(hand, clamped, {})));
}

Status write_posed(const PoseOptions& options) {
    BOLT_TRY(bolt::require_different_files(options.hand, options.out));
    const auto hand = bolt::assets::read_gltf(options.hand);
    if (!hand) return tl::unexpected(hand.error());
    const auto right = bolt::sculpt::named_pose(options.pose);
    if (!right)
        return bolt::fail(bolt::ErrorCode::usage, "--pose: unknown pose '" + options.pose + "'",
                          "open, relaxed, fist, pinch or grip");
    const bool left = !hand->meshes.empty() && hand->meshes[0].name == "hand_left";
    auto model = options.glove.empty()
                     ? bolt::sculpt::posed(*hand, left ? bolt::sculpt::mirrored(*right) : *right)
                     : pose_by_glove(*hand, options.glove, left);
    if (!model) {
        bolt::Error error = model.error();
        error.file = options.hand;
        return bolt::fail(error);
    }
    return bolt::assets::write_glb(options.out, *model);
}

void add_pose(CLI::App& app, int& exit_code) {
    CLI::App* command =
        app.add_subcommand("pose", "Writes a copy of a hand in a pose, without its skin, for inspection.");
    auto options = std::make_shared<PoseOptions>();
    command->add_option("HAND", options->hand, "hand_left.glb or hand_right.glb")->required();
    command->add_option("--pose", options->pose, "open, relaxed, fist, pinch or grip");
    command
        ->add_option("--glove", options->glove,
                     "22 angles in degrees as a CyberGlove gives them, thumb roll first, wrist yaw last")
        ->delimiter(',')
        ->expected(static_cast<int>(bolt::hand::sensor_count));
    command->add_option("-o,--out", options->out, "the .glb to write")->required();
    command->callback([options, &exit_code] {
        const Status done = write_posed(*options);
        exit_code = done ? 0 : bolt::print_error(done.error());
    });
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Makes hands, workshop and environment for Boltwright.", "bolt-sculpt");
    app.require_subcommand(1);
    app.set_version_flag("--version", "bolt-sculpt " BOLTWRIGHT_VERSION);
    int exit_code = 0;
    add_writer(app, exit_code, "hands", "The two gloved hands.", bolt::sculpt::write_hands);
    add_writer(app, exit_code, "workshop", "Bench, floor, wall, tools and lights.",
               bolt::sculpt::write_workshop);
    add_writer(app, exit_code, "environment", "The workshop's environment map as a Radiance file.",
               bolt::sculpt::write_environment);
    add_writer(app, exit_code, "all", "All generated files.", make_all);
    add_pose(app, exit_code);
    return bolt::run_command_line(app, argc, argv, exit_code);
}
