#include "calibration.hpp"

#include <Eigen/Dense>
#include <algorithm>

#include "calib/fit_problem.hpp"
#include "files.hpp"

namespace pmg::literature {

namespace {

constexpr double kDifference = 0.02;  // of a parameter's scale, for the Jacobian

std::vector<calib::SingleJoint> read(const std::filesystem::path& folder, const std::string& filter) {
  const bench::Bench bench = bench::read_bench(folder);
  std::vector<calib::SingleJoint> joints;
  for (bench::BenchRun& run : bench.read_runs(bench::RowFilter(filter))) {
    joints.emplace_back(bench, std::move(run), calib::simulation_step_s(bench));
  }
  return joints;
}

Eigen::VectorXd residuals(const model::ActuatorParameters& model, const std::vector<calib::SingleJoint>& joints) {
  std::vector<double> all;
  for (const calib::SingleJoint& joint : joints) {
    const std::vector<double> q_rad = joint.rollout({.actuator = model});
    const bench::Recording& r = joint.run().recording;
    for (std::size_t k = 0; k < q_rad.size(); ++k) all.push_back(r.valid[k] ? q_rad[k] - r.q_rad[k] : 0.0);
  }
  return Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

model::ActuatorParameters changed(const std::vector<CalibratedParameter>& unknowns, model::ActuatorParameters model,
                                  const Eigen::VectorXd& by) {
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const model::ActuatorParameter& parameter = model::actuator_parameter(unknowns[i].name);
    double& value = parameter.in(model);
    value = std::max(value + by[static_cast<Eigen::Index>(i)] * unknowns[i].scale,
                     std::max(parameter.lower, 1e-3 * unknowns[i].scale));
  }
  return model;
}

}  // namespace

model::ActuatorParameters calibrated(model::ActuatorParameters model, const std::vector<CalibratedParameter>& sought,
                                     const std::filesystem::path& healthy_bench, int iterations) {
  const std::vector<calib::SingleJoint> joints = read(healthy_bench, kFitFilter);
  const auto count = static_cast<Eigen::Index>(sought.size());
  Eigen::VectorXd missed = residuals(model, joints);
  double damping = 1e-3;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    Eigen::MatrixXd jacobian(missed.size(), count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::VectorXd step = kDifference * Eigen::VectorXd::Unit(count, i);
      jacobian.col(i) = (residuals(changed(sought, model, step), joints) - missed) / kDifference;
    }
    const Eigen::MatrixXd normal = jacobian.transpose() * jacobian;
    const Eigen::VectorXd gradient = jacobian.transpose() * missed;
    bool better = false;
    for (int attempt = 0; attempt < 4 && !better; ++attempt, damping *= 10.0) {
      Eigen::MatrixXd damped = normal;
      damped.diagonal() *= 1.0 + damping;
      const model::ActuatorParameters candidate = changed(sought, model, -damped.ldlt().solve(gradient));
      const Eigen::VectorXd then = residuals(candidate, joints);
      better = then.squaredNorm() < missed.squaredNorm();
      if (better) model = candidate, missed = then;
    }
    damping *= better ? 1e-2 : 1.0;
    if (!better) break;
  }
  return model;
}

double rollout_error_rad(const model::ActuatorParameters& model, const std::filesystem::path& bench,
                         const std::string& filter) {
  return total(calib::errors({.actuator = model}, read(bench, filter), 1)).mean_absolute_rad();
}

}  // namespace pmg::literature
