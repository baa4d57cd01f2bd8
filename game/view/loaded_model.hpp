// The model of an assembly with the named views of its file, or a bare model file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/assets/model.hpp"
#include "engine/base/result.hpp"
#include "engine/shading/environment.hpp"

namespace bolt::view {

struct Viewpoint {
    std::string name;                   // of a view of the assembly; empty: an unnamed viewpoint
    glm::vec3 eye{0.0F}, target{0.0F};  // m
    float fov = 0.0F;                   // rad, vertical; 0: the default of the program
};

struct JointPosition {
    std::string id;
    glm::vec3 position{0.0F};  // m, assembly frame
};

// The detailed model of an assembly, or its simplified one for display from far away.
enum class DetailLevel : std::uint8_t { near, far };

struct LoadedModel {
    std::string name;  // of the assembly, or of the model file
    assets::Model model;
    std::vector<Viewpoint> views;              // empty for a bare model
    std::vector<JointPosition> joints;         // empty for a bare model
    bool without_assembly = false;             // a bare model: a file without an assembly
    std::vector<std::filesystem::path> files;  // all files read, to be watched for changes
};

// Either a model and no errors, or all errors.
struct ModelLoadResult {
    LoadedModel model;
    std::vector<Error> errors;
    [[nodiscard]] bool ok() const { return errors.empty(); }
};

// `source`: a .glb or .gltf file, or the folder, file or name of an assembly. `variant`: of the assembly;
// empty: its default one.
ModelLoadResult load_model(const std::string& source, DetailLevel level = DetailLevel::near,
                           const std::string& variant = {});

// Fails if there is no view of that name; the error suggests the nearest name.
Result<Viewpoint> named_view(const LoadedModel& model, const std::string& name);

// `name`: "studio", or the path of a Radiance .hdr file.
Result<shading::RadianceImage> load_light(const std::string& name);

}  // namespace bolt::view
