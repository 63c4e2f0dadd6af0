#include "runtime/excitation_recorder.hpp"

#include <utility>

namespace pmg::runtime {

namespace {

constexpr double kLongestGap_s = 0.05;  // five commands: what a bench's recordings may have between two samples

}  // namespace

ExcitationRecorder::ExcitationRecorder(int joint, std::vector<std::size_t> samples_of_run)
    : joint_(joint), samples_of_run_(std::move(samples_of_run)) {}

void ExcitationRecorder::add(const control::TickRecord& record) {
  progress_ = record.result.excitation;
  if (progress_.run < 0) {
    current_ = {};
    return;
  }
  if (progress_.sample == 0) {
    current_ = {};
    current_.run = progress_.run;
    start_ns_ = record.state.stamp_ns;
  }
  const bool next = current_.run == progress_.run && std::cmp_equal(current_.t_s.size(), progress_.sample);
  const double t_s = static_cast<double>(record.state.stamp_ns - start_ns_) * 1e-9;
  // Without news from the bus a tick sees the sample before once more, and a host that stops for long leaves a gap:
  // such a run has a hole.
  const bool hole = !current_.t_s.empty() && (t_s <= current_.t_s.back() || t_s > current_.t_s.back() + kLongestGap_s);
  if (!next || hole) {
    current_ = {};
    return;
  }
  current_.t_s.push_back(t_s);
  current_.q_cmd_rad.push_back(record.result.command.q[joint_]);
  current_.q_rad.push_back(record.state.q[joint_]);
  current_.dq_rad_s.push_back(record.state.dq[joint_]);
  current_.torque_Nm.push_back(record.state.tau[joint_]);
  current_.temp_C.push_back(record.state.temperature_degC[joint_]);
  if (current_.t_s.size() < samples_of_run_[static_cast<std::size_t>(current_.run)]) return;
  complete_.push_back(std::exchange(current_, {}));
}

}  // namespace pmg::runtime
