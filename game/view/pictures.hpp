// Drawing to pictures without a window: stereo pairs, PNG files and pictures of a lesson's result.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "content/format/assembly.hpp"
#include "engine/gpu/vk.hpp"
#include "engine/render/camera.hpp"
#include "engine/render/renderer.hpp"
#include "game/lesson/result.hpp"

namespace bolt::view {

// Parses WIDTHxHEIGHT of a command line, in pixels.
Result<VkExtent2D> parse_size(const std::string& text);

// m, mean of adults (Dodgson 2004: 63 mm). Display files have a default of their own, that of ParaView.
inline constexpr float mean_eye_separation = 0.063F;

// Offsets of the eyes from the middle, m, to the right: left and right eye, or a single eye at 0.
std::vector<float> eye_offsets(bool stereo);

// A shear, to be multiplied from the left onto the projection of an eye at `offset`: points at `distance` m
// along the axis get the same screen position for both eyes, as on a screen there (off-axis projection,
// Kooima 2008). Without it the axes of the eyes would be parallel, and near points would not be in both
// pictures.
glm::mat4 convergence_shear(float offset, float distance, const render::Perspective& lens);

// Joins pictures of equal height, the first on the left.
render::Picture side_by_side(std::span<const render::Picture> pictures);

// Writes a PNG file, creates its folder if needed, and prints the file's name to the standard output.
Status write_picture(const render::Picture& picture, const std::filesystem::path& file);

// The outline colour of a joint in the default palette; alpha 0 for a joint without a verdict.
glm::vec4 verdict_color(const lesson::JointResult& joint);

// Writes FOLDER/view-NAME.png for each view of the assembly, with every joint outlined in the colour of its
// verdict and labelled. Writes nothing for an assembly without a model or without views.
Status draw_result(const content::Assembly& assembly, const lesson::LessonResult& result,
                   const std::filesystem::path& folder, VkExtent2D size);

}  // namespace bolt::view
