#include "game/trainer/assembly_entry.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "game/session/contact_models.hpp"
#include "game/trainer/tour.hpp"

namespace bolt::trainer {

namespace {

std::string sizes_of(const content::Assembly& assembly) {
    std::vector<std::string> sizes;
    for (const content::AssemblyJoint& joint : assembly.joints) {
        const joint::JointDesign& design = joint.design;
        const std::string size =
            fmt::format("{}×{:.0f}{}", joint::name(design.thread), 1e3 * design.bolt_length,
                        joint::size_suffix(design.thread_direction));
        if (std::find(sizes.begin(), sizes.end(), size) == sizes.end()) sizes.push_back(size);
    }
    std::string text;
    for (const std::string& size : sizes) text += (text.empty() ? "" : ", ") + size;
    return text;
}

VariantEntry variant_entry(const content::Assembly& assembly, content::AssemblyVariant variant) {
    VariantEntry entry{
        std::move(variant), assembly.lesson_texts, {}, assembly.joints.size(), sizes_of(assembly)};
    for (const content::Tool* tool : content::choosable_tools(assembly)) entry.tools.push_back(*tool);
    return entry;
}

// The lesson that is played unless another is chosen comes first: the default variant or, if the file names
// none, the file without a variant, under the assembly's title.
std::vector<VariantEntry> variants_of(const content::Assembly& assembly) {
    std::vector<VariantEntry> entries;
    if (assembly.variant.empty()) entries.push_back(variant_entry(assembly, {"", assembly.title}));
    for (const content::AssemblyVariant& variant : assembly.variants)
        entries.push_back(
            variant.name == assembly.variant
                ? variant_entry(assembly, variant)
                : variant_entry(content::load_assembly(assembly.file, variant.name).assembly, variant));
    std::stable_partition(entries.begin(), entries.end(),
                          [&](const VariantEntry& entry) { return entry.variant.name == assembly.variant; });
    return entries;
}

AssemblyEntry entry_of(const std::string& name) {
    const content::LoadedAssembly loaded = content::load_assembly(content::assembly_folder(name));
    const content::Assembly& assembly = loaded.assembly;
    AssemblyEntry entry{name,
                        assembly.variant,
                        assembly.title,
                        loaded.ok() ? variants_of(assembly) : std::vector<VariantEntry>(1),
                        assembly.law,
                        loaded.ok() && !session::missing_contact_model(assembly),
                        {}};
    if (!loaded.ok()) {
        entry.error = loaded.errors.front();
    } else if (assembly.models.model.empty()) {
        entry.error.emplace();
        entry.error->file = assembly.file;
        entry.error->what = "this assembly has no model to draw";
        entry.error->expected = "\"model\" with the name of a .glb file";
    }
    return entry;
}

}  // namespace

std::vector<AssemblyEntry> list_assemblies() {
    std::vector<AssemblyEntry> entries;
    for (const std::string& name : content::assembly_names())
        if (name != tour_assembly) entries.push_back(entry_of(name));
    return entries;
}

std::string in_language(const std::map<std::string, std::string>& texts, const std::string& language,
                        const std::string& fallback) {
    for (const std::string& code : {language, std::string("en")})
        if (const auto found = texts.find(code); found != texts.end()) return found->second;
    return fallback;
}

const VariantEntry& variant_of(const AssemblyEntry& entry, const std::string& variant) {
    const auto found =
        std::find_if(entry.variants.begin(), entry.variants.end(),
                     [&](const VariantEntry& candidate) { return candidate.variant.name == variant; });
    return found == entry.variants.end() ? entry.variants.front() : *found;
}

std::string joints_text(const words::Words& words, const VariantEntry& variant) {
    if (variant.joints == 1) return words::format_text(words, "menu.facts.one", {{"sizes", variant.sizes}});
    return words::format_text(
        words, "menu.facts.many",
        {{"count", words::Number{static_cast<double>(variant.joints), 0}}, {"sizes", variant.sizes}});
}

void add_characters(ui::Ui& ui, const AssemblyEntry& entry) {
    for (const auto& [code, title] : entry.title) ui.add_characters(title);
    if (entry.error) ui.add_characters(entry.error->message());
    for (const VariantEntry& variant : entry.variants) {
        for (const auto& [code, title] : variant.variant.title) ui.add_characters(title);
        for (const auto& [code, text] : variant.lesson_texts) ui.add_characters(text);
        for (const content::Tool& tool : variant.tools)
            for (const auto& [code, title] : tool.title) ui.add_characters(title);
    }
}

}  // namespace bolt::trainer
