#include "game/view/loaded_model.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "content/format/assembly.hpp"
#include "engine/assets/gltf.hpp"
#include "engine/assets/image.hpp"
#include "engine/base/nearest.hpp"

namespace bolt::view {

namespace fs = std::filesystem;

namespace {

bool is_model_file(const fs::path& file) { return file.extension() == ".glb" || file.extension() == ".gltf"; }

Error no_model(const content::Assembly& assembly, DetailLevel level) {
    Error error;
    error.code = ErrorCode::bad_content;
    const bool far = level == DetailLevel::far;
    error.what = fmt::format("{}: names no {}model", assembly.file, far ? "far " : "");
    error.expected = far ? "\"model_far\": \"NAME.far.glb\"" : "\"model\": \"NAME.glb\"";
    return error;
}

// Adds the model file and all files in its folder that may hold its buffers or images.
void add_files_of(const fs::path& model, std::vector<fs::path>& files) {
    files.push_back(model);
    const fs::path folder = model.has_parent_path() ? model.parent_path() : fs::path(".");
    std::error_code problem;
    for (auto entry = fs::directory_iterator(folder, problem); !problem && entry != fs::directory_iterator();
         entry.increment(problem)) {
        const std::string extension = entry->path().extension().string();
        if (extension == ".bin" || extension == ".png" || extension == ".jpg" || extension == ".jpeg")
            files.push_back(entry->path());
    }
}

}  // namespace

ModelLoadResult load_model(const std::string& source, DetailLevel level, const std::string& variant) {
    ModelLoadResult loaded;
    LoadedModel& model = loaded.model;
    std::vector<std::string> parts{source};
    model.name = fs::path(source).filename().string();
    model.without_assembly = is_model_file(source);
    if (!model.without_assembly) {
        content::LoadedAssembly assembly = content::load_assembly(source, variant);
        if (!assembly.ok()) return {{}, std::move(assembly.errors)};
        const content::Assembly& a = assembly.assembly;
        parts = content::model_paths(
            a, level == DetailLevel::far ? &content::ModelFiles::far_level : &content::ModelFiles::model);
        if (parts.empty()) return {{}, {no_model(a, level)}};
        model.name = a.name;
        for (const content::NamedView& view : a.views)
            model.views.push_back({view.name, glm::vec3(view.eye), glm::vec3(view.target),
                                   static_cast<float>(view.field_of_view)});
        for (const content::AssemblyJoint& joint : a.joints)
            model.joints.push_back({joint.design.id, glm::vec3(joint.design.seat)});
        model.files.emplace_back(a.file);
    }
    for (const std::string& file : parts) {
        Result<assets::Model> read = assets::read_gltf(file);
        if (!read) return {{}, {read.error()}};
        if (&file == &parts.front())
            model.model = std::move(*read);
        else
            assets::append(model.model, std::move(*read));
        add_files_of(file, model.files);
    }
    return loaded;
}

Result<Viewpoint> named_view(const LoadedModel& model, const std::string& name) {
    if (model.without_assembly)
        return fail(ErrorCode::usage, "a bare model has no named views", "--eye X,Y,Z --target X,Y,Z");
    std::vector<std::string> names;
    for (const Viewpoint& view : model.views) {
        if (view.name == name) return view;
        names.push_back(view.name);
    }
    const std::string near = nearest(name, names);
    return fail(ErrorCode::usage, fmt::format("{} has no view \"{}\"", model.name, name),
                near.empty() ? fmt::format("one of its {} views", names.size())
                             : fmt::format("did you mean \"{}\"?", near));
}

Result<shading::RadianceImage> load_light(const std::string& name) {
    if (name == "studio") return shading::studio_environment();
    return assets::read_hdr(name);
}

}  // namespace bolt::view
