// A robot's motion over time, beside its command.
#pragma once

#include <array>
#include <vector>

#include "pmg/command.hpp"
#include "sil/run_measure.hpp"
#include "sim/world.hpp"

namespace pmg::evaluation {

/// One value per tick. Velocities are means over the last gait period, in the momentary heading frame.
struct Course {
  std::vector<double> time_s;
  std::array<std::vector<double>, kChannels> asked, did;
};

/// Fills a course tick by tick.
class CourseRecorder {
 public:
  /// Keeps a reference to course.
  CourseRecorder(Course& course, double standing_height_m) : course_(course), standing_height_m_(standing_height_m) {}
  void add(const sil::RunProgress& now, const model::GroundTruth& truth);

 private:
  Course& course_;
  double standing_height_m_;
  double gait_period_s_ = 1.0;                                    // until the generator has given one
  std::array<std::vector<double>, kVelocityChannels> travelled_;  // sums of velocities since the start
};

}  // namespace pmg::evaluation
