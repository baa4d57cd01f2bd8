// Delivers a trainee's hands to a trainer without a window and without a headset: as its
// immersive frames.
#pragma once

#include "tests/room/trainee_in_room.hpp"
#include "tests/trainer_app/headless_trainer.hpp"

namespace bolt::test {

class ImmersiveDriver final : public RoomDriver {
  public:
    // `trainer.immersive` must be set in each frame.
    explicit ImmersiveDriver(HeadlessTrainer& trainer) : trainer_(trainer) {}

    void frame(const Pose& head, const xr::Hands& hands) override {
        trainer_.immersive->head = head;
        for (view::EyeGroup& group : trainer_.immersive->groups) group = two_eyes(head, group.size);
        trainer_.immersive->hands = hands;
        trainer_.frame();
    }
    [[nodiscard]] const trainer::App& app() const override { return trainer_.app(); }
    [[nodiscard]] double step() const override { return trainer_.step(); }

  private:
    HeadlessTrainer& trainer_;
};

}  // namespace bolt::test
