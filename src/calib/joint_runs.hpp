// Reads and selects recorded runs for simulation, and keeps fitted and scored runs apart.
#pragma once

#include <string>
#include <vector>

#include "calib/single_joint.hpp"
#include "work/progress.hpp"

namespace pmg::calib {

/// (bench, rows of runs.csv as bench::RowFilter, step of the simulation [s]) => (runs). Throws as Bench::read_runs.
std::vector<SingleJoint> read_joints(const bench::Bench& bench, const std::string& filter, double step_s,
                                     const work::Progress& progress = {});

/// (runs) => (at most `most` of them), spread over the list by steps of the golden ratio, to avoid its periods.
std::vector<SingleJoint> spread(const std::vector<SingleJoint>& runs, std::size_t most);

/// Throws std::invalid_argument that names a run in both lists: a score of a fitted run is worthless.
void expect_apart(const std::vector<SingleJoint>& fitted, const std::vector<SingleJoint>& scored);

}  // namespace pmg::calib
