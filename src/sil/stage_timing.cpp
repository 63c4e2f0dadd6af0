#include "sil/stage_timing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace pmg::sil {

namespace {

double rank_us(std::vector<std::int64_t>& sorted_ns, double share) {
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted_ns.size())));
  return static_cast<double>(sorted_ns[std::max<std::size_t>(rank, 1) - 1]) * 1e-3;
}

}  // namespace

Percentiles StageTiming::percentiles(std::int64_t control::StageTimes::*stage) const {
  std::vector<std::int64_t> times_ns;
  times_ns.reserve(rows_.size());
  for (const Row& row : rows_) {
    // Stages don't run in Passive, Damping and Fault.
    if (row.times.generator_ns > 0) times_ns.push_back(row.times.*stage);
  }
  if (times_ns.empty()) return {};
  std::ranges::sort(times_ns);
  return {.p50_us = rank_us(times_ns, 0.50), .p99_us = rank_us(times_ns, 0.99)};
}

void StageTiming::write_csv(const std::filesystem::path& file) const {
  std::string text = "time_s,tick_us,generator_us,gco_us,policy_us\n";
  for (const Row& row : rows_) {
    const auto us = [](std::int64_t ns) { return static_cast<double>(ns) * 1e-3; };
    fmt::format_to(std::back_inserter(text), "{:.3f},{:.2f},{:.2f},{:.2f},{:.2f}\n", row.time_s, us(row.times.tick_ns),
                   us(row.times.generator_ns), us(row.times.gco_ns), us(row.times.policy_ns));
  }
  std::ofstream out(file);
  out << text;
  if (!out.flush()) throw std::runtime_error(file.string() + ": can't be written");
}

}  // namespace pmg::sil
