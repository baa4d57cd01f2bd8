// A shipped assembly reduced to its first joint, which is run down and then tightened to its full torque, so
// that the last step comes soon.
#pragma once

#include "tests/support/folder.hpp"

namespace bolt::test {

class OneJoint {
  public:
    explicit OneJoint(const char* assembly);
    // For content::load_assembly.
    [[nodiscard]] std::string name() const { return (folder_ / "one").string(); }
    [[nodiscard]] const Folder& folder() const { return folder_; }

  private:
    Folder folder_;
};

}  // namespace bolt::test
