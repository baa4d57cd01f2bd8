// Two pages of the menu: the check of this computer, and the places of the user's files.
#pragma once

#include <filesystem>
#include <functional>
#include <future>
#include <vector>

#include "game/computer/computer.hpp"
#include "game/trainer/screens.hpp"

namespace bolt::trainer {

enum class MenuPage : std::uint8_t { choices, computer, files };

// The folders of the user's files. An empty path: such files are not kept.
struct UserFolders {
    std::filesystem::path sessions;
    bool folder_per_lesson = false;  // each lesson has a folder in `sessions`
    std::filesystem::path settings, assemblies;
};

// Checks the computer in the background: first without the timing of the servo, which takes seconds, then
// with it.
class ComputerCheck {
  public:
    using GatherFacts = std::function<computer::ComputerFacts(const computer::FactsRequest&)>;
    // Does nothing while a check runs.
    void start(GatherFacts gather_facts, const computer::FactsRequest& request);
    // Call it every frame of the page.
    void update();
    // The findings of the check so far; empty at first.
    [[nodiscard]] const std::vector<computer::Finding>& findings() const { return findings_; }
    [[nodiscard]] bool running() const { return running_.valid(); }

  private:
    GatherFacts gather_facts_;
    computer::FactsRequest request_;
    std::future<computer::ComputerFacts> running_;
    bool with_timing_ = false;
    std::vector<computer::Finding> findings_;
};

ScreenAction draw_computer_page(const ScreenContext& context, const ComputerCheck& check);
ScreenAction draw_files_page(const ScreenContext& context, const UserFolders& folders);

}  // namespace bolt::trainer
