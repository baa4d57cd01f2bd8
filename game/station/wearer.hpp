// Whose hand is in the glove: the calibration that is kept of it, and how it lies at a wrench.
#pragma once

#include <filesystem>

#include "content/format/assembly.hpp"
#include "content/trainee/glove_calibration.hpp"
#include "haptics/glove/driver.hpp"
#include "haptics/station/hand.hpp"

namespace bolt::station {

// Where calibrations are kept unless somebody says otherwise, by the XDG base directory specification.
Result<std::filesystem::path> calibrations_folder();

// What is on the driver's port, as soon as it has given a sample. An error: nothing that is a glove, and what
// to do.
Result<glove::Identity> await_glove(glove::Driver& driver, const std::filesystem::path& port);

// What to do about an adapter that keeps a glove's bytes back, in words; empty: it does not.
std::string about_adapter(const std::filesystem::path& port);

// The trainee's calibration of that glove. `folder` empty: where they are kept.
Result<content::GloveCalibration> calibration_of(const std::string& trainee, const glove::Identity& glove,
                                                 const std::filesystem::path& folder = {});

// A hand at the handle, `along` it (m), the thumb towards the jaw, the palm on the side that its normal
// points to; as near as can be to where hands hold wrenches, and such that closing it takes hold. In the
// tool's frame.
Pose wrist_at_handle(const hand::Hand& hand, const contact::ToolShape& tool, double along);

// The hand that wears it, at the assembly's wrench. An error: that has no model to close on.
Result<HandPlan> hand_plan(const content::Assembly& assembly, const content::GloveCalibration& calibration);

}  // namespace bolt::station
