#include "tools/author/import/step_document.hpp"

#include <fmt/format.h>

#include <Interface_CheckIterator.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_ProgressIndicator.hxx>
#include <Quantity_ColorRGBA.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <Standard_OutOfMemory.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDF_Tool.hxx>
#include <TDataStd_Name.hxx>
#include <TDataStd_TreeNode.hxx>
#include <TDocStd_Document.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_GraphNode.hxx>
#include <XCAFDoc_Material.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_WorkSession.hxx>
#include <algorithm>
#include <fstream>
#include <functional>
#include <map>
#include <utility>

#include "engine/base/file.hpp"
#include "tools/author/import/names.hpp"

namespace bolt::step_import {

namespace {

// Forwards the progress of OpenCASCADE as a fraction.
class OccProgress : public Message_ProgressIndicator {
  public:
    explicit OccProgress(std::function<void(double)> report) : report_(std::move(report)) {}

  protected:
    void Show(const Message_ProgressScope& /*scope*/, Standard_Boolean /*force*/) override {
        report_(GetPosition());
    }

  private:
    std::function<void(double)> report_;
};

constexpr std::size_t max_instances = 100'000;
constexpr int max_levels = 200;

tl::unexpected<Error> refuse(const std::filesystem::path& path, std::string what, std::string expected) {
    Error error;
    error.code = ErrorCode::bad_content;
    error.file = path.string();
    error.what = std::move(what);
    error.expected = std::move(expected);
    return fail(std::move(error));
}

// Checks the file before OpenCASCADE reads it, whose errors for other files are vague.
Status check_file(const std::filesystem::path& path) {
    constexpr const char* wanted = "a STEP file (ISO 10303-21: AP203, AP214 or AP242)";
    std::error_code problem;
    const auto status = std::filesystem::status(path, problem);
    if (!std::filesystem::exists(status)) return refuse(path, "does not exist", wanted);
    if (!std::filesystem::is_regular_file(status)) return refuse(path, "is not a regular file", wanted);
    std::ifstream file(path, std::ios::binary);
    if (!file) return refuse(path, "cannot be opened", wanted);
    std::string head(65536, '\0');
    file.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(file.gcount()));
    if (head.empty()) return refuse(path, "the file is empty", wanted);
    const std::size_t magic = head.find("ISO-10303-21");
    if (magic == std::string::npos || magic > 4096)
        return refuse(path, "is not a STEP file: it does not begin with ISO-10303-21", wanted);
    const std::size_t schema = head.find("FILE_SCHEMA");
    if (schema != std::string::npos && head.find("IFC", schema) < head.find(';', schema))
        return refuse(path, "is a building model (IFC), not a STEP file of parts", wanted);
    file.clear();
    file.seekg(0, std::ios::end);
    const std::streamoff size = file.tellg();
    std::string tail(static_cast<std::size_t>(std::min<std::streamoff>(size, 4096)), '\0');
    file.seekg(size - static_cast<std::streamoff>(tail.size()));
    file.read(tail.data(), static_cast<std::streamsize>(tail.size()));
    if (tail.find("END-ISO-10303-21") == std::string::npos)
        return refuse(path, "the file is cut short: its last line is missing",
                      "END-ISO-10303-21; at its end");
    return {};
}

std::optional<Colour> colour_of(const Handle(XCAFDoc_ColorTool) & tool, const TDF_Label& label) {
    Quantity_ColorRGBA found;
    for (const XCAFDoc_ColorType type : {XCAFDoc_ColorSurf, XCAFDoc_ColorGen})
        if (tool->GetColor(label, type, found)) {
            Colour colour;
            found.GetRGB().Values(colour.r, colour.g, colour.b, Quantity_TOC_sRGB);
            colour.alpha = static_cast<double>(found.Alpha());
            return colour;
        }
    return std::nullopt;
}

std::string name_of(const TDF_Label& label) {
    Handle(TDataStd_Name) name;
    if (!label.FindAttribute(TDataStd_Name::GetID(), name)) return {};
    return clean_name(TCollection_AsciiString(name->Get(), 0).ToCString());
}

std::string material_of(const TDF_Label& label) {
    Handle(TDataStd_TreeNode) node;
    if (!label.FindAttribute(XCAFDoc::MaterialRefGUID(), node) || !node->HasFather()) return {};
    Handle(XCAFDoc_Material) material;
    if (!node->Father()->Label().FindAttribute(XCAFDoc_Material::GetID(), material)) return {};
    return material->GetName().IsNull() ? std::string() : clean_name(material->GetName()->ToCString());
}

// Converts the document tree of OpenCASCADE.
class DocumentWalker {
  public:
    DocumentWalker(const Handle(TDocStd_Document) & document, StepDocument& result)
        : shapes_(XCAFDoc_DocumentTool::ShapeTool(document->Main())),
          colours_(XCAFDoc_DocumentTool::ColorTool(document->Main())),
          result_(result) {}

    // Returns false if the tree exceeds max_instances or max_levels.
    bool run() {
        TDF_LabelSequence free;
        shapes_->GetFreeShapes(free);
        for (const TDF_Label& label : free) {
            const int root = visit(label, label, std::nullopt, 0);
            if (root >= 0) result_.roots.push_back(root);
        }
        return !too_large_;
    }

  private:
    Handle(XCAFDoc_ShapeTool) shapes_;
    Handle(XCAFDoc_ColorTool) colours_;
    StepDocument& result_;
    std::map<std::string, int> part_of_;  // by the label's entry
    TDF_LabelSequence path_;              // components from the root to the present one
    bool too_large_ = false;

    // `use` is a component or a free shape, `product` the shape that it refers to. Descendants without a
    // colour inherit the colour of their assembly. Returns the index of the instance; −1 if the tree is too
    // large.
    int visit(const TDF_Label& use, const TDF_Label& product, std::optional<Colour> above, int level) {
        if (too_large_ || level > max_levels || result_.instances.size() >= max_instances) {
            too_large_ = true;
            return -1;
        }
        const bool component = !use.IsEqual(product);
        if (component) path_.Append(use);
        const int index = static_cast<int>(result_.instances.size());
        const auto self = static_cast<std::size_t>(index);
        result_.instances.emplace_back();
        const std::string own = name_of(use);
        result_.instances[self].name = is_meaningful_name(own) ? own : name_of(product);
        if (component)
            result_.instances[self].placement = XCAFDoc_ShapeTool::GetLocation(use).Transformation();
        std::optional<Colour> here = override_of(use);
        if (!here && component) here = colour_of(colours_, use);
        if (XCAFDoc_ShapeTool::IsAssembly(product)) {
            // Priority: colour of the use, of the product, inherited.
            if (!here) here = colour_of(colours_, product);
            if (!here) here = above;
            TDF_LabelSequence components;
            XCAFDoc_ShapeTool::GetComponents(product, components);
            for (const TDF_Label& child : components) {
                TDF_Label referred;
                if (!XCAFDoc_ShapeTool::GetReferredShape(child, referred)) continue;
                const int made = visit(child, referred, here, level + 1);
                if (made >= 0) result_.instances[self].children.push_back(made);
            }
        } else {
            const int part = part_of(product);
            result_.instances[self].part = part;
            if (!here && part >= 0 && !result_.parts[static_cast<std::size_t>(part)].colour) here = above;
            result_.instances[self].colour = here;
        }
        if (component) path_.Remove(path_.Length());
        return index;
    }

    // Returns the colour that an ancestor assigns to this one use (SHUO); the uppermost ancestor wins.
    std::optional<Colour> override_of(const TDF_Label& use) {
        if (path_.IsEmpty() || !path_.Last().IsEqual(use)) return std::nullopt;
        for (int first = 1; first < path_.Length(); ++first) {
            TDF_LabelSequence labels;
            for (int i = first; i <= path_.Length(); ++i) labels.Append(path_.Value(i));
            Handle(XCAFDoc_GraphNode) found;
            if (!XCAFDoc_ShapeTool::FindSHUO(labels, found)) continue;
            if (const auto colour = colour_of(colours_, found->Label())) return colour;
        }
        return std::nullopt;
    }

    int part_of(const TDF_Label& label) {
        TCollection_AsciiString entry;
        TDF_Tool::Entry(label, entry);
        const auto [known, fresh] = part_of_.emplace(entry.ToCString(), -1);
        if (!fresh) return known->second;
        StepPart part;
        part.name = name_of(label);
        part.shape = XCAFDoc_ShapeTool::GetShape(label);
        if (part.shape.IsNull()) return -1;
        const FaceMap faces = faces_of(part.shape);
        if (faces.Extent() == 0) return -1;  // points and curves are not shown
        part.colour = colour_of(colours_, label);
        part.material = material_of(label);
        part.faces.resize(static_cast<std::size_t>(faces.Extent()));
        style_faces(label, faces, part);
        known->second = static_cast<int>(result_.parts.size());
        result_.parts.push_back(std::move(part));
        return known->second;
    }

    // Applies the styles of solids first, then of shells, then of faces, so that the most specific one wins.
    void style_faces(const TDF_Label& label, const FaceMap& faces, StepPart& part) const {
        TDF_LabelSequence labels;
        XCAFDoc_ShapeTool::GetSubShapes(label, labels);
        struct Styled {
            TopoDS_Shape shape;
            FaceStyle style;
        };
        std::vector<Styled> styled;
        for (const TDF_Label& sub : labels)
            styled.push_back({XCAFDoc_ShapeTool::GetShape(sub), {colour_of(colours_, sub), name_of(sub)}});
        std::stable_sort(styled.begin(), styled.end(), [](const Styled& a, const Styled& b) {
            return a.shape.ShapeType() < b.shape.ShapeType();
        });
        for (const Styled& one : styled) {
            if (one.shape.ShapeType() > TopAbs_FACE) continue;
            const FaceMap inside = faces_of(one.shape);
            for (int i = 1; i <= inside.Extent(); ++i) {
                const int index = faces.FindIndex(inside(i));
                if (index == 0) continue;
                FaceStyle& face = part.faces[static_cast<std::size_t>(index - 1)];
                if (one.style.colour) face.colour = one.style.colour;
                if (is_meaningful_name(one.style.name)) face.name = one.style.name;
            }
        }
    }
};

Result<StepDocument> read(const std::filesystem::path& path, const ReadProgress& progress) {
    Message::DefaultMessenger()->ChangePrinters().Clear();
    STEPCAFControl_Controller::Init();
    Interface_Static::SetCVal("xstep.cascade.unit", "MM");
    Interface_Static::SetIVal("read.stepcaf.subshapes.name", 1);
    STEPCAFControl_Reader reader;
    reader.SetColorMode(true);
    reader.SetNameMode(true);
    reader.SetMatMode(true);
    reader.SetSHUOMode(true);
    reader.SetLayerMode(false);
    reader.SetPropsMode(false);
    reader.SetGDTMode(false);
    reader.SetViewMode(false);
    progress(0.0, path.filename().string());
    if (reader.ReadFile(path.c_str()) != IFSelect_RetDone)
        return refuse(path, "the file violates ISO 10303-21", "a STEP file as a CAD program exports it");
    StepDocument result;
    TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
    reader.ChangeReader().FileUnits(lengths, angles, solid_angles);
    if (!lengths.IsEmpty()) {
        TCollection_AsciiString unit(lengths.First());
        unit.LowerCase();  // "INCH", but "millimetre"
        result.unit = unit.ToCString();
    }
    progress(0.3, path.filename().string());

    const Handle(XCAFApp_Application) application = XCAFApp_Application::GetApplication();
    Handle(TDocStd_Document) document;
    application->NewDocument("MDTV-XCAF", document);
    const Handle(OccProgress) indicator =
        new OccProgress([&](double fraction) { progress(0.3 + 0.7 * fraction, path.filename().string()); });
    const bool transferred = reader.Transfer(document, indicator->Start());
    const Interface_CheckIterator checks = reader.Reader().WS()->ModelCheckList();
    int invalid = 0;
    for (checks.Start(); checks.More(); checks.Next()) invalid += checks.Value()->HasFailed() ? 1 : 0;
    if (invalid > 0) result.warnings.push_back(fmt::format("{} records of the file are invalid", invalid));
    bool complete = true;
    if (transferred) complete = DocumentWalker(document, result).run();
    application->Close(document);
    if (!complete)
        return refuse(path, "the assembly is too large",
                      fmt::format("at most {} instances in {} levels", max_instances, max_levels));
    if (result.parts.empty())
        return refuse(path, "the file has no shape",
                      "solids or shells (exported as B-rep, not as a tessellation or a drawing)");
    return result;
}

}  // namespace

Result<StepDocument> read_step(const std::filesystem::path& path, const ReadProgress& progress) {
    if (Status checked = check_file(path); !checked) return fail(checked.error());
    try {
        return read(path, progress);
    } catch (const Standard_OutOfMemory&) {
        throw;
    } catch (const Standard_Failure& failure) {
        return refuse(path, fmt::format("cannot be read: {}", failure.GetMessageString()),
                      "a STEP file as a CAD program exports it");
    }
}

}  // namespace bolt::step_import
