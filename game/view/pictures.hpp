// WIDTHxHEIGHT, as command lines have it.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "content/format/assembly.hpp"
#include "engine/gpu/frames.hpp"
#include "engine/gpu/vk.hpp"
#include "engine/render/camera.hpp"
#include "engine/render/renderer.hpp"
#include "game/lesson/result.hpp"
#include "game/view/stage.hpp"

namespace bolt::view {

Result<VkExtent2D> parse_size(const std::string& text);

// A GPU with all that drawing on it takes.

// In the order in which they stand on each other.
struct Painter {
    std::unique_ptr<gpu::Device> device;
    std::unique_ptr<gpu::Frames> frames;
    std::unique_ptr<render::Renderer> renderer;
};

// Where compiled pipelines are kept between starts: boltwright/pipelines in $XDG_CACHE_HOME or ~/.cache;
// empty without either.
std::filesystem::path pipeline_file();

// With the pipelines of the last start, unless the options name another file.
Result<Painter> make_painter(const gpu::Instance& instance, const gpu::DeviceOptions& on,
                             const render::RendererOptions& options = {});

// Two eyes: where they are, and their pictures beside each other.

inline constexpr float eye_distance = 0.063F;  // m, the mean of adults

// m to the right of the middle, of every eye: the left one first, or the one that is there.
std::vector<float> eyes_aside(bool stereo);

// To be put before the clip coordinates of an eye that is `aside`: what is `distance` (m) away along the axis
// is where the other eye sees it too, as on a screen there (the off-axis projection of Kooima, 2008). Without
// it both eyes would stare into the distance, and what is near would have no place in both of their pictures.
glm::mat4 converging(float aside, float distance, const render::Perspective& lens);

// Pictures of the same height as one, the first on the left.
render::Picture side_by_side(std::span<const render::Picture> pictures);

// Pictures as PNG files.

// Makes the folder if it is not there, and says the file's name on the standard output.
Status write_picture(const render::Picture& picture, const std::filesystem::path& file);

// How a lesson ended, as pictures: every view of the assembly, with a line around each joint in the colour of
// its verdict.

// Green: OK. Amber: LOW. Red: HIGH, or no longer sound. None: not judged.
glm::vec4 verdict_color(const lesson::JointResult& joint);

// Writes FOLDER/view-NAME.png for each view. Nothing for an assembly without a model or without views.
Status draw_result(const content::Assembly& assembly, const lesson::LessonResult& result,
                   const std::filesystem::path& folder, VkExtent2D size);

}  // namespace bolt::view
