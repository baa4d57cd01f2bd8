// An assembly in the menu, with its texts and what can be chosen for a lesson with it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "content/format/assembly.hpp"
#include "content/words/words.hpp"
#include "engine/ui/ui.hpp"

namespace bolt::trainer {

// One variant, or the assembly without a variant, as the menu lists it.
struct VariantEntry {
    content::AssemblyVariant variant;
    std::map<std::string, std::string> lesson_texts;  // by language
    std::vector<content::Tool> tools;                 // to choose from, the default one first
    std::size_t joints = 0;
    std::string sizes;  // of the bolts: "M16×180, M16×75"
};

struct AssemblyEntry {
    std::string name, default_variant;
    std::map<std::string, std::string> title;  // by language
    std::vector<VariantEntry> variants;        // at least one, the default one first
    joint::Law law = joint::Law::mechanistic;  // the assembly's own
    bool contact_model = false;                // the assembly has one
    std::optional<Error> error;                // why no lesson can start
};

// All assemblies of content::assembly_names() except the tour's, also those with errors.
std::vector<AssemblyEntry> list_assemblies();

// The text in `language`, else in English, else `fallback`.
std::string in_language(const std::map<std::string, std::string>& texts, const std::string& language,
                        const std::string& fallback);

// The variant of this name; empty or unknown: the default one.
const VariantEntry& variant_of(const AssemblyEntry& entry, const std::string& variant);

// The number of joints and the sizes of the bolts, in words.
std::string joints_text(const words::Words& words, const VariantEntry& variant);

// Adds the characters of all its texts to the interface's font.
void add_characters(ui::Ui& ui, const AssemblyEntry& entry);

}  // namespace bolt::trainer
