// The choices of the menu for a lesson: task, mode, variant, tool, law, device and trainee. The trainee is a
// text field; each other choice is a row of buttons, of which one is chosen.
#pragma once

#include <span>

#include "game/trainer/assembly_entry.hpp"
#include "game/trainer/lesson_choice.hpp"
#include "game/trainer/preferences.hpp"
#include "game/trainer/screens.hpp"

namespace bolt::trainer {

struct ChoiceOptions {
    const AssemblyEntry* entry = nullptr;  // the chosen assembly; null: the menu does not list it
    std::span<const DeviceOption> devices;
    const SelectedTrainee& trainee;
};

// Chooses another assembly, with its first variant and the tool of the station.
void choose_assembly(const AssemblyEntry& entry, LessonChoice& choice);

// Draws the rows in `width` px, and what a lesson would lack. Edits `choice`, and the law in `preferences`.
ScreenAction draw_choices(const ScreenContext& context, float width, const ChoiceOptions& options,
                          LessonChoice& choice, Preferences& preferences);

}  // namespace bolt::trainer
