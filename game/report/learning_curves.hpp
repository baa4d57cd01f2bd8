// Learning curves: how each trainee's results change from attempt to attempt.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "game/report/attempts.hpp"

namespace bolt::report {

// Splits `group` by trainee, in the order of each trainee's first attempt. Indices into `attempts`.
std::vector<std::vector<std::size_t>> split_by_trainee(std::span<const Attempt> attempts,
                                                       std::span<const std::size_t> group);

// HTML: the learning curves of one group (attempt_groups), with a set of plots for each trainee that has at
// least two attempts. All sets have the same axes. Several trainees are summarised in a table before the
// plots. Empty if no trainee has two attempts. `linked`: the page has a section for each attempt.
std::string learning_curves_section(std::span<const Attempt> attempts, std::span<const std::size_t> group,
                                    bool linked);

}  // namespace bolt::report
