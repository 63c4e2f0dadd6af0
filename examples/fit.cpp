// Fits a joint's motor model to its recordings: fit BENCH, a folder of bench.yaml, runs.csv and runs/*.csv
// (docs/reference/file-formats.md). Prints each parameter with its standard deviation, and the error that is left.
#include <cmath>
#include <cstdio>
#include <exception>

#include "calib/fit_confidence.hpp"
#include "calib/joint_runs.hpp"
#include "calib/motor_fit.hpp"

int main(int argc, char** argv) try {
  using namespace pmg;
  if (argc != 2) {
    std::fprintf(stderr, "fit BENCH: expected one folder\n");
    return 2;
  }
  const bench::Bench bench = bench::read_bench(argv[1]);
  std::vector<std::string> names =
      calib::basic_parameters(bench);  // gains and rotor, as far as bench.yaml doesn't know
  names.insert(names.end(), {"friction.viscous_Nm_s_per_rad", "friction.coulomb_Nm"});
  calib::Unknowns unknowns;
  for (const std::string& name : names) unknowns.push_back(calib::unknown(name, bench));

  calib::JointModel start;
  start.actuator = bench.known;
  const std::string all_runs;
  const calib::FitProblem problem(unknowns, start,
                                  calib::read_joints(bench, all_runs, calib::simulation_step_s(bench)));
  calib::FitOptions options;
  options.newton_steps = 30;
  const calib::Fit fit = calib::fit(problem, options);
  const std::vector<calib::Confidence> confidence = calib::confidence(problem, fit.point, 1);
  for (std::size_t i = 0; i < unknowns.size(); ++i)
    std::printf("%-24s %11.5g +- %.2g %s\n", unknowns[i].name.c_str(), calib::value(fit.model, unknowns[i].name),
                confidence[i].deviation, unknowns[i].unit().c_str());
  std::printf("error %.3g mrad\n", 1e3 * std::sqrt(fit.loss_rad2));
} catch (const std::exception& error) {
  std::fprintf(stderr, "fit: %s\n", error.what());
  return 2;
}
