#include "data_faults/run_evidence.hpp"

#include <fmt/format.h>

#include <cmath>

#include "bench/noise_floor.hpp"
#include "calib/fit_results.hpp"

namespace pmg::data_faults {

std::vector<DataFault> clearest(const std::vector<Explained>& explanations) {
  const Explained* best = nullptr;
  for (const Explained& one : explanations) {
    if (one.sure && (best == nullptr || one.gain > best->gain)) best = &one;
  }
  if (best == nullptr) return {};
  return {best->fault};
}

double log_error_standing_still(const calib::SingleJoint& joint) {
  const double noise_rad = bench::sensor_noise_rad(joint.run().recording);
  return 0.5 * std::log(calib::standing_still({joint}).mean_square_rad2() + noise_rad * noise_rad);
}

bool mends(const Examined& e, std::size_t run, double before, double after) {
  if (before < e.log_floor()) return false;
  if (after > log_error_standing_still(e.model().joint(e.runs()[run])) + std::log(calib::kExplainedShare)) return false;
  return after < e.usual_log_error() || before - after > std::log(e.options().overwhelming_gain);
}

double log_error_with(const Examined& e, std::size_t run, const bench::Correction& fix) {
  bench::BenchRun corrected = e.runs()[run];
  bench::correct(corrected, fix);
  return e.model().log_error(e.model().joint(corrected), e.fitted().model);
}

std::string gain_text(const Examined& e, double before, double after) {
  const char* unit = e.linear() ? "m" : "rad";
  return fmt::format("the model that fits the other runs misses this one by {:.3g} {} as it is, by {:.3g} {} corrected",
                     std::exp(before), unit, std::exp(after), unit);
}

bool same_condition(const bench::BenchRun& a, const bench::BenchRun& b) {
  return a.kp == b.kp && a.kd == b.kd && a.load == b.load;
}

std::vector<std::size_t> repeats_of(const Examined& e, std::size_t run) {
  const bench::BenchRun& one = e.runs()[run];
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < e.runs().size(); ++i) {
    if (i != run && e.runs()[i].trajectory == one.trajectory && same_condition(e.runs()[i], one)) found.push_back(i);
  }
  return found;
}

std::vector<std::size_t> siblings(const Examined& e, std::size_t run) {
  std::vector<std::size_t> repeats = repeats_of(e, run), trajectory, others;
  for (std::size_t i = 0; i < e.runs().size(); ++i) {
    if (i == run) continue;
    others.push_back(i);
    if (e.runs()[i].trajectory == e.runs()[run].trajectory) trajectory.push_back(i);
  }
  return !repeats.empty() ? repeats : !trajectory.empty() ? trajectory : others;
}

}  // namespace pmg::data_faults
