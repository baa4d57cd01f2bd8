// A shipped assembly reduced to its first joint, which is run down and then tightened to its full torque, so
// that the last step comes soon.
#pragma once

#include "tests/support/folder.hpp"

namespace bolt::test {

class OneJoint {
  public:
    // `thread_direction`: "right" or "left".
    explicit OneJoint(const char* assembly, const char* thread_direction = "right");
    // For content::load_assembly.
    [[nodiscard]] std::string name() const { return (folder_ / "one").string(); }
    [[nodiscard]] const Folder& folder() const { return folder_; }

  private:
    Folder folder_;
};

}  // namespace bolt::test
