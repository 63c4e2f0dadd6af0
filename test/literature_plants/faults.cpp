#include "faults.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace pmg::literature {

namespace {

enum Kind { kUnits, kDegrees, kSign, kMass, kGain, kSwapped, kShift };

constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;

std::vector<std::size_t> all_runs(const Rig& rig) {
  std::vector<std::size_t> all(rig.runs.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  return all;
}

/// One of the runs that are fitted: a diagnosis doesn't look at the others before it scores.
std::size_t fitted_run(Draw& draw, const Rig& rig) {
  std::size_t run = 0;
  do {
    run = draw.below(rig.runs.size());
  } while (rig.runs[run].scored);
  return run;
}

/// All runs, or one.
std::vector<std::size_t> draw_runs(Draw& draw, const Rig& rig) {
  return draw.chance(0.5) ? all_runs(rig) : std::vector<std::size_t>{fitted_run(draw, rig)};
}

std::string feed_forward_column(const Rig& rig) {
  return rig.healthy.drive.law == Law::kTorque ? "torque_Nm" : rig.feeds_forward ? "tau_ff_Nm" : "";
}

/// Two fitted runs whose row differs in gains or load.
std::vector<std::size_t> draw_pair(Draw& draw, const Rig& rig) {
  for (int attempt = 0; attempt < 1000; ++attempt) {
    const std::size_t a = fitted_run(draw, rig), b = fitted_run(draw, rig);
    const RunDesign &x = rig.runs[a], &y = rig.runs[b];
    if (x.gains != y.gains || x.load != y.load) return {std::min(a, b), std::max(a, b)};
  }
  throw std::runtime_error("no two runs to swap");
}

std::vector<double>& column_of(Recording& r, const std::string& column) {
  return column == "q_rad" ? r.q_rad : column == "q_cmd_rad" ? r.q_cmd_rad : r.feed_forward;
}

/// The column shift samples later; what is missing at an end is what stands there.
void shift(std::vector<double>& values, int by) {
  const std::vector<double> before = values;
  const auto last = static_cast<int>(before.size()) - 1;
  for (int k = 0; k <= last; ++k) {
    values[static_cast<std::size_t>(k)] = before[static_cast<std::size_t>(std::clamp(k - by, 0, last))];
  }
}

}  // namespace

RigNeeds needs_of_fault(std::size_t kind) {
  switch (kind) {
    case kUnits:
      return {kPd | kTorqueLaw, true};
    case kMass:
      return {15, false, true};
    case kGain:
    case kSwapped:
      return {kPd | kServoLaw | kCascadeLaw};
    default:
      return {};
  }
}

DataFault frozen_readings(const Rig& rig) {
  DataFault fault;
  fault.kind = kFrozenReadings;
  fault.column = "q_rad";
  fault.runs = all_runs(rig);
  fault.text = "the reading before stands there while somebody else has the bus";
  return fault;
}

DataFault draw_fault(Draw& draw, std::size_t kind, Rig& rig) {
  DataFault fault;
  fault.kind = kFaultKinds[kind];
  switch (kind) {
    case kUnits:
      rig.feeds_forward = rig.healthy.drive.law != Law::kTorque;
      fault.column = feed_forward_column(rig);
      fault.runs = draw_runs(draw, rig);
      fault.factor = std::pow(draw.uniform(2.0, 5.0), draw.sign());
      fault.text = fault.factor > 1.0 ? "volts called newton metres" : "newton metres, scaled as if they were volts";
      break;
    case kDegrees:
      fault.column = draw.chance(0.6) ? "q_rad" : "q_cmd_rad";
      if (rig.healthy.drive.law == Law::kTorque) fault.column = "q_rad";
      fault.runs = draw_runs(draw, rig);
      fault.factor = kDegreesPerRadian;
      break;
    case kSign: {
      const std::string feed_forward = feed_forward_column(rig);
      fault.column = !feed_forward.empty() && draw.chance(0.5) ? feed_forward
                     : draw.chance(0.5)                        ? "q_rad"
                                                               : "q_cmd_rad";
      if (rig.healthy.drive.law == Law::kTorque && fault.column == "q_cmd_rad") fault.column = "q_rad";
      fault.runs = draw_runs(draw, rig);
      fault.factor = -1.0;
      break;
    }
    case kMass: {  // one load weighs 30 % more or less than its row says
      const std::size_t load = draw.below(rig.loads.size());
      fault.column = "load_mass_kg";
      fault.factor = draw.chance(0.5) ? 1.3 : 1.0 / 1.3;
      for (std::size_t i = 0; i < rig.runs.size(); ++i) {
        if (rig.runs[i].load == load) fault.runs.push_back(i);
      }
      break;
    }
    case kGain: {  // one gain of the table isn't the one that the firmware had
      const std::size_t gains = draw.below(rig.gains.size());
      fault.column = rig.healthy.drive.law == Law::kServo ? "kp_firmware" : "kp_Nm_per_rad";
      constexpr double kFactors[] = {0.5, 2.0, 1.25, 0.8, 256.0 / 180.0};
      fault.factor = kFactors[draw.below(std::size(kFactors))];
      for (std::size_t i = 0; i < rig.runs.size(); ++i) {
        if (rig.runs[i].gains == gains) fault.runs.push_back(i);
      }
      break;
    }
    case kSwapped:
      fault.runs = draw_pair(draw, rig);
      break;
    case kShift: {
      const bool torque = rig.healthy.drive.law == Law::kTorque;
      fault.column = torque || draw.chance(0.6) ? "q_rad" : "q_cmd_rad";
      fault.runs = draw_runs(draw, rig);
      const double late_s = draw.sign() * draw.spread(0.015, 0.06);
      fault.shift =
          static_cast<int>(std::copysign(std::max(1.0, std::round(std::abs(late_s) * rig.sample_rate_hz)), late_s));
      // Readings late in every run: what a delay of commands would do as well.
      const bool late = (fault.shift > 0) == (fault.column == "q_rad");
      if (late && fault.runs.size() == rig.runs.size()) fault.same_here = {"delay"};
      break;
    }
    default:
      throw std::invalid_argument("no such kind of data fault");
  }
  return fault;
}

Rig with_fault(const DataFault& fault, Rig rig) {
  if (fault.kind == kFaultKinds[kMass]) rig.mass_factor[rig.runs[fault.runs.front()].load] *= fault.factor;
  return rig;
}

void spoil(const DataFault& fault, std::vector<FiledRun>& files) {
  if (fault.kind == kFrozenReadings) return;
  if (fault.kind == kFaultKinds[kSwapped]) {
    std::swap(files[fault.runs[0]].recording, files[fault.runs[1]].recording);
    return;
  }
  for (const std::size_t index : fault.runs) {
    FiledRun& file = files[index];
    if (fault.kind == kFaultKinds[kMass]) continue;  // with_fault() has it
    if (fault.kind == kFaultKinds[kGain]) {
      file.gains.kp /= fault.factor;
    } else if (fault.kind == kFaultKinds[kShift]) {
      shift(column_of(file.recording, fault.column), fault.shift);
    } else {
      for (double& value : column_of(file.recording, fault.column)) value *= fault.factor;
    }
  }
}

}  // namespace pmg::literature
