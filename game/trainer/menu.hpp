// The menu: assemblies with their pictures, the choices for a lesson, and two pages about this computer and
// the user's files.
#pragma once

#include <future>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "content/words/words.hpp"
#include "engine/ui/ui.hpp"
#include "game/computer/computer.hpp"
#include "game/trainer/assembly_pictures.hpp"
#include "game/trainer/lesson_start.hpp"
#include "game/trainer/preferences.hpp"
#include "game/trainer/screens.hpp"

namespace bolt::trainer {

// An assembly in the menu.
struct AssemblyEntry {
    std::string name, default_variant;
    std::map<std::string, std::string> title, instructions;  // by language
    std::vector<content::AssemblyVariant> variants;
    std::vector<content::Tool> tools;
    joint::Law law = joint::Law::mechanistic;
    std::size_t joints = 0;
    std::string sizes;           // of the bolts: "M16×180, M16×75"
    bool contact_model = false;  // for the assembly and its first tool
    std::optional<Error> error;  // why no lesson can start
};

// All assemblies of content::assembly_names() except the tour's, also those with errors.
std::vector<AssemblyEntry> list_assemblies();

// Where the program keeps the user's files; empty: it does not.
struct UserFolders {
    std::filesystem::path sessions;
    bool folder_per_lesson = false;  // each lesson has a folder in `sessions`
    std::filesystem::path settings, assemblies;
};

// Checks the computer in the background: first without the timing of the servo, which takes seconds, then
// with it.
class ComputerCheck {
  public:
    using FindOut = std::function<computer::Facts(const computer::FactsRequest&)>;
    // Does nothing while a check runs.
    void start(FindOut find_out, const computer::FactsRequest& request);
    // Call it every frame of the page.
    void update();
    // Those that are known; empty at first.
    [[nodiscard]] const std::vector<computer::Finding>& findings() const { return findings_; }
    [[nodiscard]] bool running() const { return running_.valid(); }

  private:
    FindOut find_out_;
    computer::FactsRequest request_;
    std::future<computer::Facts> running_;
    bool with_timing_ = false;
    std::vector<computer::Finding> findings_;
};

enum class MenuPage : std::uint8_t { choices, computer, files };

struct Menu {
    std::vector<AssemblyEntry> assemblies;
    std::vector<DeviceOption> devices;
    UserFolders folders;
    bool first_start = false;  // the tour is offered first
    MenuPage page = MenuPage::choices;
    ComputerCheck check;
    glm::vec2 covered{0.0F};  // px, at the left and at the bottom, that the menu covered last
    // Assembly, language and window for which two columns are too tall; drawn in one that scrolls.
    std::string too_tall;
    std::optional<Error> start_error;  // why the last lesson could not start
};

// Pictures of the renderer for the interface; valid in this frame.
struct MenuPictures {
    std::map<std::string, ImTextureID> thumbnails;  // by name of the assembly
};

// The pictures that a menu of this size (px) shows. `scale`: px per point.
AssemblyPictures::Request picture_request(const Menu& menu, const std::string& selected, VkExtent2D size,
                                          float scale);

// Draws the page of the menu. It edits `choice`, and the law and language in `preferences`.
ScreenAction draw_menu(const ScreenContext& context, Menu& menu, const MenuPictures& pictures,
                       LessonChoice& choice, Preferences& preferences);

// Used by draw_menu.
ScreenAction draw_computer_page(const ScreenContext& context, const ComputerCheck& check);
ScreenAction draw_files_page(const ScreenContext& context, const UserFolders& folders);

}  // namespace bolt::trainer
