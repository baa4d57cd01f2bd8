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

Error no_model(const content::Assembly& assembly, Level level) {
    Error error;
    error.code = ErrorCode::bad_content;
    const bool far = level == Level::far;
    error.what = fmt::format("{} names no {}model to draw", assembly.file, far ? "far " : "");
    error.expected = far ? "\"model_far\": \"NAME.far.glb\"" : "\"model\": \"NAME.glb\"";
    return error;
}

// Buffers and images that a model may have outside of itself lie beside it.
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

LoadedSubject load_subject(const std::string& what, Level level) {
    LoadedSubject loaded;
    Subject& subject = loaded.subject;
    std::string file = what;
    subject.name = fs::path(what).filename().string();
    subject.bare = is_model_file(what);
    if (!subject.bare) {
        content::Loaded assembly = content::load_assembly(what);
        if (!assembly.ok()) return {{}, std::move(assembly.errors)};
        const content::Assembly& a = assembly.assembly;
        file = level == Level::far ? a.models.far_level : a.models.model;
        if (file.empty()) return {{}, {no_model(a, level)}};
        subject.name = a.name;
        for (const content::View& view : a.views)
            subject.views.push_back({view.name, glm::vec3(view.eye), glm::vec3(view.target),
                                     static_cast<float>(view.field_of_view)});
        for (const content::AssemblyJoint& joint : a.joints)
            subject.joints.push_back({joint.design.id, glm::vec3(joint.design.seat)});
        subject.files.emplace_back(a.file);
    }
    Result<assets::Model> model = assets::read_gltf(file);
    if (!model) return {{}, {model.error()}};
    subject.model = std::move(*model);
    add_files_of(file, subject.files);
    return loaded;
}

Result<Viewpoint> named_view(const Subject& subject, const std::string& name) {
    if (subject.bare)
        return fail(ErrorCode::usage, "a bare model has no named views", "--eye X,Y,Z --target X,Y,Z");
    std::vector<std::string> names;
    for (const Viewpoint& view : subject.views) {
        if (view.name == name) return view;
        names.push_back(view.name);
    }
    const std::string near = nearest(name, names);
    return fail(
        ErrorCode::usage, fmt::format("{} has no view \"{}\"", subject.name, name),
        near.empty() ? fmt::format("one of its {} views", names.size()) : fmt::format("\"{}\"", near));
}

Result<shading::RadianceImage> load_light(const std::string& name) {
    if (name == "studio") return shading::studio();
    return assets::read_hdr(name);
}

}  // namespace bolt::view
