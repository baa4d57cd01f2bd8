#include "tools/author/import/import_step.hpp"

#include <fmt/format.h>

#include <Standard_Failure.hxx>
#include <Standard_OutOfMemory.hxx>
#include <algorithm>
#include <new>
#include <optional>

#include "content/format/assembly.hpp"
#include "content/format/embedded.hpp"
#include "engine/assets/gltf.hpp"
#include "engine/base/file.hpp"
#include "tools/author/geometry/check_model.hpp"
#include "tools/author/import/draft.hpp"
#include "tools/author/import/joints.hpp"
#include "tools/author/import/levels.hpp"
#include "tools/author/import/materials.hpp"
#include "tools/author/import/step_document.hpp"
#include "tools/author/import/tree.hpp"

namespace bolt::step_import {

namespace fs = std::filesystem;

namespace {

constexpr double far_deflection_ratio = 4.0;  // deflection of the far level / near level
constexpr double far_angle = 30.0;            // degrees
constexpr double far_error_share = 0.05;      // largest error of the far level / size of the assembly
constexpr double read_share = 0.35, mesh_share = 0.9;  // progress after reading and after meshing

// Runs the steps of an import in order and holds their shared state. Each step returns false after an error.
class Importer {
  public:
    Importer(const ImportOptions& options, const ImportProgress& progress)
        : options_(options), progress_(progress) {
        name_ = options.name.empty() ? options.step.stem().string() : options.name;
    }

    ImportResult run() {
        if (check_names() && read_table() && read() && mesh() && choose_materials() &&
            find_and_group_joints() && write_models() && write_draft()) {
            add_advice();
            progress_(1.0, "done");
        }
        return std::move(imported_);
    }

  private:
    const ImportOptions& options_;
    const ImportProgress& progress_;
    std::string name_;
    ImportResult imported_;
    MaterialTable table_;
    std::optional<MaterialPicker> picker_;
    StepDocument document_;
    Tree tree_;
    std::vector<PartGeometry> geometry_;            // by part
    std::vector<PartContactMesh> contacts_;         // by part
    std::vector<PartMesh> far_parts_;               // by part
    std::vector<std::vector<int>> face_materials_;  // by shape
    JointSearchResult search_;

    ImportReport& report() { return imported_.report; }

    bool fail_with(Error error) {
        imported_.errors.push_back(std::move(error));
        return false;
    }

    bool fail_with(ErrorCode code, const fs::path& file, std::string what, std::string expected) {
        Error error;
        error.code = code;
        error.file = file.string();
        error.what = std::move(what);
        error.expected = std::move(expected);
        return fail_with(std::move(error));
    }

    bool check_names() {
        if (fs::path(name_).filename().string() != name_ || name_ == "." || name_ == "..")
            return fail_with(ErrorCode::usage, {}, fmt::format("\"{}\" is not a file name", name_),
                             "a name without folders");
        std::error_code ignored;
        if (fs::exists(options_.folder, ignored) && !fs::is_directory(options_.folder, ignored))
            return fail_with(ErrorCode::failed, options_.folder, "is a file", "a folder");
        return true;
    }

    bool read_table() {
        table_ = load_materials(options_.folder, imported_.errors);
        picker_.emplace(table_);
        return imported_.errors.empty();
    }

    bool read() {
        auto document = read_step(options_.step, [&](double fraction, const std::string& what) {
            progress_(read_share * fraction, "reading " + what);
        });
        if (!document) return fail_with(document.error());
        document_ = std::move(*document);
        report().unit = document_.unit;
        report().remarks = document_.warnings;
        tree_ = make_tree(document_);
        return true;
    }

    // Returns an empty mesh and adds a remark if the mesher fails on a part; the other parts are not
    // affected.
    PartMesh mesh_part(const StepPart& part, const Deflection& deflection) {
        try {
            return tessellate(part.shape, deflection);
        } catch (const Standard_OutOfMemory&) {
            throw;
        } catch (const Standard_Failure& failure) {
            report().remarks.push_back(
                fmt::format("{}: cannot be meshed: {}", part.name, failure.GetMessageString()));
            PartMesh nothing;
            nothing.faces.resize(part.faces.size());
            for (std::size_t f = 0; f < part.faces.size(); ++f) nothing.without_triangles.push_back(f);
            return nothing;
        }
    }

    bool mesh() {
        const Deflection near{options_.deflection_mm, to_radians(options_.angle_deg)};
        const bool own_contact = options_.contact_deflection_mm > 0.0;
        const Deflection contact{own_contact ? options_.contact_deflection_mm : near.length_mm,
                                 own_contact ? std::max(near.angle, to_radians(far_angle)) : near.angle};
        const Deflection far{far_deflection_ratio * near.length_mm,
                             std::max(near.angle, to_radians(far_angle))};
        report().deflection_mm = near.length_mm;
        report().contact_deflection_mm = contact.length_mm;
        report().far_deflection_mm = options_.far_level ? far.length_mm : 0.0;
        for (std::size_t p = 0; p < document_.parts.size(); ++p) {
            const StepPart& part = document_.parts[p];
            const double done = static_cast<double>(p) / static_cast<double>(document_.parts.size());
            progress_(read_share + (mesh_share - read_share) * done, "meshing " + part.name);
            PartGeometry geometry;
            geometry.mesh = mesh_part(part, near);
            contacts_.push_back(
                contact_mesh(own_contact ? mesh_part(part, contact) : geometry.mesh, part.name));
            if (options_.far_level) far_parts_.push_back(mesh_part(part, far));
            if (options_.joints) {
                geometry.fastener = recognise_fastener(part.shape, geometry.mesh);
                geometry.holes = find_holes(part.shape);
            }
            geometry_.push_back(std::move(geometry));
        }
        return report_parts();
    }

    bool report_parts() {
        std::size_t all = 0;
        for (std::size_t p = 0; p < document_.parts.size(); ++p) {
            const PartMesh& mesh = geometry_[p].mesh;
            PartReport part;
            part.name = document_.parts[p].name;
            for (const ColouredPart& shape : tree_.shapes)
                if (shape.part == static_cast<int>(p)) part.instances += shape.uses;
            part.triangles = count_triangles(mesh);
            part.contact_triangles = contacts_[p].triangles;
            part.open_edges = contacts_[p].open.count;
            for (const Vec3& point : contacts_[p].open.first)
                part.open_at_mm.push_back(point_to_cad_mm(point));
            part.faces_without_triangles = mesh.without_triangles.size();
            part.deviation_mm = mesh.deviation / mm;
            all += part.triangles;
            report().instances += part.instances;
            report().triangles += part.instances * part.triangles;
            report().parts.push_back(std::move(part));
        }
        if (all == 0)
            return fail_with(ErrorCode::bad_content, options_.step, "none of its shapes can be meshed",
                             "solids or shells with a surface");
        return true;
    }

    bool choose_materials() {
        for (const ColouredPart& shape : tree_.shapes) {
            const StepPart& part = document_.parts[static_cast<std::size_t>(shape.part)];
            std::vector<int> materials;
            for (const FaceStyle& face : part.faces) {
                const auto& whole = shape.colour ? shape.colour : part.colour;
                materials.push_back(
                    picker_->pick({face.colour ? face.colour : whole, part.material, face.name, part.name}));
            }
            face_materials_.push_back(std::move(materials));
        }
        for (const assets::Material& material : picker_->materials())
            report().materials.push_back(material.name);
        for (const auto& [material, why] : picker_->guesses())
            report().remarks.push_back(fmt::format("material {}: {}", material, why));
        return true;
    }

    bool find_and_group_joints() {
        if (options_.joints) {
            search_ = find_joints(tree_, geometry_);
            if (const Status turned = turn_at_heads(search_, options_.turn_heads); !turned)
                return fail_with(turned.error());
            add_joint_nodes(tree_, search_);
            report().joints = search_.joints.size();
            report().remarks.insert(report().remarks.end(), search_.remarks.begin(), search_.remarks.end());
        }
        report().renamed = static_cast<std::size_t>(make_names_unique(tree_));
        return true;
    }

    std::vector<assets::Mesh> render_meshes(const std::vector<const PartMesh*>& parts,
                                            const std::vector<assets::Material>& materials) const {
        std::vector<assets::Mesh> meshes;
        for (std::size_t s = 0; s < tree_.shapes.size(); ++s) {
            const auto part = static_cast<std::size_t>(tree_.shapes[s].part);
            meshes.push_back(
                render_mesh(*parts[part], face_materials_[s], materials, document_.parts[part].name));
        }
        return meshes;
    }

    bool write_model(const char* ending, const assets::Model& model) {
        const std::string name = name_ + ending;
        progress_(mesh_share, "writing " + name);
        return note_file(name, assets::write_glb(write_to() / name, model));
    }

    // Folder in which the files are created; the caller publishes them to options_.folder.
    [[nodiscard]] const fs::path& write_to() const {
        return options_.write_to.empty() ? options_.folder : options_.write_to;
    }

    bool check_written(const std::string& name, const Status& written) {
        if (written) return true;
        Error error = written.error();
        error.file = (options_.folder / name).string();
        return fail_with(std::move(error));
    }

    bool note_file(const std::string& name, const Status& written) {
        if (!check_written(name, written)) return false;
        std::error_code ignored;
        report().files.push_back({options_.folder / name, fs::file_size(write_to() / name, ignored)});
        return true;
    }

    void add_advice() {
        if (report().triangles > geometry::near_budget)
            report().remarks.push_back(
                fmt::format("the near level has {} triangles; expected at most {}: import with a larger "
                            "--deflection or --angle",
                            report().triangles, geometry::near_budget));
        for (const FileReport& file : report().files)
            if (file.bytes > geometry::file_budget)
                report().remarks.push_back(
                    fmt::format("{} has {:.1f} MB; expected at most {} MB", file.path.filename().string(),
                                static_cast<double>(file.bytes) * 1e-6, geometry::file_budget / 1'000'000));
    }

    bool write_models() {
        std::error_code problem;
        fs::create_directories(write_to(), problem);
        if (problem)
            return fail_with(ErrorCode::failed, options_.folder, "cannot be created: " + problem.message(),
                             {});
        std::vector<const PartMesh*> near;
        for (const PartGeometry& part : geometry_) near.push_back(&part.mesh);
        if (!write_model(".glb",
                         make_model(tree_, render_meshes(near, picker_->materials()), picker_->materials())))
            return false;
        if (options_.far_level && !write_far()) return false;
        // Instances of a part with different colours share one contact mesh.
        Tree by_part = tree_;
        for (TreeNode& node : by_part.nodes)
            if (node.shape >= 0) node.shape = tree_.shapes[static_cast<std::size_t>(node.shape)].part;
        std::vector<assets::Mesh> closed;
        for (const PartContactMesh& contact : contacts_) closed.push_back(contact.mesh);
        return write_model(".contact.glb", make_model(by_part, closed, {}));
    }

    bool write_far() {
        std::vector<const PartMesh*> parts;
        for (const PartMesh& part : far_parts_) parts.push_back(&part);
        std::vector<std::size_t> uses;
        for (const ColouredPart& shape : tree_.shapes) uses.push_back(shape.uses);
        const auto [low, high] = bounds();
        progress_(mesh_share, "simplifying the far level");
        // Simplified meshes have no tangents, and the lay is invisible at a distance.
        std::vector<assets::Material> materials = picker_->materials();
        for (assets::Material& material : materials) material.anisotropy = 0.0F;
        const FarLevel far = simplify(render_meshes(parts, materials), uses, options_.far_triangles,
                                      far_error_share * glm::length(high - low));
        report().far_triangles = far.triangles;
        report().far_error_mm = far.error / mm;
        for (std::size_t s = 0; s < tree_.shapes.size(); ++s)
            report().parts[static_cast<std::size_t>(tree_.shapes[s].part)].far_triangles =
                count_triangles(far.meshes[s]);
        if (far.triangles > options_.far_triangles)
            report().remarks.push_back(fmt::format("the far level has {} triangles; expected at most {}",
                                                   far.triangles, options_.far_triangles));
        return write_model(".far.glb", make_model(tree_, far.meshes, materials));
    }

    std::pair<Vec3, Vec3> bounds() const {
        Vec3 low{1e9}, high{-1e9};
        for (std::size_t n = 0; n < tree_.nodes.size(); ++n) {
            const int shape = tree_.nodes[n].shape;
            if (shape < 0) continue;
            const ScaledPose pose = world(tree_, static_cast<int>(n));
            const auto part = static_cast<std::size_t>(tree_.shapes[static_cast<std::size_t>(shape)].part);
            for (const Vec3& point : geometry_[part].mesh.points) {
                low = glm::min(low, pose.point(point));
                high = glm::max(high, pose.point(point));
            }
        }
        return {low, high};
    }

    // Returns the material with the largest area on the part.
    int main_material(int shape) const {
        const auto s = static_cast<std::size_t>(shape);
        const PartMesh& mesh = geometry_[static_cast<std::size_t>(tree_.shapes[s].part)].mesh;
        std::vector<double> area(picker_->materials().size(), 0.0);
        for (std::size_t f = 0; f < mesh.faces.size(); ++f)
            for (const auto& triangle : mesh.faces[f].triangles) {
                const auto p = [&](std::size_t k) { return mesh.points[mesh.faces[f].points[triangle[k]]]; };
                area[static_cast<std::size_t>(face_materials_[s][f])] +=
                    glm::length(glm::cross(p(1) - p(0), p(2) - p(0)));
            }
        return static_cast<int>(std::max_element(area.begin(), area.end()) - area.begin());
    }

    bool write_draft() {
        if (!options_.joints) return true;
        DraftInput input;
        input.title = name_;
        input.source = options_.step.filename().string();
        input.model = name_ + ".glb";
        input.far = options_.far_level ? name_ + ".far.glb" : "";
        input.contact = name_ + ".contact.glb";
        std::tie(input.low, input.high) = bounds();
        input.search = &search_;
        for (const TreeNode& node : tree_.nodes) {
            const int material = node.shape >= 0 ? main_material(node.shape) : -1;
            input.member_materials.push_back(material >= 0 ? picker_->member_material(material)
                                                           : std::string());
            input.stainless.push_back(input.member_materials.back() == "stainless_steel");
        }
        std::error_code ignored;
        const fs::path whole = fs::absolute(options_.folder / "assembly.json", ignored).lexically_normal();
        const bool shipped = fs::equivalent(whole.parent_path().parent_path(),
                                            content::content_folder() / "assemblies", ignored);
        constexpr const char* schema = "assembly.schema.json";
        input.schema = shipped ? fmt::format("../../schema/{}", schema) : schema;
        const Draft draft = make_draft(input);
        report().joints_drafted = draft.joints;
        report().tools = draft.tools;
        report().joint_types = draft.joint_types;
        report().remarks.insert(report().remarks.end(), draft.remarks.begin(), draft.remarks.end());
        if (draft.text.empty()) return true;
        for (const Error& error : content::parse_assembly(draft.text, "the draft").errors)
            report().remarks.push_back(error.message());

        std::string name = "assembly.json";
        if (fs::exists(options_.folder / name, ignored)) {
            const auto existing = read_file(options_.folder / name, 16U << 20U, ErrorCode::failed);
            if (existing && *existing == draft.text) return true;  // an unchanged draft
            name = "assembly.draft.json";
        }
        if (!shipped && !fs::exists(options_.folder / schema, ignored) &&
            !check_written(schema, write_file(write_to() / schema, content::assembly_schema_text())))
            return false;
        return note_file(name, write_file(write_to() / name, draft.text));
    }
};

}  // namespace

ImportResult import_step(const ImportOptions& options, const ImportProgress& progress) {
    try {
        return Importer(options, progress).run();
    } catch (const Standard_OutOfMemory&) {
        throw std::bad_alloc();
    } catch (const Standard_Failure& failure) {
        ImportResult imported;
        Error error;
        error.code = ErrorCode::bad_content;
        error.file = options.step.string();
        error.what = fmt::format("its geometry cannot be processed: {}", failure.GetMessageString());
        error.expected = "a STEP file as a CAD program exports it";
        imported.errors.push_back(std::move(error));
        return imported;
    }
}

}  // namespace bolt::step_import
