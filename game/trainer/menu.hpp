// The menu: the assemblies with their pictures, and the choices for a lesson. It opens two pages.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "content/words/words.hpp"
#include "engine/ui/ui.hpp"
#include "game/trainer/assembly_entry.hpp"
#include "game/trainer/assembly_pictures.hpp"
#include "game/trainer/lesson_choice.hpp"
#include "game/trainer/menu_choices.hpp"
#include "game/trainer/menu_pages.hpp"
#include "game/trainer/preferences.hpp"
#include "game/trainer/screens.hpp"

namespace bolt::trainer {

struct Menu {
    std::vector<AssemblyEntry> assemblies;
    std::vector<DeviceOption> devices;
    UserFolders folders;
    bool first_start = false;  // the tour is offered first
    MenuPage page = MenuPage::choices;
    ComputerCheck check;
    glm::vec2 covered{0.0F};  // px that the menu covered in the last frame, at the left and at the bottom
    // Assembly, language and window size for which two columns did not fit: the menu is then one column that
    // scrolls.
    std::string single_column_for;
    std::optional<Error> start_error;  // why the last lesson could not start
    SelectedTrainee trainee;           // whom LessonChoice::trainee meant when it was last entered
};

// Pictures of the renderer for the interface; valid in this frame.
struct MenuPictures {
    std::map<std::string, ImTextureID> thumbnails;  // by name of the assembly
};

// The pictures that a menu of this size (px) shows. `scale`: px per point.
AssemblyPictures::Request picture_request(const Menu& menu, const std::string& selected, VkExtent2D size,
                                          float scale);

// Adds the characters of the menu's texts to the interface's font: those that never change, and those that
// are not known at the start (names that the trainee types or that devices have, and the reasons in findings
// and errors).
void add_constant_characters(ui::Ui& ui, const Menu& menu);
void add_changing_characters(ui::Ui& ui, const words::Words& words, const Menu& menu,
                             const LessonChoice& choice);

// Draws the page of the menu. It edits `choice`, and the law and language in `preferences`.
ScreenAction draw_menu(const ScreenContext& context, Menu& menu, const MenuPictures& pictures,
                       LessonChoice& choice, Preferences& preferences);

}  // namespace bolt::trainer
