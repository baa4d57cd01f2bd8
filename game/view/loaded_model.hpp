// What is looked at: the model of an assembly with the views that its file names, or a bare model.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/assets/model.hpp"
#include "engine/base/result.hpp"
#include "engine/shading/environment.hpp"

namespace bolt::view {

struct Viewpoint {
    std::string name;  // empty: none that the assembly names
    glm::vec3 eye{0.0F}, target{0.0F};
    float fov = 0.0F;  // rad, vertical; 0: whatever is usual
};

struct JointPlace {
    std::string id;
    glm::vec3 at{0.0F};  // m
};

enum class Level : std::uint8_t { near, far };

struct Subject {
    std::string name;  // of the assembly, or the file's
    assets::Model model;
    std::vector<Viewpoint> views;    // a bare model has none
    std::vector<JointPlace> joints;  // likewise
    bool bare = false;
    std::vector<std::filesystem::path> files;  // that it was made from
};

// Either a subject and no errors, or all that is wrong.
struct LoadedSubject {
    Subject subject;
    std::vector<Error> errors;
    [[nodiscard]] bool ok() const { return errors.empty(); }
};

// `what`: a .glb or .gltf, or an assembly: folder, file or name.
LoadedSubject load_subject(const std::string& what, Level level = Level::near);

// The view of that name, or an error with the nearest one.
Result<Viewpoint> named_view(const Subject& subject, const std::string& name);

// "studio", or a Radiance .hdr file.
Result<shading::RadianceImage> load_light(const std::string& name);

}  // namespace bolt::view
