#include "tools/assets/models/document.hpp"

#include <fmt/format.h>

#include <APIHeaderSection_MakeHeader.hxx>
#include <Interface_Protocol.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <STEPControl_Controller.hxx>
#include <StepBasic_Product.hxx>
#include <StepBasic_ProductDefinition.hxx>
#include <StepBasic_ProductDefinitionFormation.hxx>
#include <StepData_Protocol.hxx>
#include <StepData_StepModel.hxx>
#include <StepData_StepWriter.hxx>
#include <StepRepr_NextAssemblyUsageOccurrence.hxx>
#include <StepVisual_MechanicalDesignGeometricPresentationRepresentation.hxx>
#include <StepVisual_StyledItem.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_Label.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_WorkSession.hxx>
#include <fstream>
#include <map>
#include <set>
#include <vector>

namespace bolt::models {

namespace {

Handle(TCollection_HAsciiString) text(const std::string& value) {
    return new TCollection_HAsciiString(value.c_str());
}

Quantity_Color colour(Finish finish) {
    const auto channel = [&](unsigned shift) { return ((finish.srgb >> shift) & 255U) / 255.0; };
    return {channel(16), channel(8), channel(0), Quantity_TOC_sRGB};
}

// Stops OpenCASCADE from reporting its progress on stdout.
void silence_progress() {
    for (Message_SequenceOfPrinters::Iterator printer(Message::DefaultMessenger()->Printers());
         printer.More(); printer.Next())
        printer.Value()->SetTraceLevel(Message_Fail);
}

// The names of each group's children, in the order in which they were added.
using InstanceNames = std::map<std::string, std::vector<std::string>>;

// Makes ids and names depend on the document alone. The writer's running numbers continue from file to file
// within a process, and it loses some names of instances.
void restore_names(const Handle(StepData_StepModel) & model, const InstanceNames& instances) {
    std::map<std::string, std::size_t> used_names;
    int use = 0;
    for (int i = 1; i <= model->NbEntities(); ++i) {
        const Handle(Standard_Transient) entity = model->Value(i);
        if (const auto product = Handle(StepBasic_Product)::DownCast(entity); !product.IsNull())
            product->SetId(product->Name());
        const auto occurrence = Handle(StepRepr_NextAssemblyUsageOccurrence)::DownCast(entity);
        if (occurrence.IsNull()) continue;
        const std::string parent =
            occurrence->RelatingProductDefinition()->Formation()->OfProduct()->Name()->ToCString();
        occurrence->SetId(text(std::to_string(++use)));
        const auto names = instances.find(parent);
        if (names != instances.end() && used_names[parent] < names->second.size())
            occurrence->SetName(text(names->second[used_names[parent]++]));
    }
}

// Returns the same entities in an order that does not depend on addresses. The writer appends the colours of
// the parts in the order of a hash table; here they follow the order of the parts.
Handle(StepData_StepModel)
    in_part_order(const Handle(StepData_StepModel) & model, const Interface_Protocol& protocol) {
    using StyledRepresentation = StepVisual_MechanicalDesignGeometricPresentationRepresentation;
    Handle(StepData_StepModel) ordered = Handle(StepData_StepModel)::DownCast(model->NewEmptyModel());
    std::map<int, Handle(StyledRepresentation)> styles;
    for (int i = 1; i <= model->NbEntities(); ++i) {
        const auto style = Handle(StyledRepresentation)::DownCast(model->Value(i));
        if (!style.IsNull()) {
            const auto first = Handle(StepVisual_StyledItem)::DownCast(style->ItemsValue(1));
            styles.emplace(first.IsNull() ? i : model->Number(first->Item()), style);
        } else if (styles.empty()) {
            ordered->AddEntity(model->Value(i));
        }
    }
    for (const auto& [number, style] : styles) ordered->AddWithRefs(style, &protocol);
    for (int i = 1; i <= model->NbEntities(); ++i)
        if (!ordered->Contains(model->Value(i))) ordered->AddEntity(model->Value(i));
    return ordered;
}

// The header names the program that wrote the file, but neither date nor folder: equal documents give equal
// bytes.
void set_header(const Handle(StepData_StepModel) & model, const std::string& name) {
    APIHeaderSection_MakeHeader header(0);
    header.SetName(text(name));
    header.SetTimeStamp(text("2020-01-01T00:00:00"));
    header.SetAuthorValue(1, text("Boltwright"));
    header.SetOrganizationValue(1, text("Boltwright"));
    header.SetPreprocessorVersion(text("Open CASCADE STEP processor"));
    header.SetOriginatingSystem(text("bolt-models"));
    header.SetAuthorisation(text(""));
    header.SetDescriptionValue(1, text(name));
    header.SetSchemaIdentifiersValue(1, text("AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }"));
    header.Apply(model);
}

}  // namespace

struct CadDocument::State {
    std::string name;
    Handle(TDocStd_Document) document = new TDocStd_Document("MDTV-XCAF");
    Handle(XCAFDoc_ShapeTool) shapes;
    Handle(XCAFDoc_ColorTool) colours;
    std::vector<TDF_Label> groups;
    std::vector<std::string> group_names;
    InstanceNames instances;
    std::vector<TDF_Label> parts;
    std::set<std::string, std::less<>> part_names, node_names;
    std::string duplicate_name;  // the first name that was used twice

    void reserve(std::set<std::string, std::less<>>& names, std::string_view name_to_add) {
        if (!names.emplace(name_to_add).second && duplicate_name.empty()) duplicate_name = name_to_add;
    }

    TDF_Label new_group(std::string_view group) {
        const TDF_Label label = shapes->NewShape();
        TDataStd_Name::Set(label, std::string(group).c_str());
        groups.push_back(label);
        group_names.emplace_back(group);
        return label;
    }

    void add_component(CadGroup parent, const TDF_Label& child, std::string_view instance,
                       const gp_Trsf& placement) {
        reserve(node_names, instance);
        instances[group_names[static_cast<std::size_t>(parent.id)]].emplace_back(instance);
        const TDF_Label component = shapes->AddComponent(groups[static_cast<std::size_t>(parent.id)], child,
                                                         TopLoc_Location(placement));
        TDataStd_Name::Set(component, std::string(instance).c_str());
    }
};

CadDocument::CadDocument(std::string_view name) : state_(std::make_unique<State>()) {
    XCAFDoc_ShapeTool::SetAutoNaming(Standard_False);
    state_->name = name;
    state_->shapes = XCAFDoc_DocumentTool::ShapeTool(state_->document->Main());
    state_->colours = XCAFDoc_DocumentTool::ColorTool(state_->document->Main());
    state_->reserve(state_->node_names, name);
    state_->new_group(name);
}

CadDocument::~CadDocument() = default;
CadDocument::CadDocument(CadDocument&&) noexcept = default;
CadDocument& CadDocument::operator=(CadDocument&&) noexcept = default;

CadPart CadDocument::add_part(std::string_view name, const TopoDS_Shape& shape, Finish finish,
                              std::span<const FaceFinish> faces) {
    state_->reserve(state_->part_names, name);
    const TDF_Label label = state_->shapes->AddShape(shape, Standard_False);
    TDataStd_Name::Set(label, std::string(name).c_str());
    state_->colours->SetColor(label, colour(finish), XCAFDoc_ColorSurf);
    for (const FaceFinish& face : faces) {
        TDF_Label sub;
        state_->shapes->AddSubShape(label, face.face, sub);
        if (!sub.IsNull()) state_->colours->SetColor(sub, colour(face.finish), XCAFDoc_ColorSurf);
    }
    state_->parts.push_back(label);
    return {static_cast<int>(state_->parts.size()) - 1};
}

CadGroup CadDocument::add_group(CadGroup parent, std::string_view name, const gp_Trsf& placement) {
    const TDF_Label label = state_->new_group(name);
    state_->add_component(parent, label, name, placement);
    return {static_cast<int>(state_->groups.size()) - 1};
}

void CadDocument::add_instance(CadGroup parent, std::string_view name, CadPart part,
                               const gp_Trsf& placement) {
    state_->add_component(parent, state_->parts[static_cast<std::size_t>(part.id)], name, placement);
}

Status CadDocument::write_step(const std::string& path) {
    if (!state_->duplicate_name.empty())
        return fail(ErrorCode::bad_content,
                    fmt::format("{}: the name \"{}\" is used twice", path, state_->duplicate_name),
                    "a unique name for every part, group and instance");
    state_->shapes->UpdateAssemblies();
    STEPControl_Controller::Init();
    Interface_Static::SetCVal("write.step.schema", "AP214IS");
    Interface_Static::SetCVal("write.step.unit", "MM");
    Interface_Static::SetIVal("write.step.assembly", 1);
    Interface_Static::SetIVal("write.surfacecurve.mode", 0);
    silence_progress();
    STEPCAFControl_Writer writer;
    writer.SetColorMode(Standard_True);
    writer.SetNameMode(Standard_True);
    writer.SetLayerMode(Standard_False);
    writer.SetPropsMode(Standard_False);
    if (!writer.Transfer(state_->document, STEPControl_AsIs))
        return fail(ErrorCode::failed, fmt::format("{}: the model cannot be converted to STEP", path),
                    "a document that OpenCASCADE can write");
    const auto protocol = Handle(StepData_Protocol)::DownCast(writer.ChangeWriter().WS()->Protocol());
    restore_names(writer.ChangeWriter().Model(), state_->instances);
    const Handle(StepData_StepModel) model = in_part_order(writer.ChangeWriter().Model(), *protocol);
    set_header(model, state_->name);
    StepData_StepWriter step(model);
    step.SendModel(protocol);
    std::ofstream file(path, std::ios::binary);
    if (!step.Print(file) || !file.flush())
        return fail(ErrorCode::failed, fmt::format("{}: cannot be written", path),
                    "a path in a writable folder");
    return {};
}

}  // namespace bolt::models
