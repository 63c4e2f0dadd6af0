// Between which recordings a sensor's zero slipped. Rollouts jump with it, so it is searched and not fitted.
#pragma once

#include <string>
#include <vector>

#include "effects/nested_fit.hpp"

namespace pmg::effects {

/// Recordings on each side of a slip: one that differs from all others has a fault of its own.
constexpr std::size_t kFewestBesideSlip = 2;

/// True for the place of a slip among the recordings.
bool is_place(const std::string& parameter);

/// (runs) => (places of a slip: in the middle between two runs that follow each other, in their order). Only where all
/// trajectories were recorded before it and after it: what differs between two of them is no slip, and runs.csv may be
/// sorted by them. (With the load the arm may be mounted anew, which is when a zero slips.)
std::vector<double> slip_places(const std::vector<calib::SingleJoint>& runs);

/// (model with a slip) => (the place at which its runs' squares are lowest, all other numbers as they are). Costs two
/// rollouts of every run.
double best_slip_place(const NestedFit& fit, calib::JointModel model);

/// The runs between which a zero slipped; null where there is none.
struct SlipGap {
  const bench::BenchRun *before = nullptr, *after = nullptr;
};

/// (runs, place of a slip) => (the last run before it and the first one after it). They point to the runs.
SlipGap slip_gap(const std::vector<calib::SingleJoint>& runs, double place);

}  // namespace pmg::effects
