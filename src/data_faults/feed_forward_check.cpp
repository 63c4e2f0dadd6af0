#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "data_faults/column_checks.hpp"
#include "data_faults/shared_checks.hpp"

namespace pmg::data_faults {

namespace {

constexpr int kIterations = 5;

}  // namespace

std::vector<DataFault> feed_forward_fault(const Examined& e) {
  const DataFaultOptions& o = e.options();
  std::vector<std::size_t> with;
  double largest = 0.0;
  for (std::size_t i = 0; i < e.few().size(); ++i) {
    const std::vector<double>& tau = e.runs()[e.few()[i]].recording.tau_ff_Nm;
    if (tau.empty() || std::all_of(tau.begin(), tau.end(), [](double v) { return v == 0.0; })) continue;
    with.push_back(i);
    for (const double value : tau) largest = std::max(largest, std::abs(value));
  }
  if (with.empty()) return {};
  const std::vector<calib::SingleJoint> joints = e.few_of(e.runs());
  const double constant = e.fitted().model.actuator.drive.torque_per_unit_Nm;
  const bool volts = e.bench().law == bench::DriveLaw::kCascadePd || e.bench().law == bench::DriveLaw::kServoVoltage;
  struct Candidate {
    std::string what;
    double factor;
  };
  std::vector<Candidate> candidates = {{"as it is", 1.0},
                                       {"thousandths of its unit", 1e-3},
                                       {"thousands of its unit", 1e3},
                                       {"kilogram-force", 9.80665},
                                       {"kilogram-force centimetres", 0.0980665},
                                       {"another unit", 4.0},
                                       {"another unit", 0.25},
                                       {"another unit", 0.0}};
  if (volts) {
    candidates.push_back({"volts", constant});
    candidates.push_back({"newtons that were divided by the torque constant twice", 1.0 / constant});
    if (e.bench().law == bench::DriveLaw::kServoVoltage) candidates.push_back({"duty", constant * e.bench().supply_V});
  }
  struct Outcome {
    double factor = 1.0, loss = 0.0;
    std::string what;
    QuickFit fit;
  };
  std::vector<Outcome> outcomes;
  for (const double sign : {1.0, -1.0}) {
    for (const Candidate& candidate : candidates) {
      if (sign < 0.0 && candidate.factor == 0.0) continue;
      QuickFit from = e.fitted();
      from.model.feed_forward_scale = sign * candidate.factor;
      const std::vector<double> logs = e.model().log_errors(joints, from.model);
      double loss = 0.0;
      for (const double log : logs) loss += log / static_cast<double>(logs.size());
      outcomes.push_back({sign * candidate.factor, loss, candidate.what, from});
    }
  }
  std::stable_sort(outcomes.begin() + 1, outcomes.end(),
                   [](const Outcome& a, const Outcome& b) { return a.loss < b.loss; });
  constexpr std::size_t kRefitted = 6;
  outcomes.resize(std::min(outcomes.size(), kRefitted));
  for (Outcome& outcome : outcomes) {
    outcome.fit = e.model().refit(joints, outcome.fit, {}, kIterations);
    outcome.loss = outcome.fit.loss;
  }
  const Outcome as_is = outcomes.front();
  const Outcome best = *std::min_element(outcomes.begin(), outcomes.end(),
                                         [](const Outcome& a, const Outcome& b) { return a.loss < b.loss; });
  const double share = static_cast<double>(with.size()) / static_cast<double>(joints.size());
  if (best.factor == 1.0 || best.factor == 0.0 || as_is.loss - best.loss < share * std::log(o.feed_forward_gain))
    return {};
  const bool sign_only = best.factor == -1.0;
  const std::string column = bench::column_name(bench::Column::kFeedForward, e.linear());
  DataFault fault{.kind = sign_only ? Kind::kSign : Kind::kUnit, .where = place_of(column, {}), .correction = {}};
  fault.correction = sign_only ? fmt::format("turn the sign of {}", column)
                               : fmt::format("{} is in {}: multiply it by {:.5g}", column, best.what, best.factor);
  fault.evidence = {fmt::format("the model's error falls to {:.2g} of what it is without the correction",
                                std::exp((best.loss - as_is.loss) / share))};
  fault.fixes = {{.files = {}, .columns = {bench::Column::kFeedForward}, .factor = best.factor}};
  return {fault};
}

}  // namespace pmg::data_faults
