// Progress of OpenCASCADE's long steps, passed on as a fraction.
#pragma once

#include <Message_ProgressIndicator.hxx>
#include <functional>
#include <utility>

namespace bolt::step_import {

class OccProgress : public Message_ProgressIndicator {
  public:
    explicit OccProgress(std::function<void(double)> report) : report_(std::move(report)) {}

  protected:
    void Show(const Message_ProgressScope& /*scope*/, Standard_Boolean /*force*/) override {
        report_(GetPosition());
    }

  private:
    std::function<void(double)> report_;
};

}  // namespace bolt::step_import
