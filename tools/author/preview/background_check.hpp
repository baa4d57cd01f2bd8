// Checks an assembly on another thread, so that the window keeps drawing.
#pragma once

#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "content/format/assembly.hpp"
#include "tools/author/geometry/check.hpp"

namespace bolt::author {

// One variant of an assembly with what `validate` reports about it.
struct CheckedAssembly {
    content::Assembly assembly;
    geometry::Findings findings;
    std::optional<geometry::DrawnToolRooms> rooms;  // none: the assembly has no model
};

// A mistake, and the joint that it is about.
struct Problem {
    Error error;
    std::optional<std::size_t> joint;  // index into Assembly::joints; none: no single joint
};

// In the order of the file. A mistake of a joint that the variant leaves out belongs to no joint.
std::vector<Problem> problems_of(const CheckedAssembly& checked);

// "B1: the wrench has 12 degrees of free swing …; expected …": without file, line and column.
std::string problem_text(const CheckedAssembly& checked, const Problem& problem);

class BackgroundCheck {
  public:
    // Waits until every check has stopped.
    ~BackgroundCheck();
    BackgroundCheck() = default;
    BackgroundCheck(const BackgroundCheck&) = delete;
    BackgroundCheck& operator=(const BackgroundCheck&) = delete;

    // Checks what the files contain now. A check that still runs is stopped, and its result is lost.
    void start(const std::string& source, const std::string& variant);

    // Returns the result of the last start() once, after the check has ended; null before and afterwards.
    std::unique_ptr<CheckedAssembly> take_result();

    [[nodiscard]] bool is_running() const { return running_.result.valid(); }
    // Checked joints and their number; 0 of 0 while the models are being read.
    [[nodiscard]] std::pair<std::size_t, std::size_t> progress() const;

  private:
    struct Run {
        std::shared_ptr<geometry::CheckProgress> progress;
        std::future<std::unique_ptr<CheckedAssembly>> result;
    };
    Run running_;
    std::vector<Run> stopping_;
};

}  // namespace bolt::author
