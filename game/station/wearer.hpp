// The wearer of the glove: the stored calibration, and the pose of the hand at a wrench.
#pragma once

#include <filesystem>

#include "content/format/assembly.hpp"
#include "content/trainee/glove_calibration.hpp"
#include "haptics/hand/glove_driver.hpp"
#include "haptics/station/gloved_hand.hpp"

namespace bolt::station_setup {

// The default folder of calibrations, by the XDG base directory specification.
Result<std::filesystem::path> calibrations_folder();

// Waits up to 6 s for the first sample and returns the glove's identity. Fails if the port cannot be opened
// or no glove answers.
Result<hand::GloveIdentity> await_glove(hand::GloveDriver& driver, const std::filesystem::path& port);

// A message if the serial adapter's latency timer delays the glove's bytes; empty if it does not.
std::string about_adapter(const std::filesystem::path& port);

// The trainee's stored calibration for this glove. `folder` empty: calibrations_folder(). Fails if there is
// none for this side or it is for another number of sensors.
Result<content::GloveCalibration> calibration_of(const std::string& trainee, const hand::GloveIdentity& glove,
                                                 const std::filesystem::path& folder = {});

// The pose of the wrist, in the tool's frame, of a hand around the handle at `along` m from the jaw, thumb
// towards the jaw, palm on the side of the tool's normal. The nearest pose to a natural grip at which closing
// the hand grasps the handle.
Pose wrist_at_handle(const hand::Hand& hand, const collision::ToolShape& tool, double along);

// The gloved hand at the assembly's wrench. Fails if the wrench has no contact model.
Result<station::HandSetup> hand_plan(const content::Assembly& assembly,
                                     const content::GloveCalibration& calibration);

}  // namespace bolt::station_setup
