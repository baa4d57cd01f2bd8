// An assembly of ours reduced to its first joint: run down, then tightened in full. Its last step is soon
// due.
#pragma once

#include "tests/support/folder.hpp"

namespace bolt::test {

class OneJoint {
  public:
    explicit OneJoint(const char* assembly);
    [[nodiscard]] std::string name() const {
        return (folder_ / "one").string();
    }  // as load_assembly takes it
    [[nodiscard]] const Folder& folder() const { return folder_; }

  private:
    Folder folder_;
};

}  // namespace bolt::test
