// Compares the contacts that find_contacts returns at random poses of the wrench near obstacles with the
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
    ExactContact truth;
    ExactContact points;    // of the sample points alone
    bool found = false;     // the query returned a contact
    double reported = 0.0;  // m, signed distance of the nearest contact; the band if there is none
    // m, greatest position error of the contacts of points and of edge pieces: the distance of a witness
    // point from its surface, or the difference of the witness points' distance from the reported distance.
    // Edge pieces are less exact because a row of short edges is treated as straight.
    double point_error = 0.0, edge_error = 0.0;
    double distance_error = 0.0;  // m, error of the distance of the nearest contact, if it is one of a point
};

// Approaches obstacles from outside until the wrench just touches, and perturbs each of these poses many
// times by up to 1.5 mm and 1°, so that some poses are free and some cross. The result depends on the seed
// but not on the number of threads.
std::vector<NearPose> near_poses(const ContactScene& scene, const collision::CollisionWorld& world,
                                 const collision::ToolShape& tool, const NearOptions& options);

// Returns whether the tool is deeper than 0.1 mm, but the query reports no penetration.
bool reported_outside(const NearPose& pose);
// Returns whether the tool is deeper than 0.1 mm, but the query reports no contact, or a gap of 0.1 mm or
// more. Contact keeps that margin because a surface may protrude between its sample points.
bool missed(const NearPose& pose);

struct NearSummary {
    // near: free with a gap within the band; deep: crossing by more than 0.1 mm.
    std::size_t poses = 0, free = 0, near = 0, crossing = 0, deep = 0;
    std::size_t reported_outside = 0, missed = 0;
    double deepest_unreported = 0.0;  // m, greatest depth of a pose reported as outside
    // The greatest errors of all poses.
    double point_error = 0.0, edge_error = 0.0, distance_error = 0.0;
    // Errors of the gap, m. max_gap_underestimate: the greatest of true minus reported. max_gap_overestimate,
    // gap_overestimate_p50 and gap_overestimate_p99: the greatest, the median and the 99th percentile of
    // reported minus true. max_gap_overestimate_points: the greatest of reported minus the gap of the sample
    // points.
    double max_gap_underestimate = 0.0, max_gap_overestimate = 0.0, max_gap_overestimate_points = 0.0;
    double gap_overestimate_p50 = 0.0, gap_overestimate_p99 = 0.0;
    // Fraction of the near poses whose reported gap exceeds the true one by at most 1 um.
    double within_micrometre = 0.0;
    double max_depth_underestimate_points =
        0.0;  // m, greatest depth of the sample points minus the reported one
};

NearSummary summarize(const std::vector<NearPose>& poses, double band);
std::string to_text(const NearSummary& summary);
std::string to_text(const Pose& pose);

}  // namespace bolt::contact_validation
