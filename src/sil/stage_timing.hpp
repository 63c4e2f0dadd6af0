// Wall times of the control tick's stages: timing.csv and its percentiles. Never part of a log, which must be
// reproducible.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "control/tick.hpp"

namespace pmg::sil {

struct Percentiles {
  double p50_us = 0.0, p99_us = 0.0;
};

class StageTiming {
 public:
  void reserve(std::size_t ticks) { rows_.reserve(ticks); }
  void add(double time_s, const control::StageTimes& times) { rows_.push_back({time_s, times}); }

  /// Nearest rank over the ticks in which the stage ran; zero if there were none.
  Percentiles percentiles(std::int64_t control::StageTimes::*stage) const;

  void write_csv(const std::filesystem::path& file) const;  ///< throws std::runtime_error

 private:
  struct Row {
    double time_s;
    control::StageTimes times;
  };
  std::vector<Row> rows_;
};

}  // namespace pmg::sil
