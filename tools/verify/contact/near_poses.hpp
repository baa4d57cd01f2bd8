// Random poses of the wrench near obstacles, and the contacts that find_contacts returns there against the
// contact oracle.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/verify/contact/scene.hpp"

namespace bolt::contact_validation {

struct NearOptions {
    std::size_t poses = 100'000;
    std::uint64_t seed = 1;
    unsigned threads = 1;
    double band = 2e-3;  // m, the band of the contact queries
};

struct NearPose {
    Pose tool;
    Meeting truth;
    Meeting points;      // of the points alone that the finder looks at
    bool found = false;  // any contact
    double told = 0.0;   // m, the nearest of them
    // m, by which a contact is not where it says, off a surface or longer than its distance: of points, of
    // pieces of edges (a row of short ones is taken for straight).
    double off = 0.0, off_edges = 0.0;
    double wrong = 0.0;  // m, by which the distance of a contact is not that of its point
};

// Places come to from outside until they just touch, and many poses about each: by up to 1.5 mm and 1°
// somewhere else, some free, some crossing. The same for the same seed, whatever the number of threads.
std::vector<NearPose> near_poses(const Scene& scene, const collision::World& world,
                                 const collision::ToolShape& tool, const NearOptions& options);

// Truly inside by more than 0.1 mm: told to be outside, and not told within the 0.1 mm that contact keeps as
// a margin for what lies between the finder's points.
bool told_outside(const NearPose& pose);
bool missed(const NearPose& pose);

struct NearSummary {
    std::size_t poses = 0, free = 0, near = 0, crossing = 0, deep = 0;  // deep: by more than 0.1 mm
    std::size_t told_outside = 0, missed = 0;
    double deepest_untold = 0.0;  // m, of crossings that are not told to be inside
    // The worst of NearPose.
    double off = 0.0, off_edges = 0.0, wrong = 0.0;
    // Nearer than it is: the nearest contact less the true gap. Later: the other way round. Of the points:
    // what should be told of the points alone.
    double nearer = 0.0, later = 0.0, later_than_points = 0.0, later_p50 = 0.0, later_p99 = 0.0;
    double within_micrometre = 0.0;  // share of the gaps
    double shallower_than_points = 0.0;
};

NearSummary summarize(const std::vector<NearPose>& poses, double band);
std::string to_text(const NearSummary& summary);
std::string to_text(const Pose& pose);

}  // namespace bolt::contact_validation
